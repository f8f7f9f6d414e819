"""What the scored records say together: each target with its figure, and errors by what they depend on."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from datagen.sizing.bearing_intervals import bearing_numbers, interval_over_bearings, mean_with_interval
from datagen.sizing.scored_record import CLEAN_DB, NO_SCORES, ScoredRecord
from datagen.sizing.size_summary import (
    ErrorRow,
    EventFigures,
    Figure,
    KnownSizeErrors,
    LongSpalls,
    Seconds,
    SizeSummary,
)
from labels.event_scores import EventScores
from labels.interval import Interval
from labels.spall_size.known_size import known_size_factor
from physics.arrays import Array

NOISE_LEVELS = (math.inf, 20.0, 10.0, 5.0, 0.0)


def summarise(records: list[ScoredRecord], load_known: bool) -> SizeSummary:
    """Figures, tables by dependence, and counts of records of known truth."""
    return SizeSummary(
        records=len(records),
        scorable=sum(one.scorable for one in records),
        without_event=sum(one.without_event for one in records),
        load_and_hertz_factor_given=load_known,
        figures=_figures(records, load_known),
        by=_tables(records),
        events=_events(records),
        long=_long(records),
        known_size_of_another_record=_known_size(records),
        seconds_per_record=Seconds(
            mean=_mean([one.answer.seconds for one in records]),
            largest_after_first=max((one.answer.seconds for one in records[1:]), default=math.nan),
        ),
    )


def noise_level(one: ScoredRecord) -> float:
    """The nominal noise level of a record, dB; infinite if it is clean, which is what 60 dB and more count as."""
    if not one.truth.snr_db < CLEAN_DB:
        return math.inf
    return min(NOISE_LEVELS[1:], key=lambda level: abs(level - one.truth.snr_db))


def lag_error(one: ScoredRecord) -> float:
    """|error| of the lag over its true value."""
    return abs(one.answer.lag - one.truth.lag) / one.truth.lag


def extent_error(one: ScoredRecord) -> float:
    """|error| of the extent over its true value."""
    return abs(one.answer.extent - one.truth.extent) / one.truth.extent


def _rule(arc: Callable[[ScoredRecord], float]) -> Callable[[ScoredRecord], float]:
    return lambda one: abs(arc(one) - one.truth.extent) / one.truth.extent


RULES: dict[str, Callable[[ScoredRecord], float]] = {
    "full size, own lag": _rule(lambda one: one.answer.lag_arc),
    "half size, own lag": _rule(lambda one: 2.0 * one.answer.lag_arc),
    "plain envelope lag": _rule(lambda one: one.envelope_arc),
    "own lag and static release": _rule(lambda one: one.static_arc),
}


def _figures(records: list[ScoredRecord], load_known: bool) -> list[Figure]:
    scorable = [one for one in records if one.scorable]
    answered = [one for one in scorable if one.found]
    figures: list[Figure] = []
    for level in NOISE_LEVELS:
        name = noise_name(level) + ("" if level == math.inf else " dB")
        own = [one for one in answered if noise_level(one) == level]
        asked = [one for one in scorable if noise_level(one) == level]
        figures.append(_figure(f"lag error, {name}", own, lag_error, {math.inf: 0.05, 10.0: 0.10}.get(level)))
        arc_target = {math.inf: 0.10, 10.0: 0.15}.get(level) if load_known else None
        figures.append(_figure(f"arc error, {name}", own, extent_error, arc_target))
        figures += [_figure(f"arc error by rule: {rule}, {name}", own, error) for rule, error in RULES.items()]
        figures.append(_figure(f"no estimate, {name}", asked, _silent, 0.05 if level == math.inf else None))
    eventless = [one for one in records if one.without_event]
    figures.append(_figure("abstention where there is no event", eventless, _silent, 0.95, at_least=True))
    figures.append(_coverage("lag", answered, lambda one: _holds(one.answer.lag_interval, one.truth.lag)))
    figures.append(_coverage("arc", answered, lambda one: _holds(one.answer.extent_interval, one.truth.extent)))
    return figures


def _holds(interval: tuple[float, float], true: float) -> float:
    low, high = interval
    return float(low <= true <= high)


def _silent(one: ScoredRecord) -> float:
    return float(not one.found)


def _figure(
    name: str,
    records: list[ScoredRecord],
    value: Callable[[ScoredRecord], float],
    target: float | None = None,
    *,
    at_least: bool = False,
) -> Figure:
    values = np.array([value(one) for one in records])
    kept = np.isfinite(values)
    if not kept.any():
        return Figure(name, mean_with_interval([], []), 0)
    ends = interval_over_bearings(values[kept], bearing_numbers(records)[kept])
    mean, count = Interval(float(values[kept].mean()), *ends), int(kept.sum())
    if target is None:
        return Figure(name, mean, count)
    met = mean.value >= target if at_least else mean.value <= target
    return Figure(name, mean, count, f"{'≥' if at_least else '≤'} {target:g}", bool(met))


def _coverage(what: str, answered: list[ScoredRecord], inside: Callable[[ScoredRecord], float]) -> Figure:
    plain = _figure(f"90 % interval of the {what} holds the truth", answered, inside)
    return replace(plain, target="0.85 to 0.95", met=0.85 <= plain.mean.value <= 0.95)


Bin = tuple[float, str]


def _tables(records: list[ScoredRecord]) -> dict[str, list[ErrorRow]]:
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


def noise_name(level: float) -> str:
    """ "clean" or the level in dB."""
    return "clean" if level == math.inf else f"{level:g}"


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
        no_estimate=mean_with_interval([_silent(one) for one in records], records),
        lag_error=mean_with_interval(lag, answered),
        lag_error_median=_median(lag),
        arc_error=mean_with_interval(arc, answered),
        arc_error_median=_median(arc),
    )


def _mean(values: list[float]) -> float:
    return float(np.mean(values)) if values else math.nan


def _median(values: list[float]) -> float:
    return float(np.median(values)) if values else math.nan


def _long(records: list[ScoredRecord]) -> LongSpalls:
    """Spalls beyond 0.9 spacings: how far the nearest candidate is from the truth, and how often one was given."""
    own = [one for one in records if one.has_events and not one.scorable]
    answered = [one for one in own if one.found]
    near = [one for one in answered if one.answer.candidates]
    errors = [min(abs(c - one.truth.extent) for c in one.answer.candidates) / one.truth.extent for one in near]
    return LongSpalls(
        records=len(own),
        answered=len(answered),
        error_of_nearest_candidate=mean_with_interval(errors, near),
        median=_median(errors),
    )


def _known_size(records: list[ScoredRecord]) -> KnownSizeErrors:
    """Arc error of answered records before and after correction by one other of the same virtual bearing."""
    answered = [one for one in records if one.scorable and one.found]
    of_bearing: dict[tuple[str, str], list[ScoredRecord]] = {}
    for one in answered:
        of_bearing.setdefault(one.bearing_group, []).append(one)
    known_for = {bearing: _two_surest(own) for bearing, own in of_bearing.items()}
    before, after = [], []
    for one in answered:
        known = next((other for other in known_for[one.bearing_group] if other.truth.record != one.truth.record), None)
        if known is not None:
            factor = known_size_factor(known.answer.extent, known.truth.extent)
            before.append(extent_error(one))
            after.append(abs(one.answer.extent * factor - one.truth.extent) / one.truth.extent)
    return KnownSizeErrors(
        records=len(before),
        arc_error_without=_mean(before),
        arc_error_with=_mean(after),
        median_without=_median(before),
        median_with=_median(after),
    )


def _two_surest(records: list[ScoredRecord]) -> list[ScoredRecord]:
    """The record of least noise and most trust, and the next one: all other records of the bearing are corrected by the
    first, and the first by the second."""

    def sure(one: ScoredRecord) -> tuple[float, float]:
        return noise_level(one), one.answer.trust

    first = max(records, key=sure)
    return [
        first,
        *sorted((one for one in records if one.truth.record != first.truth.record), key=sure, reverse=True)[:1],
    ]


def _events(records: list[ScoredRecord]) -> dict[str, EventFigures]:
    """Scores of the events of all records and of those given a size, within a time and within an arc."""
    answered = [one for one in records if one.found]
    return {
        "within_100_us": _event_scores(records, lambda one: one.events_in_time),
        "within_0.5_degrees": _event_scores(records, lambda one: one.events_in_arc),
        "within_100_us, answered records": _event_scores(answered, lambda one: one.events_in_time),
        "within_0.5_degrees, answered records": _event_scores(answered, lambda one: one.events_in_arc),
    }


def _event_scores(records: list[ScoredRecord], scores: Callable[[ScoredRecord], EventScores]) -> EventFigures:
    """Precision, recall and F1 of all events together, each with its interval."""
    own = [scores(one) for one in records]
    total = sum(own, NO_SCORES)
    bearing = bearing_numbers(records)
    counts = np.array([(one.matched, one.found, one.true) for one in own], dtype=np.float64)
    matched, found, true = counts.reshape(-1, 3).T

    def share(value: float, above: Array, below: Array) -> Interval:
        return Interval(value, *(interval_over_bearings(above, bearing, below) if records else (math.nan, math.nan)))

    return EventFigures(
        true=total.true,
        found=total.found,
        precision=share(total.precision, matched, found),
        recall=share(total.recall, matched, true),
        f1=share(total.f1, 2.0 * matched, found + true),
    )
