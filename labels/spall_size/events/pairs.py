"""Ordered pairs of candidates, each taken for entry and exit event of one ball."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.signal.mean_pass import MeanPass
from labels.spall_size.signal.running_energy import RunningEnergy
from physics.arrays import Array

EVENTS = ("entry", "exit")
# Periods: the lag of two events of one ball is below it, so that no event is paired with itself one pass later.
LONGEST_LAG = 0.97
# Half the width of the window that is the core of an event, as a share of the lag.
CORE_SHARE = 0.05
# Least half width of a core, samples.
SMALLEST_CORE = 1.0


@dataclass(frozen=True)
class RecordFacts:
    """What pairs of one record share: the `score` of its pass track, and whether they cross the `inner` race.

    The others are logarithms: `peakedness` of the mean over the median energy of the prewhitened signal,
    `predictability` of the signal's variance over that of its differences, `noise` of the share of white noise in it.
    """

    score: float
    inner: bool
    peakedness: float
    predictability: float
    noise: float


@dataclass(frozen=True)
class Pairs:
    """Ordered pairs of candidates: places `entry`, `exit` (P,) in samples from the anchor, `lag` (P,) in samples,
    between 0 and one period, and `features` (P, F), the columns `table.PAIR_COLUMNS`."""

    entry: Array
    exit: Array
    lag: Array
    features: Array


@dataclass(frozen=True)
class PairView:
    """What the columns of pairs are computed from: the `mean` pass, its `summed` energy and the `facts` of the record.

    `places` (C,) are those of its candidates in samples from the anchor; `first` and `last` (P,) say which of them make
    each pair, and `lag` (P,) is its lag in samples.
    """

    mean: MeanPass
    summed: RunningEnergy
    facts: RecordFacts
    places: Array
    first: NDArray[np.int64]
    last: NDArray[np.int64]
    lag: Array

    @cached_property
    def entry(self) -> Array:
        """Places (P,) of the first events, samples from the anchor."""
        return self.places[self.first]

    @cached_property
    def exit(self) -> Array:
        """Places (P,) of the last events, samples from the anchor."""
        return self.places[self.last]

    @property
    def events(self) -> dict[str, Array]:
        """Places (P,) of either event by its name in EVENTS."""
        return {"entry": self.entry, "exit": self.exit}

    @cached_property
    def core(self) -> Array:
        """Half the width (P,) of the core of an event, samples."""
        return np.maximum(SMALLEST_CORE, CORE_SHARE * self.lag)

    @cached_property
    def cores(self) -> dict[str, Array]:
        """Log energy (4, P) in the core of either event, a row a channel."""
        return {event: self.summed.level(place - self.core, place + self.core) for event, place in self.events.items()}


def all_pairs(mean: MeanPass, places: Array, facts: RecordFacts) -> PairView:
    """All ordered pairs of different candidates `places` (C,) whose lag is below LONGEST_LAG."""
    first, last = (index.ravel() for index in np.meshgrid(np.arange(places.size), np.arange(places.size)))
    lag = places[last] - places[first]
    lag = np.where(lag < 0.0, lag + mean.period, lag)
    kept = (first != last) & (lag < LONGEST_LAG * mean.period)
    return PairView(
        mean=mean,
        summed=RunningEnergy(mean),
        facts=facts,
        places=places,
        first=first[kept],
        last=last[kept],
        lag=lag[kept],
    )
