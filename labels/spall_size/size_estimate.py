"""The answer of a size estimator: a size with its doubt, or no size and why."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from physics.arrays import Array

# Lower and upper end of an interval; the number that it is around has a field of its own.
Bounds = tuple[float, float]
UNKNOWN_BOUNDS: Bounds = (math.nan, math.nan)
NO_TIMES = np.zeros((0, 2))
# Longest spall that is reported, rad: half the race.
LONGEST_EXTENT = math.pi
# Ball passes that a record must hold; TOO_SHORT says this in words.
FEWEST_PASSES = 6
# Ball passes that are looked at, on the race with the longer time between them; more made estimates no nearer.
MOST_PASSES = 4000
# Samples that a ball pass must last; TOO_COARSE says this in words.
FEWEST_SAMPLES_A_PASS = 16


class SizeOutcome(Enum):
    """How an estimate ended."""

    ESTIMATED = "estimated"
    NO_SIGNAL = "the record has no signal, as if no sensor were connected"
    TOO_SHORT = "the record holds fewer than six ball passes"
    TOO_COARSE = "a ball pass lasts fewer than sixteen samples"
    NO_PASSES = "no ball passes stand out of the record"
    NO_EVENT_PAIR = "the passes show no two events that could be trusted to be entry and exit"


@dataclass(frozen=True)
class SizeEstimate:
    """Size of the spall of one record.

    `lag` between the events in s, `lag_arc` the arc of the race that a ball covers in it, `extent` of the spall (rad)
    and `extent_mm` along its race. An interval held the truth in 90 % of the records of the size ladder that were given
    a size: of its training and validation splits, as stored, of machines that the trees judging them had not seen. Of
    other records it says nothing. `candidates` (rad): the extents that give the same timing, `extent`
    the first, the others whole ball spacings longer. `event_times` (K, 2), s: both events of each pass that was heard
    among the first MOST_PASSES.
    `trust` is 1 less the relative error to be expected of the lag, between 0 and 1. Without an estimate the numbers are
    NaN and `reason` says why.
    """

    outcome: SizeOutcome
    method: str
    race: str = ""
    lag: float = math.nan
    lag_interval: Bounds = UNKNOWN_BOUNDS
    lag_arc: float = math.nan
    extent: float = math.nan
    extent_interval: Bounds = UNKNOWN_BOUNDS
    extent_mm: float = math.nan
    extent_mm_interval: Bounds = UNKNOWN_BOUNDS
    candidates: tuple[float, ...] = ()
    pass_period: float = math.nan
    trust: float = 0.0
    event_times: Array = field(default_factory=lambda: NO_TIMES)

    @property
    def found(self) -> bool:
        """True if there is a size."""
        return self.outcome is SizeOutcome.ESTIMATED

    @property
    def reason(self) -> str:
        """Why there is no estimate; empty if there is one."""
        return "" if self.found else self.outcome.value
