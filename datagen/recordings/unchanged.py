"""Files that must not change between the first look at them and the end of an import."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from datagen.errors import BadInput, unreadable

State = tuple[int, int, int]


def require_unchanged(path: Path) -> None:
    """Raise BadInput if the file at `path` has changed since the first call for it, which only notes how it is.

    A change is seen by size, time of the last change, or another file in its place; what is read of a file in between
    is remembered, so it would show none.
    """
    if _state(path) != first_state(path):
        raise changed(path)


def changed(path: Path) -> BadInput:
    """The refusal of a file that is no longer what it was at the first look at it."""
    return BadInput("the file changed while it was being imported", file=str(path))


@lru_cache(maxsize=100_000)
def first_state(path: Path) -> State:
    """The state of a file at the first call for it."""
    return _state(path)


def _state(path: Path) -> State:
    try:
        found = path.stat()
    except OSError as problem:
        raise unreadable(path, problem) from None
    return found.st_size, found.st_mtime_ns, found.st_ino
