"""One record estimated and set beside its truth: a flat row of numbers and words."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, fields
from typing import Any

from datagen.sizing.estimators import AnyEstimator
from datagen.sizing.sized_records import SizedRecord, nominal_period
from labels.event_scores import EventScores, match_events, tolerance_of_arc
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.rules import EnvelopeLagRule
from labels.spall_size.size_estimate import SizeEstimate
from labels.spall_size.static_release import arc_with_static_release

TOLERANCE_S = 100e-6
TOLERANCE_RAD = math.radians(0.5)
LONGEST_SCORED_SPACINGS = 0.9
FEWEST_SAMPLES, FEWEST_SPACINGS = 5.0, 1.0 / 50.0
NO_EVENT_SAMPLES = 2.0
NO_SCORES = EventScores(0, 0, 0)


@dataclass(frozen=True)
class ScoredRecord:
    """Truth and estimate of one record, SI units; NaN where there is none.

    `true_lag`, `lag` s; `true_extent`, `extent`, `lag_arc`, `static_arc` (lag and static release arcs), `envelope_arc`
    (plain rule) rad; `pass_period` nominal, s; `seconds` of the processor that the estimate took. The event scores are
    within 100 µs and within 0.5 degrees.
    """

    record: int
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
    found_race: str
    trust: float
    lag: float
    lag_low: float
    lag_high: float
    lag_arc: float
    extent: float
    extent_low: float
    extent_high: float
    estimated_mm: float
    candidates: tuple[float, ...]
    static_arc: float
    envelope_arc: float
    seconds: float
    events_in_time: EventScores
    events_in_arc: EventScores
    known_truth: bool

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

    def to_dict(self) -> dict[str, Any]:
        """The row by names."""
        return {field.name: getattr(self, field.name) for field in fields(self)}


def score_record(sized: SizedRecord, estimator: AnyEstimator) -> ScoredRecord:
    """The estimate of one record beside its truth."""
    labels, situation = sized.labels, sized.situation
    began = time.process_time()
    told = estimator.estimate(sized.acceleration, sized.rate, situation)
    seconds = time.process_time() - began
    period = nominal_period(labels)
    in_time, in_arc = _events(told, sized.truth, period, situation.bearing().spacing)
    plain = EnvelopeLagRule().estimate(sized.acceleration, sized.rate, situation)
    static = math.nan
    if told.found and situation.load_known and situation.load is not None:
        static = arc_with_static_release(told.lag_arc, situation.bearing(), told.race, situation.load)
    return ScoredRecord(
        record=sized.record, bearing_id=str(labels["bearing_id"]),
        rig=str(labels["rig"]), race=str(labels["location"]), profile=str(labels["profile"]),
        split=str(labels["split"]), snr_db=float(labels["snr_db"]), speed_rpm=float(labels["speed_rpm"]),
        load_n=float(labels["load_n"]), extent_mm=float(labels["extent_mm"]),
        extent_spacing=float(labels["extent_spacing"]), rate=sized.rate, pass_period=period,
        true_lag=math.nan if sized.truth is None else sized.truth.lag,
        true_extent=float(labels["extent"]), outcome=told.outcome.name.lower(), found_race=told.race,
        trust=told.trust, lag=told.lag, lag_low=told.lag_interval[0], lag_high=told.lag_interval[1],
        lag_arc=told.lag_arc, extent=told.extent, extent_low=told.extent_interval[0],
        extent_high=told.extent_interval[1], estimated_mm=told.extent_mm, candidates=told.candidates,
        static_arc=static, envelope_arc=plain.lag_arc, seconds=seconds,
        events_in_time=in_time, events_in_arc=in_arc, known_truth=sized.truth is not None,
    )  # fmt: skip


def _events(
    told: SizeEstimate, truth: EventTruth | None, period: float, spacing: float
) -> tuple[EventScores, EventScores]:
    """Scores of both kinds of event together, within a time and within an arc."""
    if truth is None:
        return NO_SCORES, NO_SCORES
    tolerances = (TOLERANCE_S, tolerance_of_arc(TOLERANCE_RAD, period, spacing))
    kinds = ((told.event_times[:, 0], truth.first), (told.event_times[:, 1], truth.last))
    scores = [sum((match_events(*kind, tolerance) for kind in kinds), NO_SCORES) for tolerance in tolerances]
    return scores[0], scores[1]
