"""What a step of a check found wrong, to be added to what the others found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Findings:
    """`problems` are sentences, `damaged` files that are not what was written; `unfinished` if there are files that a
    run which ends writes anew: the index, the manifest, shards without sidecar."""

    problems: tuple[str, ...] = ()
    damaged: tuple[str, ...] = ()
    unfinished: bool = False

    def __add__(self, other: Findings) -> Findings:
        return Findings(
            self.problems + other.problems, self.damaged + other.damaged, self.unfinished or other.unfinished
        )


def of_file(name: str, sentences: Iterable[str], *, damaged: bool = False, unfinished: bool = False) -> Findings:
    """The `sentences` about the file called `name`, each beginning with that."""
    return Findings(tuple(f"{name}: {sentence}" for sentence in sentences), (name,) * damaged, unfinished)
