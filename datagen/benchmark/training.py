"""Training: which records are learned from, and the classifier that comes out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.answers import class_probability, estimator_name
from datagen.benchmark.known import true_class
from datagen.benchmark.rows import Reading, Rows, read_rows
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.own_code import own_code
from datagen.telling import Count, Say, unheard
from labels.classifier.alarm import Alarm
from labels.classifier.classes import CLASSES, EVEN, HEALTHY
from labels.classifier.learners import LEARNERS
from labels.classifier.rule import Rule, fit_rule, line_heights
from labels.classifier.spall_classifier import SpallClassifier
from labels.classifier.votes import vote_shares
from physics.arrays import Array, Flags

if TYPE_CHECKING:
    import pandas

# Hz; the bandwidth of each row learned from is drawn between this and the record's own.
LOWEST_BANDWIDTH = 5500.0
# dB; lowest and highest ratio of signal over noise in the noisy copies that are learned from.
COPIES_DB = (-18.0, 12.0)
# Virtual bearings; with fewer nothing is learned.
FEWEST_BEARINGS = 4
# Rows that an estimator is asked about at once, so that memory does not grow with the corpus.
ROWS_AT_A_TIME = 2048
# Rows that a user's estimator is asked about once fitted, so that what it gets wrong is told before scoring.
ROWS_TO_TRY = 8


@dataclass(frozen=True)
class TrainingSet:
    """Rows (N, F) to learn from, their classes (N,) and virtual bearings (N,), the records (N,) that they came from,
    which (N,) had noise added, and the axis (N,) of its record that each is (None: of one)."""

    table: Array
    classes: NDArray[np.str_]
    bearings: NDArray[np.str_]
    records: NDArray[np.int64]
    noisy: NDArray[np.bool_]
    axes: NDArray[np.int64] | None = None

    def subset(self, chosen: NDArray[np.bool_]) -> TrainingSet:
        """The rows (M, F) that are `chosen` (N,), with all that is known of them."""
        return TrainingSet(
            self.table[chosen],
            self.classes[chosen],
            self.bearings[chosen],
            self.records[chosen],
            self.noisy[chosen],
            None if self.axes is None else self.axes[chosen],
        )


@dataclass(frozen=True)
class Model:
    """Anything that gives probabilities (N, 5) of CLASSES, with the alarm at which a spall is called: one probability,
    or one that depends on the row.

    `takes_windows` if it wants raw windows instead of features; `given` is how the user named their own in the command.
    """

    name: str
    estimator: Any
    alarm: Alarm | float
    takes_windows: bool = False
    given: str = ""

    def alarms(self, table: Array, several: Flags) -> Array:
        """Probability (N,) of a spall at which each row is called; `several` (N,) marks those of records of several
        axes."""
        return self.alarm.at(table, several) if isinstance(self.alarm, Alarm) else np.full(len(table), self.alarm)

    def shares(self, margin: Array, owner: NDArray[np.int64], axis: NDArray[np.int64]) -> Array | None:
        """Shares (N,) of rows in the vote of their record, by the `margin` (N,) in log odds that each has over its
        alarm; even (None) for an estimator of the user's, whose alarm knows nothing of axes."""
        return vote_shares(margin, owner, axis) if isinstance(self.alarm, Alarm) else None

    def by_lines_alone(
        self, table: Array, owner: NDArray[np.int64], records: NDArray[np.int64], axis: NDArray[np.int64]
    ) -> Flags:
        """Whether (R,) each of `records` (R,) is called for its lines alone, by the vote of its rows; `owner` (N,) are
        the records of the rows and `axis` (N,) their axes."""
        if not isinstance(self.alarm, Alarm):  # an estimator of the user's, whose table may hold raw windows
            return np.zeros(len(records), dtype=bool)
        return self.alarm.by_lines_alone(line_heights(table, owner, records, axis, self.alarm.height_several))

    def probability(self, table: Array) -> Array:
        """Probabilities (N, 5) of CLASSES, some rows at a time; a class that the estimator never saw has 0."""
        starts = range(0, max(len(table), 1), ROWS_AT_A_TIME)
        return np.concatenate(
            [class_probability(self.estimator, table[start : start + ROWS_AT_A_TIME], self.given) for start in starts]
        )


def training_records(folder: Path, also_tested: bool, first: int | None = None) -> pandas.DataFrame:
    """Labels of the records to learn from, the `first` so many: without the split "test" where that is tested on.

    Raises BadInput if it is a corpus of recordings, or holds too few virtual bearings.
    """
    labels = Corpus(folder).labels
    classes = np.array([true_class(row) for _, row in labels.iterrows()])
    chosen = labels[np.isin(classes, CLASSES)]
    if also_tested:
        chosen = chosen[chosen["split"] != "test"]
    chosen = chosen.iloc[:first]
    if chosen["bearing_id"].nunique() < FEWEST_BEARINGS:
        allowed = f"a corpus with {FEWEST_BEARINGS} virtual bearings or more outside its split test"
        raise BadInput("too few virtual bearings to learn from", str(folder), "--train", None, allowed)
    return chosen


def training_set(
    folder: Path, labels: pandas.DataFrame, reading: Reading, workers: int, count: Count = unheard
) -> TrainingSet:
    """Rows of the records with these labels, with their classes and bearings; `count` hears how many are done."""
    rows = read_rows(folder, labels["record"].to_numpy(np.int64), reading, workers, count)
    return joined_labels(rows, labels)


def joined_labels(rows: Rows, labels: pandas.DataFrame) -> TrainingSet:
    """The rows with class and bearing of the record that each came from."""
    by_record = labels.set_index("record", drop=False)
    class_of = {record: true_class(row) for record, row in by_record.iterrows()}
    bearing_of = by_record["bearing_id"].astype(str).to_dict()
    owners = rows.record.tolist()
    classes = np.array([class_of[record] for record in owners], dtype=np.str_)
    bearings = np.array([bearing_of[record] for record in owners], dtype=np.str_)
    noisy = np.zeros(len(owners), dtype=bool) if rows.noisy is None else rows.noisy
    return TrainingSet(rows.table, classes, bearings, rows.record, noisy, rows.axes)


def train_rule(training: TrainingSet) -> Rule:
    """The rule, its threshold set on the healthy records as they are; raises BadInput if there are none."""
    healthy = (training.classes == HEALTHY) & ~training.noisy
    if not healthy.any():
        raise BadInput("no healthy record to set the rule's threshold on", field="--train")
    records = training.records[healthy]
    axes = np.zeros_like(records) if training.axes is None else training.axes[healthy]
    return fit_rule(training.table[healthy], records, axes)


def train_models(training: TrainingSet, learner: str, step: Say = unheard) -> list[Model]:
    """One model a learner ("all": every one); `step` hears which. Raises BadInput if it cannot learn from this."""
    try:
        names = LEARNERS if learner == "all" else (learner,)
        fitted = []
        for name in names:
            step(f"learning: {name}")
            fitted.append((name, _fitted(name, training)))
        return [Model(name, classifier, classifier.alarm_) for name, classifier in fitted]
    except ValueError as problem:
        raise BadInput(f"cannot learn from this corpus: {problem}", field="--train") from None


def _fitted(name: str, training: TrainingSet) -> SpallClassifier:
    return SpallClassifier(name).fit(
        training.table, training.classes, training.bearings, training.records, training.noisy, training.axes
    )


def copy_of(own: Any, given: str = "") -> Any:
    """An unfitted copy of the user's estimator; raises BadInput, which names it as `given`, if it cannot be copied."""
    from sklearn.base import clone

    with own_code(given or estimator_name(own), "it cannot be copied"):
        return clone(own, safe=False)


def train_own(training: TrainingSet, own: Any, takes_windows: bool, given: str = "") -> Model:
    """The user's estimator, fitted if it can be; its spalls are called at even odds. `given` is its name in messages.

    Raises BadInput if it cannot be fitted, or answers anything but our classes to the first rows.
    """
    name = estimator_name(own)
    if hasattr(own, "fit"):
        with own_code(given or name, "it failed to learn"):
            own.fit(training.table, training.classes)
    model = Model(name, own, EVEN, takes_windows, given)
    if len(training.table):
        model.probability(training.table[:ROWS_TO_TRY])
    return model
