"""Training: which records are learned from, and the classifier that comes out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.answers import class_probability, estimator_name
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.options import FIRST, TRAIN, Learning
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.rows import Rows
from datagen.benchmark.truth import true_classes
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.judging.splits import TEST
from datagen.judging.user_code import user_code
from datagen.progress import Count, Say, ignore
from labels.classifier.alarm import Alarm
from labels.classifier.classes import CLASSES, EVEN
from labels.classifier.learners import LEARNERS
from labels.classifier.rule import Rule, fit_rule, line_heights
from labels.classifier.spall_classifier import SpallClassifier
from labels.classifier.votes import of_several_axes, vote_shares
from labels.schema import HEALTHY
from physics.arrays import Array, Flags

if TYPE_CHECKING:
    import pandas

# Hz; the bandwidth of each row learned from is drawn between this and the record's own.
LOWEST_BANDWIDTH = 5500.0
# dB; lowest and highest ratio of signal over noise in the noisy copies that are learned from.
COPIES_DB = (-18.0, 12.0)
# Virtual bearings; with fewer nothing is learned.
FEWEST_BEARINGS = 4
TOO_FEW, ENOUGH = "too few virtual bearings to learn from", f"{FEWEST_BEARINGS} virtual bearings or more"
# Rows that an estimator is asked about at once, so that memory does not grow with the corpus.
ROWS_AT_A_TIME = 2048
# Rows that a user's estimator is asked about once fitted, so that a wrong answer is reported before scoring.
ROWS_TO_TRY = 8


@dataclass(frozen=True)
class TrainingSet:
    """The N `rows` to learn from, and of each the class, one of CLASSES, and the virtual bearing: `classes` (N,),
    `bearings` (N,)."""

    rows: Rows
    classes: NDArray[np.str_]
    bearings: NDArray[np.str_]

    def subset(self, chosen: Flags) -> TrainingSet:
        """What is known of the rows that are `chosen` (N,)."""
        return TrainingSet(self.rows[chosen], self.classes[chosen], self.bearings[chosen])


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

    def alarms(self, rows: Rows) -> Array:
        """Probability (N,) of a spall at which each row is called; an estimator of the user's has one for all rows."""
        if not isinstance(self.alarm, Alarm):
            return np.full(len(rows), self.alarm)
        return self.alarm.at(rows.table, of_several_axes(rows.record, rows.axis, rows.record))

    def shares(self, margin: Array, rows: Rows) -> Array | None:
        """Shares (N,) of rows in the vote of their record, by the `margin` (N,) in log odds that each has over its
        alarm; even (None) for an estimator of the user's, whose alarm knows nothing of axes."""
        return vote_shares(margin, rows.record, rows.axis) if isinstance(self.alarm, Alarm) else None

    def by_lines_alone(self, rows: Rows, records: NDArray[np.int64]) -> Flags:
        """Whether (R,) each of `records` (R,) is called for its lines alone, by the vote of its rows."""
        if not isinstance(self.alarm, Alarm):  # an estimator of the user's, whose table may hold raw windows
            return np.zeros(len(records), dtype=bool)
        heights = line_heights(rows.table, rows.record, records, rows.axis, self.alarm.height_several)
        return self.alarm.by_lines_alone(heights)

    def probability(self, table: Array) -> Array:
        """Probabilities (N, 5) of CLASSES, some rows at a time; a class that the estimator never saw has 0."""
        starts = range(0, max(len(table), 1), ROWS_AT_A_TIME)
        parts = (table[start : start + ROWS_AT_A_TIME] for start in starts)
        return np.concatenate([class_probability(self.estimator, part, self.given or self.name) for part in parts])


def training_records(folder: Path, also_tested: bool, first: int | None = None) -> pandas.DataFrame:
    """Labels of the records to learn from, the `first` so many: without the split "test" where that is tested on.

    Raises BadInput if these are of too few virtual bearings.
    """
    labels = Corpus(folder).labels
    chosen = labels[np.isin(true_classes(labels), CLASSES)]
    if also_tested:
        chosen = chosen[chosen["split"] != TEST]
    enough_in_all = chosen["bearing_id"].nunique() >= FEWEST_BEARINGS
    chosen = chosen.iloc[:first]
    if chosen["bearing_id"].nunique() < FEWEST_BEARINGS:
        if enough_in_all:
            raise too_few_bearings(first, str(folder))
        outside = f" outside its split {TEST}" if also_tested else ""
        raise BadInput(TOO_FEW, file=str(folder), field=TRAIN, allowed=f"a corpus with {ENOUGH}{outside}")
    return chosen


def too_few_bearings(first: int | None, file: str = "") -> BadInput:
    """The refusal of the `first` so many records, which are of too few virtual bearings."""
    return BadInput(TOO_FEW, file=file, field=FIRST, value=first, allowed=f"records of {ENOUGH}")


def training_set(
    folder: Path, labels: pandas.DataFrame, reading: Reading, workers: int, count: Count = ignore
) -> TrainingSet:
    """Rows of the records with these labels, with their classes and bearings; `count` is called with how many
    are done."""
    found = read_rows(folder, labels["record"].to_numpy(np.int64), reading, workers, count)
    return labelled(found.rows, labels)


def labelled(rows: Rows, labels: pandas.DataFrame) -> TrainingSet:
    """The rows with class and bearing of the record that each came from."""
    records = labels["record"].tolist()
    class_of = dict(zip(records, true_classes(labels).tolist(), strict=True))
    bearing_of = dict(zip(records, labels["bearing_id"].astype(str), strict=True))
    owners = rows.record.tolist()
    classes = np.array([class_of[record] for record in owners], dtype=np.str_)
    bearings = np.array([bearing_of[record] for record in owners], dtype=np.str_)
    return TrainingSet(rows, classes, bearings)


def train_rule(training: TrainingSet) -> Rule:
    """The rule, its threshold set on the healthy records as they are; raises BadInput if there are none."""
    healthy = training.rows[(training.classes == HEALTHY) & ~training.rows.noisy]
    if not len(healthy):
        problem = "no healthy record that can be judged, to set the rule's threshold on"
        raise BadInput(problem, field=TRAIN, allowed="one or more; `spallgen features` says why a record is not judged")
    return fit_rule(healthy.table, healthy.record, healthy.axis)


def train(training: TrainingSet, learning: Learning, estimator: Any | None, step: Say = ignore) -> list[Model]:
    """The models that the options of `learning` ask for: our learners, or the user's `estimator` that they name.

    `step` is called with the name of each. Raises BadInput if one cannot learn from this.
    """
    if estimator is None:
        return train_models(training, learning.learner, step)
    step(f"learning: {learning.estimator}")
    given = learning.estimator or estimator_name(estimator)
    return [train_user_estimator(training, estimator, learning.takes_windows, given)]


def train_models(training: TrainingSet, learner: str, step: Say = ignore) -> list[Model]:
    """One model a learner ("all": every one); `step` is called with the name of each.

    Raises BadInput if one cannot learn from this.
    """
    try:
        names = LEARNERS if learner == "all" else (learner,)
        fitted = []
        for name in names:
            step(f"learning: {name}")
            fitted.append((name, _fitted(name, training)))
        return [Model(name, classifier, classifier.alarm_) for name, classifier in fitted]
    except ValueError as problem:
        raise BadInput(f"cannot learn from this corpus: {problem}", field=TRAIN) from None


def _fitted(name: str, training: TrainingSet) -> SpallClassifier:
    rows = training.rows
    return SpallClassifier(name).fit(
        rows.table, training.classes, training.bearings, rows.record, rows.noisy, rows.axis
    )


def copy_of(estimator: Any, given: str) -> Any:
    """An unfitted copy of the user's estimator; raises BadInput, which names it as `given`, if it cannot be copied."""
    from sklearn.base import clone

    with user_code(given, "it cannot be copied"):
        return clone(estimator, safe=False)


def train_user_estimator(training: TrainingSet, estimator: Any, takes_windows: bool, given: str) -> Model:
    """The user's estimator, fitted if it can be; its spalls are called at even odds. `given` is its name in messages.

    Raises BadInput if it cannot be fitted, or answers anything but our classes to the first rows.
    """
    if hasattr(estimator, "fit"):
        table, classes = training.rows.table, training.classes
        with user_code(given, "it failed to learn"):
            # Scaled in place, rows would be others where they are looked at next; raw windows cannot be written to.
            estimator.fit(table if takes_windows else table.copy(), classes.copy())
    model = Model(estimator_name(estimator), estimator, EVEN, takes_windows, given)
    if len(training.rows):
        model.probability(training.rows.table[:ROWS_TO_TRY])
    return model
