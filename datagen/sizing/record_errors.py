"""Errors of one scored record: of its lag and its arc, by our estimate and by other rules, and its level of noise."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable

import numpy as np

from datagen.sizing.scored_record import CLEAN_DB, ScoredRecord

# Those of the size ladder, and others that are shown where records are nearest to them.
NOISE_LEVELS, OTHER_LEVELS = (math.inf, 20.0, 10.0, 5.0, 0.0), (40.0, 30.0, -10.0)


def noise_level(record: ScoredRecord) -> float:
    """The nominal noise level of a record, dB; infinite if it is clean, which is what 60 dB and more count as."""
    if not record.truth.snr_db < CLEAN_DB:
        return math.inf
    return min((*NOISE_LEVELS[1:], *OTHER_LEVELS), key=lambda level: abs(level - record.truth.snr_db))


def noise_levels(records: Iterable[ScoredRecord]) -> list[float]:
    """The levels of noise to report, quietest first: those of the size ladder, and others that records have."""
    return sorted({*NOISE_LEVELS, *map(noise_level, records)}, reverse=True)


def noise_name(level: float) -> str:
    """ "clean" or the level in dB."""
    return "clean" if level == math.inf else f"{level:g}"


def noise_title(level: float) -> str:
    """ "clean" or the level with its unit, as in the names of figures."""
    return noise_name(level) + ("" if level == math.inf else " dB")


def lag_error(record: ScoredRecord) -> float:
    """|error| of the lag over its true value."""
    return abs(record.answer.lag - record.truth.lag) / record.truth.lag


def arc_error(record: ScoredRecord, arc: float) -> float:
    """|error| of an `arc` (rad) over the true extent of the record's spall."""
    return abs(arc - record.truth.extent) / record.truth.extent


def extent_error(record: ScoredRecord) -> float:
    """|error| of the extent over its true value."""
    return arc_error(record, record.answer.extent)


RULES: dict[str, Callable[[ScoredRecord], float]] = {
    "full size, own lag": lambda record: arc_error(record, record.answer.lag_arc),
    "half size, own lag": lambda record: arc_error(record, 2.0 * record.answer.lag_arc),
    "plain envelope lag": lambda record: arc_error(record, record.envelope_arc),
    "own lag and static release": lambda record: arc_error(record, record.static_arc),
}


def silent(record: ScoredRecord) -> float:
    """1 if the record was given no size, else 0."""
    return float(not record.found)


def mean_of(values: list[float]) -> float:
    """Mean of errors, those left out that are unknown (NaN); NaN without any."""
    known = [value for value in values if math.isfinite(value)]
    return float(np.mean(known)) if known else math.nan


def median_of(values: list[float]) -> float:
    """Median of errors, those left out that are unknown (NaN); NaN without any."""
    known = [value for value in values if math.isfinite(value)]
    return float(np.median(known)) if known else math.nan
