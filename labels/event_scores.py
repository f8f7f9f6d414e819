"""Events found against true ones: the largest matching within a tolerance, precision, recall and F1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.arrays import Array


@dataclass(frozen=True)
class EventScores:
    """`matched` pairs of `found` events and `true` ones, each event in one pair at most."""

    matched: int
    found: int
    true: int

    @property
    def precision(self) -> float:
        """Share of the found events that are true ones; NaN if nothing was found."""
        return self.matched / self.found if self.found else float("nan")

    @property
    def recall(self) -> float:
        """Share of the true events that were found; NaN if there are none."""
        return self.matched / self.true if self.true else float("nan")

    @property
    def f1(self) -> float:
        """Harmonic mean of precision and recall; NaN if there is nothing to find and nothing was found."""
        total = self.found + self.true
        return 2.0 * self.matched / total if total else float("nan")

    def __add__(self, other: EventScores) -> EventScores:
        return EventScores(self.matched + other.matched, self.found + other.found, self.true + other.true)


def match_events(found: Array, true: Array, tolerance: float) -> EventScores:
    """Scores of `found` (F,) against `true` (N,) times, s, matched within `tolerance` (s).

    Taking both in order, and always the earliest pair that fits, gives the largest matching on a line.
    """
    found, true = np.sort(found), np.sort(true)
    matched, f, t = 0, 0, 0
    while f < found.size and t < true.size:
        if abs(found[f] - true[t]) <= tolerance:
            matched, f, t = matched + 1, f + 1, t + 1
        elif found[f] < true[t]:
            f += 1
        else:
            t += 1
    return EventScores(matched, int(found.size), int(true.size))


def tolerance_of_arc(arc: float, pass_period: float, spacing: float) -> float:
    """Time (s) in which a ball covers `arc` (rad) of the race when it takes `pass_period` (s) for a `spacing` (rad)."""
    return arc / spacing * pass_period
