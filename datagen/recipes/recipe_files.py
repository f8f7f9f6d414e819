"""Where recipes are found: as a file or folder first, then among the datasets that come with spallgen."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from datagen.errors import BadInput, unreadable
from datagen.files.places import dataset_folders, refuse_other_than_file
from physics.spelling import suggestion

FILE_NAME = "recipe.toml"


def shipped_recipes() -> dict[str, Path]:
    """Recipe file of each dataset that comes with spallgen, by name."""
    found = [path for folder in reversed(dataset_folders()) for path in sorted(folder.glob(f"*/{FILE_NAME}"))]
    return {path.parent.name: path for path in found}


def find_recipe(path_or_name: str | Path) -> Path:
    """File of a recipe given as a file, a folder or the name of a dataset ("quickstart", "datasets/quickstart").

    A folder without a recipe, as that of a corpus, does not stand in the way of the dataset of its name.
    """
    path = Path(path_or_name)
    shipped, name = shipped_recipes(), _dataset_name(path)
    try:
        if path.is_file():
            return path
        if (path / FILE_NAME).is_file():
            return path / FILE_NAME
        if name in shipped:
            return shipped[name]
        if path.is_dir():
            raise BadInput(f"this folder has no {FILE_NAME}", file=str(path))
        refuse_other_than_file(path, "a recipe's file or folder, or the name of a dataset")
    except OSError as problem:
        raise unreadable(path, problem) from None
    known = ", ".join(shipped) or "(none)"
    told = f"no such file or folder, and no dataset of that name ({known})"
    raise BadInput(told + suggestion(name, shipped), file=str(path))


def _dataset_name(path: Path) -> str:
    parts = PurePosixPath(path.as_posix()).parts
    parts = parts[1:] if parts[:1] == ("datasets",) else parts
    parts = parts[:-1] if parts[-1:] == (FILE_NAME,) else parts
    return "/".join(parts)
