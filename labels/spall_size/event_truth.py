"""The events that a record truly holds: release and regain of each pass, or fall and rise of the ball's load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array


@dataclass(frozen=True)
class EventTruth:
    """Times (K,), s, of both events of every pass that has them; `kept` (K,) is True where contact was never lost."""

    first: Array
    last: Array
    kept: NDArray[np.bool_]

    @property
    def lag(self) -> float:
        """Median time between both events of a pass, s; NaN if no pass has them."""
        return float(np.median(self.last - self.first)) if self.first.size else float("nan")

    def within(self, start: float, end: float) -> EventTruth:
        """The passes that lie between two times (s), counted from the first of them."""
        inside = (self.first >= start) & (self.last <= end)
        return EventTruth(self.first[inside] - start, self.last[inside] - start, self.kept[inside])


def event_truth(release: Array, regain: Array, fall: Array, rise: Array, latest: Array) -> EventTruth:
    """The events of N passes from their times (N,), s, NaN where there is none: the first release and last regain of
    contact, or else the first fall and last rise of the load.

    A ball that carries no load behind the spall may hang free until it comes round to the load zone, so a regain after
    `latest` is no event of the spall, and that pass has none.
    """
    kept = ~np.isfinite(release)
    first, last = np.where(kept, fall, release), np.where(kept, rise, np.where(regain <= latest, regain, np.nan))
    there = np.isfinite(first) & np.isfinite(last)
    return EventTruth(first[there], last[there], kept[there])
