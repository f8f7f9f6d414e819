"""Logistic regression whose coefficients may be held to one sign."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.base import BaseEstimator
from sklearn.exceptions import ConvergenceWarning

from labels.classifier.log_odds import probability_of
from labels.classifier.reliability import equal_priors
from physics.arrays import Array

MOST_STEPS = 2000
C = 0.05  # half the sum of the squared coefficients over this is the penalty, as in scikit-learn


class SignedLogistic(BaseEstimator):
    """Two classes of equal weight, a quadratic penalty, and coefficients of the given `signs`.

    A sign of 1 keeps a feature's coefficient at 0 or above, −1 at 0 or below, 0 leaves it free (so does None for all).
    """

    def __init__(self, signs: Sequence[int] | None = None) -> None:
        self.signs = signs

    def fit(self, X: Array, y: NDArray[Any]) -> SignedLogistic:
        """Learn from rows (N, F) and their two classes (N,); warns where the fit ended before it had converged."""
        from scipy.optimize import minimize

        table = np.column_stack([np.asarray(X, dtype=np.float64), np.ones(len(X))])
        self.classes_, place = np.unique(y, return_inverse=True)
        side = np.where(place == 1, 1.0, -1.0)
        weight = equal_priors(place == 1)

        def loss(coefficients: Array) -> tuple[float, Array]:
            margin = side * (table @ coefficients)
            slope = -side * weight * probability_of(-margin)
            shrunk = np.append(coefficients[:-1], 0.0)
            value = float(weight @ np.logaddexp(0.0, -margin)) + 0.5 / C * float(shrunk @ shrunk)
            return value, table.T @ slope + shrunk / C

        signs = [0] * (table.shape[1] - 1) if self.signs is None else list(self.signs)
        bounds = [(0.0 if sign > 0 else None, 0.0 if sign < 0 else None) for sign in (*signs, 0)]
        found = minimize(
            loss, np.zeros(table.shape[1]), jac=True, bounds=bounds, method="L-BFGS-B", options={"maxiter": MOST_STEPS}
        )
        if not found.success:
            warnings.warn(f"the fit did not converge: {found.message}", ConvergenceWarning, stacklevel=2)
        self.coef_, self.intercept_ = found.x[:-1], float(found.x[-1])
        return self

    def predict_proba(self, X: Array) -> Array:
        """Probabilities (N, 2) of the two classes for rows (N, F)."""
        second = probability_of(np.asarray(X) @ self.coef_ + self.intercept_)
        return np.column_stack([1.0 - second, second])
