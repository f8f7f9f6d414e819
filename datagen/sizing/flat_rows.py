"""Scored records as the flat rows of `estimates.csv` and of the JSON report, whose names others rely on."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from datagen.sizing.scored_record import ScoredRecord
from labels.spall_size.size_estimate import Interval

if TYPE_CHECKING:
    from datagen.sizing.score import SizeScores


def flat_scores(scores: SizeScores) -> dict[str, Any]:
    """The scores by the names of the JSON report, their records as flat rows."""
    by_name = {field.name: getattr(scores, field.name) for field in fields(scores)}
    return by_name | {"records": [flat_row(one) for one in scores.records]}


def flat_row(one: ScoredRecord) -> dict[str, Any]:
    """A record by the names of the table, in its order: truth and estimate side by side, the bounds of 90 % intervals
    as `_low` and `_high`."""
    truth, told = one.truth, one.told
    return {
        "record": truth.record,
        "recording": truth.recording,
        "channel": truth.channel,
        "bearing_id": truth.bearing_id,
        "rig": truth.rig,
        "race": truth.race,
        "profile": truth.profile,
        "split": truth.split,
        "snr_db": truth.snr_db,
        "speed_rpm": truth.speed_rpm,
        "load_n": truth.load_n,
        "extent_mm": truth.extent_mm,
        "extent_spacing": truth.extent_spacing,
        "rate": truth.rate,
        "pass_period": truth.pass_period,
        "true_lag": truth.lag,
        "true_extent": truth.extent,
        "outcome": told.outcome,
        "reason": told.reason,
        "method": told.method,
        "found_race": told.race,
        "trust": told.trust,
        **_with_bounds("lag", told.lag, told.lag_interval),
        "lag_arc": told.lag_arc,
        **_with_bounds("extent", told.extent, told.extent_interval),
        **_with_bounds("estimated_deg", told.extent_deg, told.extent_deg_interval),
        **_with_bounds("estimated_mm", told.extent_mm, told.extent_mm_interval),
        "candidates": told.candidates,
        "candidates_deg": told.candidates_deg,
        "candidates_mm": told.candidates_mm,
        "static_arc": one.static_arc,
        "envelope_arc": one.envelope_arc,
        "known_size_factor": told.known_size_factor,
        "seconds": told.seconds,
        "event_times": told.event_times,
        "events_in_time": one.events_in_time,
        "events_in_arc": one.events_in_arc,
        "known_truth": truth.known,
    }


def _with_bounds(name: str, value: float, interval: Interval) -> dict[str, float]:
    low, high = interval
    return {name: value, f"{name}_low": low, f"{name}_high": high}
