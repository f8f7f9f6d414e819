"""Scored records as the flat rows of `estimates.csv` and of the JSON report, whose names others rely on."""

from __future__ import annotations

import math
from dataclasses import asdict, fields, is_dataclass
from typing import Any

from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_scores import SizeScores
from datagen.sizing.size_summary import Figure
from labels.interval import Interval


def flat_scores(scores: SizeScores) -> dict[str, Any]:
    """The scores by the names of the JSON report, their records as flat rows and the ends of intervals beside means."""
    by_name = {field.name: getattr(scores, field.name) for field in fields(scores)}
    return by_name | {
        "records": [flat_row(record) for record in scores.records],
        "summary": flat_summary(scores.summary),
        "stated": flat_summary(scores.stated),
    }


def flat_summary(part: Any) -> Any:
    """A summary, or a part of one, with every mean `x` as `x`, `x_low` and `x_high`; that of a figure as `value`,
    `low` and `high`."""
    if isinstance(part, Figure):
        return {"name": part.name, **asdict(part.mean), "count": part.count, "target": part.target, "met": part.met}
    if isinstance(part, dict):
        return {name: flat_summary(value) for name, value in part.items()}
    if isinstance(part, list):
        return [flat_summary(value) for value in part]
    if not is_dataclass(part):
        return part
    found: dict[str, Any] = {}
    for name, value in ((field.name, getattr(part, field.name)) for field in fields(part)):
        bounds = isinstance(value, Interval)
        found |= _with_bounds(name, value.value, (value.low, value.high)) if bounds else {name: flat_summary(value)}
    return found


def flat_row(record: ScoredRecord) -> dict[str, Any]:
    """A record by the names of the table, in its order: truth and estimate side by side, the bounds of 90 % intervals
    as `_low` and `_high`."""
    truth, answer = record.truth, record.answer
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
        "outcome": answer.outcome,
        "reason": answer.reason,
        "method": answer.method,
        "found_race": answer.race,
        "trust": answer.trust,
        **_with_bounds("lag", answer.lag, answer.lag_interval),
        "lag_arc": answer.lag_arc,
        **_with_bounds("extent", answer.extent, answer.extent_interval),
        **_with_bounds("estimated_deg", answer.extent_deg, answer.extent_deg_interval),
        **_with_bounds("estimated_mm", answer.extent_mm, answer.extent_mm_interval),
        "candidates": answer.candidates,
        "candidates_deg": answer.candidates_deg,
        "candidates_mm": answer.candidates_mm,
        "complement_deg": math.degrees(answer.complement),
        "complement_mm": answer.complement_mm,
        "static_arc": record.static_arc,
        "envelope_arc": record.envelope_arc,
        "known_size_factor": answer.known_size_factor,
        "seconds": answer.seconds,
        "event_times": answer.event_times,
        "events_in_time": record.events_in_time,
        "events_in_arc": record.events_in_arc,
        "known_truth": truth.known,
    }


def _with_bounds(name: str, value: float, interval: tuple[float, float]) -> dict[str, float]:
    low, high = interval
    return {name: value, f"{name}_low": low, f"{name}_high": high}
