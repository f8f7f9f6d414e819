"""One record scored: what is true of it, and what an estimator answered."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from labels.event_scores import EventScores
from labels.schema import UNKNOWN
from labels.spall_size.size_estimate import NO_TIMES, UNKNOWN_BOUNDS, Bounds
from physics.arrays import Array

LONGEST_SCORED_SPACINGS = 0.9
SHORTEST_LAG_SAMPLES, SHORTEST_LAG_SPACINGS = 5.0, 1.0 / 50.0
NO_EVENT_SAMPLES = 2.0
CLEAN_DB = 60.0  # from this ratio on a record counts as one without noise
NO_SCORES = EventScores(0, 0, 0)
NOT_ASKED = "not_asked"


def shortest_lag(rate: float, pass_period: float) -> float:
    """The shortest lag (s) between events of which a size may be asked for, at `rate` (Hz) and with a `pass_period`
    (s)."""
    return max(SHORTEST_LAG_SAMPLES / rate, SHORTEST_LAG_SPACINGS * pass_period)


def must_be_sized(lag: float, rate: float, pass_period: float, spacings: float) -> bool:
    """True if a size must be given: of a spall that is so many ball `spacings` long, with the `lag` (s) between its
    events, at `rate` (Hz) and with a `pass_period` (s). No whole ball spacing can hide in it."""
    return lag >= shortest_lag(rate, pass_period) and spacings <= LONGEST_SCORED_SPACINGS


def lacks_event(samples: Array | float) -> NDArray[np.bool_]:
    """Where no size may be given (N,), by the lag between events in `samples` (N,): NaN for none, or below two."""
    return np.logical_not(np.greater_equal(samples, NO_EVENT_SAMPLES))


@dataclass(frozen=True)
class Truth:
    """What a record is, and what is true of its spall; NaN where that is unknown or there is none.

    `rate` Hz; `pass_period` nominal, s; `lag` between the events, s; `extent` of the spall, rad, which in other units
    is `extent_mm` and `extent_spacing`. `known` if the ball passes of the record are known.
    """

    record: int
    recording: str
    channel: str
    bearing_id: str
    rig: str
    race: str
    profile: str
    split: str
    snr_db: float
    speed_rpm: float
    load_n: float
    extent_mm: float
    extent_spacing: float
    rate: float
    pass_period: float
    lag: float
    extent: float
    known: bool


@dataclass(frozen=True)
class Answer:
    """What an estimator answered of a record, as in SizeEstimate; NaN where it has no number.

    Its numbers are floats, its `outcome` is in letters and "not_asked" if no estimate could be asked for; `reason` says
    in words why there is none. `candidates_mm` are the `candidates` (rad), by the mm that the estimator has for a rad.
    `known_size_factor` is what a known size of another record has multiplied the extents by; `seconds` of the processor
    that the estimate took; `load_known` if load and Hertz factor were given.
    """

    outcome: str
    reason: str
    method: str = ""
    race: str = ""
    trust: float = 0.0
    lag: float = math.nan
    lag_interval: Bounds = UNKNOWN_BOUNDS
    lag_arc: float = math.nan
    extent: float = math.nan
    extent_interval: Bounds = UNKNOWN_BOUNDS
    extent_mm: float = math.nan
    extent_mm_interval: Bounds = UNKNOWN_BOUNDS
    candidates: tuple[float, ...] = ()
    candidates_mm: tuple[float, ...] = ()
    event_times: NDArray[np.float64] = field(default_factory=lambda: NO_TIMES, compare=False)
    known_size_factor: float = 1.0
    seconds: float = 0.0
    load_known: bool = False

    @property
    def own_extent(self) -> float:
        """The extent (rad) before a known size corrected it."""
        return self.extent / self.known_size_factor

    @property
    def extent_deg(self) -> float:
        """The extent in degrees."""
        return math.degrees(self.extent)

    @property
    def extent_deg_interval(self) -> Bounds:
        """Its interval in degrees."""
        low, high = self.extent_interval
        return math.degrees(low), math.degrees(high)

    @property
    def candidates_deg(self) -> tuple[float, ...]:
        """The candidates in degrees."""
        return tuple(math.degrees(arc) for arc in self.candidates)

    @property
    def complement(self) -> float:
        """What the extent lacks of a ball spacing (rad), as candidates are apart: the spall's if an exit and the next
        entry were taken for entry and exit. NaN if it is longer than that, or no longer candidate is given."""
        spacing = min((arc - self.extent for arc in self.candidates if arc > self.extent), default=math.nan)
        return spacing - self.extent if spacing > self.extent else math.nan

    @property
    def complement_mm(self) -> float:
        """The same in mm."""
        return self.complement * self.extent_mm / self.extent


@dataclass(frozen=True)
class ScoredRecord:
    """Truth and estimate of one record, arcs by simpler rules, and scores of the events.

    `static_arc` (rad) is of the estimated lag and static release, `envelope_arc` (rad) of the plain rule. The event
    scores are within 100 µs and within 0.5 degrees.
    """

    truth: Truth
    answer: Answer
    static_arc: float = math.nan
    envelope_arc: float = math.nan
    events_in_time: EventScores = NO_SCORES
    events_in_arc: EventScores = NO_SCORES

    @property
    def bearing_group(self) -> tuple[str, str]:
        """What the records of one bearing share and no other has; where the bearing is unknown, no two records do."""
        bearing = self.truth.bearing_id
        return (bearing, "") if bearing != UNKNOWN else (UNKNOWN, str(self.truth.record))

    @property
    def found(self) -> bool:
        """True if there is an estimate."""
        return math.isfinite(self.answer.extent)

    @property
    def has_events(self) -> bool:
        """True if the record has events far enough apart that a size may be asked for."""
        return self.truth.lag >= shortest_lag(self.truth.rate, self.truth.pass_period)

    @property
    def scorable(self) -> bool:
        """True if a size must be given and no whole ball spacing can hide in it."""
        truth = self.truth
        return must_be_sized(truth.lag, truth.rate, truth.pass_period, truth.extent_spacing)

    @property
    def without_event(self) -> bool:
        """True if nothing may be given: no event, or a lag below two samples."""
        return self.truth.known and bool(lacks_event(self.truth.lag * self.truth.rate))

    @property
    def asked(self) -> bool:
        """True if an estimate could be asked for."""
        return self.answer.outcome != NOT_ASKED
