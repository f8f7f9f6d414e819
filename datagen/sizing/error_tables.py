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
    scorable = [one for one in records if one.scorable]
    keys: dict[str, Callable[[ScoredRecord], Bin]] = {
        "noise, dB": lambda one: (-noise_level(one), noise_name(noise_level(one))),
        "size, spacings": _binned(lambda one: one.truth.extent_spacing, (0.0, 0.05, 0.1, 0.2, 0.4, 0.9)),
        "size, mm": _binned(lambda one: one.truth.extent_mm, (0.0, 0.5, 1.0, 2.0, 4.0, 16.0)),
        "true lag, samples": _binned(lambda one: one.truth.lag * one.truth.rate, (0.0, 10.0, 20.0, 50.0, 150.0, 1e9)),
        "speed, rpm": _binned(lambda one: one.truth.speed_rpm, (0.0, 600.0, 1200.0, 1800.0, 2400.0, 1e9)),
        "load, N": _binned(lambda one: one.truth.load_n, (0.0, 50.0, 200.0, 800.0, 1e9)),
        "race": lambda one: (0.0, one.truth.race),
        "profile": lambda one: (0.0, one.truth.profile),
        "rig": lambda one: (0.0, one.truth.rig),
    }
    return {name: _table(scorable, key) for name, key in keys.items()}


def _binned(of: Callable[[ScoredRecord], float], edges: tuple[float, ...]) -> Callable[[ScoredRecord], Bin]:
    def place(one: ScoredRecord) -> Bin:
        k = int(np.clip(np.searchsorted(edges, of(one), side="right") - 1, 0, len(edges) - 2))
        return edges[k], f"over {edges[k]:g}" if k == len(edges) - 2 else f"{edges[k]:g}–{edges[k + 1]:g}"

    return place


def _table(records: list[ScoredRecord], key: Callable[[ScoredRecord], Bin]) -> list[ErrorRow]:
    groups: dict[Bin, list[ScoredRecord]] = {}
    for one in records:
        groups.setdefault(key(one), []).append(one)
    return [_row(name, own) for (_, name), own in sorted(groups.items())]


def _row(value: str, records: list[ScoredRecord]) -> ErrorRow:
    answered = [one for one in records if one.found]
    lag, arc = [lag_error(one) for one in answered], [extent_error(one) for one in answered]
    return ErrorRow(
        value=value,
        records=len(records),
        no_estimate=mean_with_interval([silent(one) for one in records], records),
        lag_error=mean_with_interval(lag, answered),
        lag_error_median=median_of(lag),
        arc_error=mean_with_interval(arc, answered),
        arc_error_median=median_of(arc),
    )
