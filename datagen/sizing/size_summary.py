"""What is said of many scored records together; the names of its fields are those of the JSON report.

Intervals are of 90 %, of a bootstrap over virtual bearings: of a mean `x` they end at `x_low` and `x_high`, NaN from
fewer than two bearings.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """A measured mean over `count` records with its interval, and its target if there is one."""

    name: str
    value: float
    low: float
    high: float
    count: int
    target: str = ""
    met: bool | None = None


@dataclass(frozen=True)
class ErrorRow:
    """Records of one `value` of what errors may depend on: share without an estimate, relative errors of the others."""

    value: str
    records: int
    no_estimate: float
    no_estimate_low: float
    no_estimate_high: float
    lag_error: float
    lag_error_low: float
    lag_error_high: float
    lag_error_median: float
    arc_error: float
    arc_error_low: float
    arc_error_high: float
    arc_error_median: float


@dataclass(frozen=True)
class EventFigures:
    """Numbers of `true` and of `found` events of all records together, and how well they agree."""

    true: int
    found: int
    precision: float
    precision_low: float
    precision_high: float
    recall: float
    recall_low: float
    recall_high: float
    f1: float
    f1_low: float
    f1_high: float


@dataclass(frozen=True)
class LongSpalls:
    """Spalls beyond 0.9 spacings: how often one was `told`, and how far (a share) its nearest candidate is off."""

    records: int
    told: int
    error_of_nearest_candidate: float
    error_of_nearest_candidate_low: float
    error_of_nearest_candidate_high: float
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
    """Scores of records with known truth, of which `scorable` were to be told a size and `without_event` were not.

    `by` has the rows of errors by the name of what they may depend on, `events` their scores by how near is near.
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
    """Scores of recordings whose ball passes are unknown, by what is stated of them: `records` of a stated extent and
    relative errors of the arc of those `told` a size, and how many stated `healthy` were told one."""

    records: int
    told: int
    told_on_the_stated_race: int
    arc_error: float
    arc_error_low: float
    arc_error_high: float
    healthy: int
    healthy_told: int
