"""The split of a corpus that a command is asked for."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from datagen.errors import BadInput
from labels.schema import SPLITS

ALL = "all"
# The split that is left to score.
TEST = "test"


def require_split(folder: Path, present: Iterable[str], asked: str) -> None:
    """Raise BadInput unless the split `asked` for is "all" or one of those `present` in the corpus `folder`."""
    there = set(present)
    if asked != ALL and asked not in there:
        allowed = ", ".join([ALL, *(name for name in SPLITS if name in there)])
        raise BadInput("no records of this split", file=str(folder), field="--split", value=asked, allowed=allowed)
