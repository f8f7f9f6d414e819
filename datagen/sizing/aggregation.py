"""What the scored records say together: figures, tables of errors, and what more is known of events and long spalls."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from datagen.sizing.bearing_intervals import bearing_numbers, interval_over_bearings, mean_with_interval
from datagen.sizing.error_tables import error_tables
from datagen.sizing.figures import figures_of
from datagen.sizing.record_errors import extent_error, mean_of, median_of, noise_level
from datagen.sizing.scored_record import NO_SCORES, ScoredRecord
from datagen.sizing.size_summary import EventFigures, KnownSizeErrors, LongSpalls, Seconds, SizeSummary
from labels.event_scores import EventScores
from labels.interval import Interval
from labels.spall_size.known_size import known_size_factor
from physics.arrays import Array


def summarise(records: list[ScoredRecord], load_known: bool) -> SizeSummary:
    """Figures, tables by dependence, and counts of records of known truth."""
    return SizeSummary(
        records=len(records),
        scorable=sum(one.scorable for one in records),
        without_event=sum(one.without_event for one in records),
        load_and_hertz_factor_given=load_known,
        figures=figures_of(records, load_known),
        by=error_tables(records),
        events=_events(records),
        long=_long(records),
        known_size_of_another_record=_known_size(records),
        seconds_per_record=Seconds(
            mean=mean_of([one.answer.seconds for one in records]),
            largest_after_first=max((one.answer.seconds for one in records[1:]), default=math.nan),
        ),
    )


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
        median=median_of(errors),
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
        arc_error_without=mean_of(before),
        arc_error_with=mean_of(after),
        median_without=median_of(before),
        median_with=median_of(after),
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
