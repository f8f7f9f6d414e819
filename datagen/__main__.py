"""`python -m datagen` is the command `spallgen`."""

from datagen.cli import main

if __name__ == "__main__":
    main()
