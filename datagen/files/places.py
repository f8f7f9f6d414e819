"""Where files are and results are to go, refused before any work if they cannot be put there; nothing is left there by
asking."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

import datagen
from datagen.errors import BadInput

OUT = "--out"
# What the files of a corpus are called, and the folder of its shards.
MANIFEST, INDEX, FAILURES, SCORED_RUNS = "manifest.json", "index.csv", "failed.jsonl", "scored_runs.jsonl"
SHARDS = "shards"


def from_home(path: str | Path) -> Path:
    """The path, from somebody's home on if it begins with ~ and there is such a person: a shell leaves that to the
    program in --out=~/corpus."""
    return Path(os.path.expanduser(path))


def require_folder(folder: Path) -> None:
    """Raise BadInput if `folder` can neither be written into nor made."""
    try:
        os.lstat(folder)
    except (FileNotFoundError, NotADirectoryError):
        pass  # it is to be made, or what is in its way is found below
    except OSError as problem:
        raise BadInput(problem.strerror or str(problem), field=OUT, value=str(folder)) from None
    nearest = next(path for path in (folder.absolute(), *folder.absolute().parents) if os.path.lexists(path))
    if not nearest.is_dir():
        raise BadInput(
            f"{nearest} is in the way: it is not a folder",
            field=OUT,
            value=str(folder),
            allowed="a new or existing folder",
        )
    if not is_writable(nearest):
        raise BadInput(
            f"cannot write into {nearest}", field=OUT, value=str(folder), allowed="a folder that you may write into"
        )


def require_results_folder(folder: Path) -> None:
    """Raise BadInput if results cannot be put into `folder`, or would be mixed with the files of a corpus there."""
    require_folder(folder)
    if _is_in_corpus(folder):
        problem = "this is the folder of a corpus, and results would be mixed with its files"
        raise BadInput(problem, field=OUT, value=str(folder), allowed="a folder of its own")


def require_table(path: Path) -> None:
    """Raise BadInput if no table can be put at `path`, or it would lie among the files of a corpus."""
    require_file(path)
    if _is_in_corpus(path.parent):
        problem = "this is in the folder of a corpus, and the table would be mixed with its files"
        raise BadInput(problem, field=OUT, value=str(path), allowed="a file in another folder")


def _is_in_corpus(folder: Path) -> bool:
    """Whether a folder is that of a corpus or of its shards."""
    place = Path(os.path.realpath(folder))
    return (place / MANIFEST).is_file() or (place.name == SHARDS and (place.parent / MANIFEST).is_file())


def refuse_other_than_file(path: Path, allowed: str) -> None:
    """Raise BadInput that says what lies at `path` where no file does; nothing happens if nothing lies there."""
    if os.path.exists(path):
        raise BadInput(no_file(path), file=str(path), allowed=allowed)


def no_file(path: Path) -> str:
    """What to say of a `path` at which no file lies: what lies there instead, or that nothing does."""
    if not os.path.exists(path):
        return "no such file"
    return "this is a folder" if path.is_dir() else "this is a pipe or a device; a file is needed"


def require_file(path: Path, field: str = OUT) -> None:
    """Raise BadInput if no file can be put at `path`; one that is there may be written over, but none of a corpus."""
    allowed = "a file in an existing folder that you may write into"
    try:
        problem = _against_file(path)
    except OSError as error:
        problem = error.strerror or str(error)
    if problem:
        raise BadInput(problem, field=field, value=str(path), allowed=allowed)
    refuse_file_of_corpus(path, field)


def refuse_file_of_corpus(path: Path, field: str, corpora: Iterable[Path] = ()) -> None:
    """Raise BadInput if `path` is the place of one of the files that a corpus consists of: of one that is there, or of
    one that may come to be in the folders `corpora`."""
    place = Path(os.path.realpath(path))
    in_shards = place.parent.name == SHARDS
    folder = place.parent.parent if in_shards else place.parent
    is_corpus = (folder / MANIFEST).is_file() or (folder / SHARDS).is_dir()
    named = in_shards or place.name in (MANIFEST, INDEX, FAILURES, SCORED_RUNS)
    if named and (is_corpus or folder in {Path(os.path.realpath(corpus)) for corpus in corpora}):
        problem = "a corpus has a file of its own there, which would be lost"
        raise BadInput(problem, field=field, value=str(path), allowed="a file of another name, or in another folder")


def _against_file(path: Path) -> str:
    parent = path.absolute().parent
    if path.is_dir():
        return "this is a folder"
    if not parent.is_dir():
        return "no such folder"
    if path.exists() and not path.is_file():  # a pipe or a terminal is written to as it is
        return "" if os.access(path, os.W_OK) else "cannot write to it"
    return "" if is_writable(parent) else f"cannot write into {parent}"


def is_writable(folder: str | Path) -> bool:
    """True if a file can be made in `folder`, which permissions alone do not tell; none is left there."""
    try:
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False


def dataset_folders() -> list[Path]:
    """Folders that may hold the datasets that come with spallgen: the wheel's, then the checkout's.

    A wheel holds the repository's `datasets` folder as `datagen/datasets` (pyproject.toml maps it there, so that
    nothing is copied by hand); in a checkout the folder is found beside the packages.
    """
    package = Path(datagen.__file__).resolve().parent
    return [package / "datasets", package.parent / "datasets"]
