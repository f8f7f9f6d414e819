"""The row of one record: its estimate beside its truth, flat, in numbers and words."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.event_scores import EventScores
from labels.schema import UNKNOWN

LONGEST_SCORED_SPACINGS = 0.9
FEWEST_SAMPLES, FEWEST_SPACINGS = 5.0, 1.0 / 50.0
NO_EVENT_SAMPLES = 2.0
CLEAN_DB = 60.0  # from this ratio on a record counts as one without noise
NO_SCORES = EventScores(0, 0, 0)
NOT_ASKED = "not_asked"


@dataclass(frozen=True)
class ScoredRecord:
    """Truth and estimate of one record, SI units where the name has none; NaN where there is none.

    `true_lag`, `lag` s; `true_extent`, `extent`, `lag_arc`, `static_arc` (lag and static release arcs), `envelope_arc`
    (plain rule), `candidates` rad; `extent_mm` is the label, `estimated_mm` and `estimated_deg` are `extent` in other
    units. `_low` and `_high` bound a 90 % interval. `event_times` (K, 2), s: both events of each pass that was heard.
    `pass_period` nominal, s; `seconds` of the processor that the estimate took. The event scores are within 100 µs and
    within 0.5 degrees. `known_size_factor` is what a known size of another record has multiplied the extents by.
    `outcome` is "not_asked" if no estimate could be asked for; `reason` says in words why there is none.
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
    true_lag: float
    true_extent: float
    outcome: str
    reason: str
    method: str
    found_race: str
    trust: float
    lag: float
    lag_low: float
    lag_high: float
    lag_arc: float
    extent: float
    extent_low: float
    extent_high: float
    estimated_deg: float
    estimated_deg_low: float
    estimated_deg_high: float
    estimated_mm: float
    estimated_mm_low: float
    estimated_mm_high: float
    candidates: tuple[float, ...]
    candidates_deg: tuple[float, ...]
    candidates_mm: tuple[float, ...]
    static_arc: float
    envelope_arc: float
    known_size_factor: float
    seconds: float
    event_times: NDArray[np.float64] = field(compare=False)
    events_in_time: EventScores
    events_in_arc: EventScores
    known_truth: bool

    @property
    def bearing_group(self) -> tuple[str, str]:
        """What the records of one bearing share and no other has; where the bearing is unknown, no two records do."""
        return (self.bearing_id, "") if self.bearing_id != UNKNOWN else (UNKNOWN, str(self.record))

    @property
    def found(self) -> bool:
        """True if there is an estimate."""
        return math.isfinite(self.extent)

    @property
    def has_events(self) -> bool:
        """True if the record has events far enough apart that a size may be asked for."""
        least = max(FEWEST_SAMPLES / self.rate, FEWEST_SPACINGS * self.pass_period)
        return self.true_lag >= least

    @property
    def scorable(self) -> bool:
        """True if a size must be told and no whole ball spacing can hide in it."""
        return self.has_events and self.extent_spacing <= LONGEST_SCORED_SPACINGS

    @property
    def without_event(self) -> bool:
        """True if nothing may be told: no event, or a lag below two samples."""
        return self.known_truth and not self.true_lag >= NO_EVENT_SAMPLES / self.rate

    @property
    def asked(self) -> bool:
        """True if an estimate could be asked for."""
        return self.outcome != NOT_ASKED

    def to_dict(self) -> dict[str, Any]:
        """The row by names."""
        return {field.name: getattr(self, field.name) for field in fields(self)}
