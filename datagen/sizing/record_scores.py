"""One record estimated and set beside its truth, or listed with the reason why it was not."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from datagen.sizing.estimators import AnyEstimator
from datagen.sizing.scored_record import NO_SCORES, NOT_ASKED, ScoredRecord
from datagen.sizing.sized_records import SizedRecord, UnsizedRecord, nominal_period
from labels.event_scores import EventScores, match_events, tolerance_of_arc
from labels.features.modulation import RACES
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.known_size import corrected
from labels.spall_size.rules import EnvelopeLagRule
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome
from labels.spall_size.static_release import arc_with_static_release

TOLERANCE_S = 100e-6
TOLERANCE_RAD = math.radians(0.5)
WORDS = ("recording", "channel", "bearing_id", "rig", "profile", "split")
NUMBERS = ("snr_db", "speed_rpm", "load_n", "extent_mm", "extent_spacing")


def score_record(sized: SizedRecord, estimator: AnyEstimator, factor: float = 1.0) -> ScoredRecord:
    """The estimate of one record beside its truth; a known size of another record has told its `factor`."""
    labels, situation = sized.labels, sized.situation
    began = time.process_time()
    told = estimator.estimate(sized.acceleration, sized.rate, situation)
    seconds = time.process_time() - began
    if told.found and factor != 1.0:
        told = corrected(told, factor)
    period = nominal_period(labels)
    in_time, in_arc = _events(told, sized.truth, period, situation.bearing().spacing)
    plain = EnvelopeLagRule().estimate(sized.acceleration, sized.rate, _with_race(situation, told, labels))
    static = math.nan
    if told.found and told.race in RACES and situation.load_known and situation.load is not None:
        static = arc_with_static_release(told.lag_arc, situation.bearing(), told.race, situation.load)
    return ScoredRecord(
        **_labels(labels), **_told(told), pass_period=period,
        true_lag=math.nan if sized.truth is None else sized.truth.lag,
        static_arc=static, envelope_arc=plain.lag_arc, known_size_factor=factor if told.found else 1.0, seconds=seconds,
        events_in_time=in_time, events_in_arc=in_arc, known_truth=sized.truth is not None,
    )  # fmt: skip


def _with_race(situation: Situation, told: SizeEstimate, labels: Mapping[str, Any]) -> Situation:
    """The situation with the race that was told, or where none was told the true one; unchanged without a spall."""
    race = told.race if told.race in RACES else str(labels["location"])
    return replace(situation, race=race) if race in RACES else situation


def unsized_row(unsized: UnsizedRecord) -> ScoredRecord:
    """The row of a record that no estimator could be asked about."""
    told = _told(SizeEstimate(SizeOutcome.NO_PASSES, "")) | {"outcome": NOT_ASKED, "reason": unsized.reason}
    return ScoredRecord(
        **_labels(unsized.labels), **told, pass_period=math.nan, true_lag=math.nan, static_arc=math.nan,
        envelope_arc=math.nan, known_size_factor=1.0, seconds=0.0,
        events_in_time=NO_SCORES, events_in_arc=NO_SCORES, known_truth=False,
    )  # fmt: skip


def _labels(labels: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "record": int(labels["record"]),
        "race": str(labels["location"]),
        "rate": float(labels["rate_hz"]),
        "true_extent": float(labels["extent"]),
        **{name: str(labels[name]) for name in WORDS},
        **{name: float(labels[name]) for name in NUMBERS},
    }


def _told(told: SizeEstimate) -> dict[str, Any]:
    mm_per_rad = told.extent_mm / told.extent if told.extent else math.nan
    bounds = {
        "lag": (told.lag, told.lag_interval),
        "extent": (told.extent, told.extent_interval),
        "estimated_deg": (math.degrees(told.extent), tuple(map(math.degrees, told.extent_interval))),
        "estimated_mm": (told.extent_mm, told.extent_mm_interval),
    }
    numbers: dict[str, Any] = {}
    for name, (value, (low, high)) in bounds.items():
        numbers |= {name: float(value), f"{name}_low": float(low), f"{name}_high": float(high)}
    return numbers | {
        "outcome": told.outcome.name.lower(),
        "reason": told.reason,
        "method": told.method,
        "found_race": told.race,
        "trust": float(told.trust),
        "lag_arc": float(told.lag_arc),
        "candidates": tuple(float(arc) for arc in told.candidates),
        "candidates_deg": tuple(math.degrees(arc) for arc in told.candidates),
        "candidates_mm": tuple(float(arc * mm_per_rad) for arc in told.candidates),
        "event_times": np.asarray(told.event_times, dtype=np.float64),
    }


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
