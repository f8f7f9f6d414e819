"""Who hears how far a command has got."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Say = Callable[[str], None]
Count = Callable[[int, int], None]


def unheard(*_: object) -> None:
    """Drop what was said: what a program passes on that nobody asked to hear."""


@dataclass(frozen=True)
class Listener:
    """Who hears of a run; what is left out is not heard.

    `say` hears sentences that stay, `step` what is under way at the moment, `advance` how many of how many records are
    done.
    """

    say: Say = unheard
    step: Say = unheard
    advance: Count = unheard

    def counting(self, what: str) -> Count:
        """What hears how many records of how many are done, as a step called `what`."""
        return lambda done, total: self.step(f"{what}: {done} of {total} records")


NOBODY = Listener()
