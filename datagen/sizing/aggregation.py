"""The scored records summed up: figures, tables of errors, scores of events, and what is known about long spalls."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from datagen.sizing.bearing_intervals import bearing_numbers, interval_over_bearings, mean_with_interval
from datagen.sizing.error_tables import error_tables
from datagen.sizing.figures import figures_of
from datagen.sizing.record_errors import arc_error, mean_of, median_of, noise_level
from datagen.sizing.scored_record import NO_SCORES, ScoredRecord
from datagen.sizing.size_summary import EventFigures, KnownSizeErrors, LongSpalls, Seconds, SizeSummary
from labels.event_scores import EventScores
from labels.interval import Interval
from labels.spall_size.known_size import known_size_factor
from physics.arrays import Array


def summarise(records: list[ScoredRecord], load_known: bool) -> SizeSummary:
    """Figures, error tables and counts of `records` whose truth is known; `load_known` if the load was given."""
    return SizeSummary(
        records=len(records),
        scorable=sum(record.scorable for record in records),
        without_event=sum(record.without_event for record in records),
        load_and_hertz_factor_given=load_known,
        figures=figures_of(records, load_known),
        by=error_tables(records),
        events=_events(records),
        long=_long(records),
        known_size_of_another_record=_known_size(records),
        seconds_per_record=Seconds(
            mean=mean_of([record.answer.seconds for record in records]),
            largest_after_first=max((record.answer.seconds for record in records[1:]), default=math.nan),
        ),
    )


def _long(records: list[ScoredRecord]) -> LongSpalls:
    """Spalls longer than 0.9 ball spacings: how often a size was given, and how far its nearest candidate is off."""
    long = [record for record in records if record.has_events and not record.scorable]
    answered = [record for record in long if record.found]
    near = [record for record in answered if record.answer.candidates]
    errors = [min(arc_error(record, arc) for arc in record.answer.candidates) for record in near]
    return LongSpalls(
        records=len(long),
        answered=len(answered),
        error_of_nearest_candidate=mean_with_interval(errors, near),
        median=median_of(errors),
    )


def _known_size(records: list[ScoredRecord]) -> KnownSizeErrors:
    """Arc error of answered records before and after correction by one other of the same virtual bearing."""
    answered = [record for record in records if record.scorable and record.found]
    of_bearing: dict[tuple[str, str], list[ScoredRecord]] = {}
    for record in answered:
        of_bearing.setdefault(record.bearing_group, []).append(record)
    known_for = {bearing: _two_surest(its_records) for bearing, its_records in of_bearing.items()}
    before, after = [], []
    for record in answered:
        known = next(
            (other for other in known_for[record.bearing_group] if other.truth.record != record.truth.record), None
        )
        if known is not None:
            factor = known_size_factor(known.answer.own_extent, known.truth.extent)
            before.append(arc_error(record, record.answer.own_extent))
            after.append(arc_error(record, record.answer.own_extent * factor))
    return KnownSizeErrors(
        records=len(before),
        arc_error_without=mean_of(before),
        arc_error_with=mean_of(after),
        median_without=median_of(before),
        median_with=median_of(after),
    )


def _two_surest(records: list[ScoredRecord]) -> list[ScoredRecord]:
    """The record with the least noise and the most trust, and the runner-up: the first corrects all other records of
    the bearing, and the second corrects the first."""

    def sure(record: ScoredRecord) -> tuple[float, float]:
        return noise_level(record), record.answer.trust

    first = max(records, key=sure)
    others = [record for record in records if record.truth.record != first.truth.record]
    return [first, *sorted(others, key=sure, reverse=True)[:1]]


def _events(records: list[ScoredRecord]) -> dict[str, EventFigures]:
    """Scores of the events of all records and of those given a size, within a time and within an arc."""
    answered = [record for record in records if record.found]
    return {
        "within_100_us": _event_scores(records, lambda record: record.events_in_time),
        "within_0.5_degrees": _event_scores(records, lambda record: record.events_in_arc),
        "within_100_us, answered records": _event_scores(answered, lambda record: record.events_in_time),
        "within_0.5_degrees, answered records": _event_scores(answered, lambda record: record.events_in_arc),
    }


def _event_scores(records: list[ScoredRecord], scores: Callable[[ScoredRecord], EventScores]) -> EventFigures:
    """Precision, recall and F1 of all events together, each with its interval."""
    record_scores = [scores(record) for record in records]
    total = sum(record_scores, NO_SCORES)
    bearing = bearing_numbers(records)
    counts = np.array([(events.matched, events.found, events.true) for events in record_scores], dtype=np.float64)
    matched, found, true = counts.reshape(-1, 3).T

    def share(value: float, above: Array, below: Array) -> Interval:
        if not records:
            return Interval(value, math.nan, math.nan)
        return Interval(value, *interval_over_bearings(above, bearing, below, is_share=True))

    return EventFigures(
        true=total.true,
        found=total.found,
        precision=share(total.precision, matched, found),
        recall=share(total.recall, matched, true),
        f1=share(total.f1, 2.0 * matched, found + true),
    )
