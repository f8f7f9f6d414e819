"""Several two-class learners that answer together, with the mean of their log odds."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator, clone

from labels.classifier.log_odds import logit, probability_of
from physics.arrays import Array


class Blend(BaseEstimator):
    """The mean of the log odds of its `parts`, each of which learns alone.

    Trees capture what no straight line can, but stay constant beyond the data they have seen; a logistic regression
    goes on rising there.
    """

    def __init__(self, parts: Sequence[Any]) -> None:
        self.parts = parts

    def fit(self, X: Array, y: NDArray[Any]) -> Blend:
        """Learn from rows (N, F) and their two classes (N,)."""
        self.classes_ = np.unique(y)
        self.fitted_ = [clone(part).fit(X, y) for part in self.parts]
        return self

    def predict_proba(self, X: Array) -> Array:
        """Probabilities (N, 2) of the two classes for rows (N, F)."""
        level = np.mean([logit(part.predict_proba(X)[:, 1]) for part in self.fitted_], axis=0)
        second = probability_of(level)
        return np.column_stack([1.0 - second, second])
