"""Errors of the scored records by what they depend on: noise, size, speed, load, race, profile and rig."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from datagen.sizing.bearing_intervals import mean_with_interval
from datagen.sizing.record_errors import extent_error, lag_error, median_of, noise_level, noise_name, silent
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_summary import ErrorRow

# Where a row stands in its table, and the name of the row.
Bin = tuple[float, str]


def error_tables(records: list[ScoredRecord]) -> dict[str, list[ErrorRow]]:
    """By each property of a record, a row of errors for every value or range of values."""
    scorable = [record for record in records if record.scorable]
    keys: dict[str, Callable[[ScoredRecord], Bin]] = {
        "noise, dB": lambda record: (-noise_level(record), noise_name(noise_level(record))),
        "size, spacings": _binned(lambda record: record.truth.extent_spacing, (0.0, 0.05, 0.1, 0.2, 0.4, 0.9)),
        "size, mm": _binned(lambda record: record.truth.extent_mm, (0.0, 0.5, 1.0, 2.0, 4.0, 16.0)),
        "true lag, samples": _binned(
            lambda record: record.truth.lag * record.truth.rate, (0.0, 10.0, 20.0, 50.0, 150.0, 1e9)
        ),
        "speed, rpm": _binned(lambda record: record.truth.speed_rpm, (0.0, 600.0, 1200.0, 1800.0, 2400.0, 1e9)),
        "load, N": _binned(lambda record: record.truth.load_n, (0.0, 50.0, 200.0, 800.0, 1e9)),
        "race": lambda record: (0.0, record.truth.race),
        "profile": lambda record: (0.0, record.truth.profile),
        "rig": lambda record: (0.0, record.truth.rig),
    }
    return {name: _table(scorable, key) for name, key in keys.items()}


def _binned(of: Callable[[ScoredRecord], float], edges: tuple[float, ...]) -> Callable[[ScoredRecord], Bin]:
    def place(record: ScoredRecord) -> Bin:
        k = int(np.clip(np.searchsorted(edges, of(record), side="right") - 1, 0, len(edges) - 2))
        return edges[k], f"over {edges[k]:g}" if k == len(edges) - 2 else f"{edges[k]:g}–{edges[k + 1]:g}"

    return place


def _table(records: list[ScoredRecord], key: Callable[[ScoredRecord], Bin]) -> list[ErrorRow]:
    groups: dict[Bin, list[ScoredRecord]] = {}
    for record in records:
        groups.setdefault(key(record), []).append(record)
    return [_row(name, group) for (_, name), group in sorted(groups.items())]


def _row(value: str, records: list[ScoredRecord]) -> ErrorRow:
    answered = [record for record in records if record.found]
    lag, arc = [lag_error(record) for record in answered], [extent_error(record) for record in answered]
    return ErrorRow(
        value=value,
        records=len(records),
        no_estimate=mean_with_interval([silent(record) for record in records], records, is_share=True),
        lag_error=mean_with_interval(lag, answered),
        lag_error_median=median_of(lag),
        arc_error=mean_with_interval(arc, answered),
        arc_error_median=median_of(arc),
    )
