"""How tests run a command of the program in their own process."""

from typer.testing import CliRunner

from datagen.cli import app


def run(*arguments: object) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of the command with these arguments."""
    done = CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=False)
    return done.exit_code, done.stdout, done.stderr
