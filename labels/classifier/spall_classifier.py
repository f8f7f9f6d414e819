"""The baseline: is there a spall, on which race, and how long, each question with a calibrated probability."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from threadpoolctl import threadpool_limits

from labels.classifier.alarm import fit_alarm
from labels.classifier.classes import CLASSES, called
from labels.classifier.learners import learner
from labels.classifier.rule import strengths
from labels.classifier.stage import Stage
from labels.features.modulation import COMPARED, LEADS
from labels.features.table import FEATURE_NAMES
from labels.schema import HEALTHY
from physics.arrays import Array
from physics.bearing import RACES

# Share of simulated healthy records that may be called faulty: that of the rule's threshold.
FALSE_ALARMS = 0.05
# Divisions into folds that give held-out probabilities for the alarm; with a single one it would depend on chance.
DIVISIONS = 3
FAMILY_NAMES = ("evidence", "spread", "others", "first", "strength", "depth")
IMPULSIVENESS = ("kurtosis", "flat_kurtosis", "band_kurtosis", "median_band_kurtosis")
INNER_LEADS = tuple(f"inner_lead_{name}" for name in LEADS)
# More of these never makes a spall less likely.
RISING = (*(f"{race}_{name}" for race in RACES for name in FAMILY_NAMES), *IMPULSIVENESS, *INNER_LEADS)
DIFFERENCES = tuple(f"race_{name}" for name in COMPARED)
SPALL_NAMES = (*RISING, *DIFFERENCES, "turns")
SIGNS = tuple(1 if name in RISING else -1 if name == "turns" else 0 for name in SPALL_NAMES)
RACE_NAMES = (
    *(f"{race}_{name}" for race in RACES for name in (*FAMILY_NAMES, "sidebands", "cage", "slip")),
    *DIFFERENCES,
)


class SpallClassifier(ClassifierMixin, BaseEstimator):
    """Three calibrated questions asked with one kind of learner ("forest", "logistic" or "boosting").

    Spall or none, from the two races' line families in the envelopes, from impulsiveness, and from how long was looked;
    outer or inner race, from the families alone; line or extended, from all features. What belongs to the machine as
    much as to a spall (lines of the shaft, lines of the vibration itself) answers neither of the first two.
    `alarm_` (an `Alarm`) is what at most FALSE_ALARMS of the healthy records pass by their probability, of bearings not
    learned from, and few by their lines alone.
    """

    def __init__(self, kind: str) -> None:
        self.kind = kind

    def fit(
        self,
        X: Array,
        y: NDArray[Any],
        groups: NDArray[Any] | None = None,
        records: NDArray[np.int64] | None = None,
        noisy: NDArray[np.bool_] | None = None,
        axes: NDArray[np.int64] | None = None,
    ) -> SpallClassifier:
        """Learn from rows (N, F) of the feature table and their CLASSES (N,); `groups` (N,) are virtual bearings.

        `records` (N,) are the records that the rows are of, each its own if None, and `axes` (N,) their axes, one for
        all if None; `noisy` (N,) marks rows of a record to which noise was added. ValueError if an answer to one of the
        questions comes from fewer than two bearings, or from noisy rows alone.
        """
        X, y = np.asarray(X, dtype=np.float64), np.asarray(y)
        groups = np.arange(len(y)) if groups is None else np.asarray(groups)
        records = np.arange(len(y)) if records is None else np.asarray(records)
        noisy = np.zeros(len(y), dtype=bool) if noisy is None else np.asarray(noisy)
        axes = np.zeros(len(y), dtype=np.int64) if axes is None else np.asarray(axes)
        self.classes_ = np.array(CLASSES)
        faulty = y != HEALTHY
        with threadpool_limits(1):  # trees this small are fitted faster alone than by threads that wait for each other
            spall = self._stage((HEALTHY, "spall"), SIGNS, DIVISIONS)
            self.spall_ = spall.fit(_spall_columns(X), faulty, groups, noisy)
            self.alarm_ = fit_alarm(
                self.spall_.held_out[~faulty],
                X[~faulty],
                records[~faulty],
                noisy[~faulty],
                axes[~faulty],
                FALSE_ALARMS,
            )
            self._fit_to_faults(X[faulty], y[faulty].astype(str), groups[faulty], noisy[faulty])
        return self

    def _fit_to_faults(self, X: Array, y: NDArray[np.str_], groups: NDArray[Any], noisy: NDArray[np.bool_]) -> None:
        """Learn the second and the third question from rows (N, F) with a spall, and their classes (N,)."""
        self.race_ = self._stage(RACES).fit(_race_columns(X), np.char.endswith(y, "inner"), groups, noisy)
        extended = np.char.startswith(y, "extended")
        # Recipes without extended spalls (or without line spalls) leave nothing to ask in the third question.
        asked = extended.any() and not extended.all()
        self.length_ = self._stage(("line", "extended")).fit(X, extended, groups, noisy) if asked else None
        self.always_extended_ = bool(extended.all())

    def predict_proba(self, X: Array) -> Array:
        """Probabilities (N, 5) of CLASSES for rows (N, F) of the feature table; they sum to 1 in each row."""
        X = np.asarray(X, dtype=np.float64)
        with threadpool_limits(1):  # as in `fit`
            spall, inner = self.spall_.probability(_spall_columns(X)), self.race_.probability(_race_columns(X))
            long = (
                np.full(len(X), float(self.always_extended_)) if self.length_ is None else self.length_.probability(X)
            )
        parts = (1.0 - long) * (1.0 - inner), (1.0 - long) * inner, long * (1.0 - inner), long * inner
        return np.column_stack([1.0 - spall, *(spall * part for part in parts)])

    def predict(self, X: Array) -> NDArray[np.str_]:
        """The class (N,) of rows (N, F) of the feature table: the likeliest spall where the probability of a spall, or
        the height of a race's lines, passes the alarm, else "healthy"."""
        probability = self.predict_proba(X)
        by_lines = self.alarm_.by_lines_alone(strengths(X))
        return called(probability, (1.0 - probability[:, 0] > self.alarm_.at(X)) | by_lines)

    def _stage(self, answers: tuple[str, str], signs: tuple[int, ...] | None = None, divisions: int = 1) -> Stage:
        return Stage(learner(self.kind, signs), answers, divisions)


def _race_columns(table: Array) -> Array:
    return np.asarray(table)[:, [FEATURE_NAMES.index(name) for name in RACE_NAMES]]


def _spall_columns(table: Array) -> Array:
    return np.asarray(table)[:, [FEATURE_NAMES.index(name) for name in SPALL_NAMES]]
