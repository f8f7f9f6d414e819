"""The scores of many records together.

The fields are named as in the JSON report, where the interval of a mean `x` ends at `x_low` and `x_high`. Intervals are
of 90 %, from a bootstrap over virtual bearings, and NaN from fewer than two bearings.
"""

from __future__ import annotations

from dataclasses import dataclass

from labels.interval import Interval


@dataclass(frozen=True)
class Figure:
    """A measured mean over `count` records with its interval, and its target if there is one."""

    name: str
    mean: Interval
    count: int
    target: str = ""
    met: bool | None = None


@dataclass(frozen=True)
class ErrorRow:
    """Errors of the records that share one `value` of a property: share without an estimate, relative errors of the
    others."""

    value: str
    records: int
    no_estimate: Interval
    lag_error: Interval
    lag_error_median: float
    arc_error: Interval
    arc_error_median: float


@dataclass(frozen=True)
class EventFigures:
    """Numbers of `true` and of `found` events of all records together, and how well they agree."""

    true: int
    found: int
    precision: Interval
    recall: Interval
    f1: Interval


@dataclass(frozen=True)
class LongSpalls:
    """Spalls beyond 0.9 spacings: how often one was given, and how far (a share) its nearest candidate is off."""

    records: int
    answered: int
    error_of_nearest_candidate: Interval
    median: float


@dataclass(frozen=True)
class KnownSizeErrors:
    """Relative errors of the arc without and with the known size of one other record of the same virtual bearing."""

    records: int
    arc_error_without: float
    arc_error_with: float
    median_without: float
    median_with: float


@dataclass(frozen=True)
class Seconds:
    """Time that a record took, s: the mean of all, and the longest but for the first."""

    mean: float
    largest_after_first: float


@dataclass(frozen=True)
class SizeSummary:
    """Scores of records with known truth: `scorable` ones should be given a size, those `without_event` should not.

    `by` holds the rows of errors by the name of the property, `events` the scores of events by the tolerance within
    which they match.
    """

    records: int
    scorable: int
    without_event: int
    load_and_hertz_factor_given: bool
    figures: list[Figure]
    by: dict[str, list[ErrorRow]]
    events: dict[str, EventFigures]
    long: LongSpalls
    known_size_of_another_record: KnownSizeErrors
    seconds_per_record: Seconds


@dataclass(frozen=True)
class StatedSizes:
    """Scores of recordings whose ball passes are unknown, by what is stated of them: the number of `records` with a
    stated extent and relative errors of the arc of those `answered`, and how many stated `healthy` were given one."""

    records: int
    answered: int
    answered_on_the_stated_race: int
    arc_error: Interval
    healthy: int
    healthy_answered: int
