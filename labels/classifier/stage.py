"""One question with two answers: a learner whose probabilities are calibrated on bearings it has not seen."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.classifier.learners import SEED
from labels.classifier.log_odds import logit, probability_of
from physics.arrays import Array

FOLDS = 5


class Stage:
    """A two-class learner with Platt's calibration on rows as they are, without noise added; `answers` name its answers
    False and True in messages.

    `held_out` (N,) are its calibrated held-out probabilities, from the mean log odds of so many `divisions` into folds.
    """

    def __init__(self, estimator: Any, answers: tuple[str, str], divisions: int) -> None:
        self.estimator = estimator
        self.answers = answers
        self.divisions = divisions

    def fit(self, table: Array, answer: NDArray[np.bool_], groups: NDArray[Any], noisy: NDArray[np.bool_]) -> Stage:
        """Learn the probability that `answer` (N,) is True from rows (N, F); no group of `groups` (N,) is both learned
        from and held out.

        Rows marked `noisy` (N,) are learned from but not calibrated on. ValueError if an answer comes from fewer than
        two groups, or from noisy rows alone.
        """
        from sklearn.base import clone
        from sklearn.linear_model import LogisticRegression

        given = {name: np.unique(groups[answer == side]).size for side, name in enumerate(self.answers)}
        rarest = min(given, key=lambda name: given[name])
        if given[rarest] < 2:
            raise ValueError(f'"{rarest}" is on too few virtual bearings, {given[rarest]}; allowed: 2 or more')
        folds = min(FOLDS, given[rarest])
        plain = ~noisy
        if np.unique(answer[plain]).size < 2:
            missing = self.answers[int(not answer[plain].any())]
            raise ValueError(f'"{missing}" is on no record without added noise; allowed: 1 or more')
        level = [logit(self._held_out(table, answer, groups, folds, SEED + k)) for k in range(self.divisions)]
        raw = probability_of(np.mean(level, axis=0))
        of_plain, share = answer[plain], answer[plain].mean()
        weight = np.where(of_plain, 1.0 / share, 1.0 / (1.0 - share))
        self.calibration = LogisticRegression(C=10.0).fit(logit(raw[plain])[:, None], of_plain, sample_weight=weight)
        self.held_out = self._calibrated(raw)
        self.estimator = clone(self.estimator).fit(table, answer)
        return self

    def probability(self, table: Array) -> Array:
        """Calibrated probability (N,) that the answer to rows (N, F) is True, if both answers are equally likely
        beforehand."""
        return self._calibrated(self.estimator.predict_proba(table)[:, 1])

    def _held_out(self, table: Array, answer: NDArray[np.bool_], groups: NDArray[Any], folds: int, seed: int) -> Array:
        from sklearn.base import clone
        from sklearn.model_selection import StratifiedGroupKFold

        raw = np.full(len(answer), answer.mean())
        split = StratifiedGroupKFold(folds, shuffle=True, random_state=seed)
        for train, test in split.split(table, answer, groups):
            if np.unique(answer[train]).size == 2:
                raw[test] = clone(self.estimator).fit(table[train], answer[train]).predict_proba(table[test])[:, 1]
        return raw

    def _calibrated(self, raw: Array) -> Array:
        return np.asarray(self.calibration.predict_proba(logit(raw)[:, None])[:, 1])
