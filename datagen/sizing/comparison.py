"""One record estimated and set beside its truth, or listed with the reason why it was not."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from datagen.sizing.estimators import AnyEstimator
from datagen.sizing.scored_record import NO_SCORES, NOT_ASKED, Answer, ScoredRecord, Truth
from datagen.sizing.sized_records import SizedRecord, UnsizedRecord
from datagen.sizing.stored_record import nominal_period
from labels.event_scores import EventScores, match_events, tolerance_of_arc
from labels.spall_size.estimation.rules import EnvelopeLagRule
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.known_size import corrected
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import Bounds, SizeEstimate
from labels.spall_size.static_release import arc_with_static_release
from physics.bearing import RACES

TOLERANCE_S = 100e-6
TOLERANCE_RAD = math.radians(0.5)

CHANGING = "; the speed of the shaft changes and only its mean is used: cut the recording into pieces (cut_s)"


def score_record(sized: SizedRecord, estimator: AnyEstimator, factor: float = 1.0) -> ScoredRecord:
    """The estimate for one record beside its truth; the extent is multiplied by `factor`, which follows from a known
    size of another record."""
    labels, situation = sized.labels, sized.situation
    began = time.process_time()
    estimate = estimator.estimate(sized.acceleration, sized.rate, situation)
    seconds = time.process_time() - began
    if estimate.found and factor != 1.0:
        estimate = corrected(estimate, factor)
    period = nominal_period(labels)
    in_time, in_arc = _events(estimate, sized.truth, period, situation.bearing().spacing)
    plain = EnvelopeLagRule().estimate(sized.acceleration, sized.rate, _with_race(situation, estimate, labels))
    static = math.nan
    if estimate.found and estimate.race in RACES and situation.load_known and situation.load is not None:
        static = arc_with_static_release(estimate.lag_arc, situation.bearing(), estimate.race, situation.load)
    known_size_factor = factor if estimate.found else 1.0
    return ScoredRecord(
        replace(_truth(labels), pass_period=period, lag=_true_lag(sized.truth), known=sized.truth is not None),
        replace(
            _answer(estimate),
            reason=_reason(estimate, sized),
            known_size_factor=known_size_factor,
            seconds=seconds,
            load_known=situation.load_known,
        ),
        static_arc=static,
        envelope_arc=plain.lag_arc,
        events_in_time=in_time,
        events_in_arc=in_arc,
    )


def _reason(estimate: SizeEstimate, sized: SizedRecord) -> str:
    """Why a record has no estimate, and the likely cause; empty if it has one."""
    return estimate.reason + (CHANGING if sized.speed_changes and not estimate.found else "")


def _true_lag(truth: EventTruth | None) -> float:
    return math.nan if truth is None else truth.lag


def _with_race(situation: Situation, estimate: SizeEstimate, labels: Mapping[str, Any]) -> Situation:
    """The situation with the estimated race, or the true one where there is none; unchanged without a spall."""
    race = estimate.race if estimate.race in RACES else str(labels["location"])
    return replace(situation, race=race) if race in RACES else situation


def unsized_row(unsized: UnsizedRecord) -> ScoredRecord:
    """The row of a record that could not be given to an estimator."""
    return ScoredRecord(_truth(unsized.labels), Answer(NOT_ASKED, unsized.reason))


def _truth(labels: Mapping[str, Any]) -> Truth:
    """What the labels say about a record, without its ball passes."""
    return Truth(
        record=int(labels["record"]),
        recording=str(labels["recording"]),
        channel=str(labels["channel"]),
        bearing_id=str(labels["bearing_id"]),
        rig=str(labels["rig"]),
        race=str(labels["location"]),
        profile=str(labels["profile"]),
        split=str(labels["split"]),
        snr_db=float(labels["snr_db"]),
        speed_rpm=float(labels["speed_rpm"]),
        load_n=float(labels["load_n"]),
        extent_mm=float(labels["extent_mm"]),
        extent_spacing=float(labels["extent_spacing"]),
        rate=float(labels["rate_hz"]),
        pass_period=math.nan,
        lag=math.nan,
        extent=float(labels["extent"]),
        known=False,
    )


def _answer(estimate: SizeEstimate) -> Answer:
    """The estimate in floats, whatever kind of numbers it came in."""
    mm_per_rad = estimate.extent_mm / estimate.extent if estimate.extent else math.nan
    return Answer(
        outcome=estimate.outcome.name.lower(),
        reason=estimate.reason,
        method=estimate.method,
        race=estimate.race,
        trust=float(estimate.trust),
        lag=float(estimate.lag),
        lag_interval=_floats(estimate.lag_interval),
        lag_arc=float(estimate.lag_arc),
        extent=float(estimate.extent),
        extent_interval=_floats(estimate.extent_interval),
        extent_mm=float(estimate.extent_mm),
        extent_mm_interval=_floats(estimate.extent_mm_interval),
        candidates=tuple(float(arc) for arc in estimate.candidates),
        candidates_mm=tuple(float(arc * mm_per_rad) for arc in estimate.candidates),
        event_times=np.asarray(estimate.event_times, dtype=np.float64),
    )


def _floats(interval: Bounds) -> Bounds:
    low, high = interval
    return float(low), float(high)


def _events(
    estimate: SizeEstimate, truth: EventTruth | None, period: float, spacing: float
) -> tuple[EventScores, EventScores]:
    """Scores of both kinds of event together, within a time and within an arc."""
    if truth is None:
        return NO_SCORES, NO_SCORES
    tolerances = (TOLERANCE_S, tolerance_of_arc(TOLERANCE_RAD, period, spacing))
    kinds = ((estimate.event_times[:, 0], truth.first), (estimate.event_times[:, 1], truth.last))
    scores = [sum((match_events(*kind, tolerance) for kind in kinds), NO_SCORES) for tolerance in tolerances]
    return scores[0], scores[1]
