"""How far a command has got: what long work reports it to, and how seldom."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

Say = Callable[[str], None]
Count = Callable[[int, int], None]


def ignore(*_: object) -> None:
    """Take a report and do nothing: the default where nobody asked for progress."""


@dataclass(frozen=True)
class Listener:
    """What long work reports to; reports of a kind that is left out are ignored.

    `say` takes sentences that stay, `step` what is under way at the moment, `advance` how many of how many records are
    done.
    """

    say: Say = ignore
    step: Say = ignore
    advance: Count = ignore

    def counting(self, what: str) -> Count:
        """A report of how many records of how many are done, as a step called `what`."""
        return lambda done, total: self.step(f"{what}: {done} of {total} records")


SILENT = Listener()


class Throttle:
    """Says when something is due that may happen once in so many `seconds`, and not before the instant `first` (s)."""

    def __init__(self, seconds: float, first: float = -math.inf) -> None:
        self._seconds = seconds
        self._next = first

    def due(self, now: float) -> bool:
        """Whether it is due at the instant `now` (s); if so, it is due again only when the `seconds` have passed."""
        if now < self._next:
            return False
        self._next = now + self._seconds
        return True
