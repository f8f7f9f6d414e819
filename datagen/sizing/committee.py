"""Boosted regressions that differ in their seeds, and their mean as trees."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.estimation.trees import Trees
from physics.arrays import Array, Index

FOLDS = 3


@dataclass(frozen=True)
class Committee:
    """`members` histogram gradient boosting regressors of the same `settings` (scikit-learn's), each with its own seed.

    More than one member only makes sense where the settings leave something to chance (`max_features` below 1).
    """

    members: int
    settings: Mapping[str, Any]

    def fit(self, rows: NDArray[Any], aim: Array, weight: Array | None = None) -> Trees:
        """The mean of all members fitted to `aim` (N,) at `rows` (N, F), as trees."""
        from sklearn.ensemble import HistGradientBoostingRegressor

        models = [HistGradientBoostingRegressor(**self.settings, random_state=seed) for seed in range(self.members)]
        return mean_trees([to_trees(model.fit(rows, aim, weight)) for model in models])

    def out_of_fold(
        self, rows: Array, aim: Array, used: NDArray[np.bool_], groups: NDArray[np.str_], weight: Array | None = None
    ) -> Array:
        """Predictions (N,) for the rows of each of the `groups` (N,) by a fit to the `used` (N,) rows of the other
        groups."""
        predicted, weight = np.zeros(aim.size), np.ones(aim.size) if weight is None else weight
        for fitted, others in folds(groups):
            fitted = fitted[used[fitted]]
            predicted[others] = self.fit(rows[fitted], aim[fitted], weight[fitted]).predict(rows[others])
        return predicted


def folds(groups: NDArray[np.str_]) -> Iterator[tuple[Index, Index]]:
    """FOLDS times the places of the rows to fit to, and of the others, in which all of some `groups` (N,) are."""
    from sklearn.model_selection import GroupKFold

    yield from GroupKFold(FOLDS).split(groups, groups=groups)


def mean_trees(members: list[Trees]) -> Trees:
    """Trees whose sum is the mean of the sums of all `members`."""
    sizes = np.array([member.feature.size for member in members])
    first = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int32)
    together = {
        name: np.concatenate(
            [getattr(member, name) + np.int32(start) for member, start in zip(members, first, strict=True)]
        )
        for name in ("left", "right", "root")
    }
    return Trees(
        feature=np.concatenate([member.feature for member in members]),
        threshold=np.concatenate([member.threshold for member in members]),
        left=together["left"],
        right=together["right"],
        value=np.concatenate([member.value / len(members) for member in members]).astype(np.float32),
        root=together["root"],
        base=float(np.mean([member.base for member in members])),
    )


def to_trees(model: Any) -> Trees:
    """The trees of a fitted histogram gradient boosting model of scikit-learn as plain arrays."""
    parts, roots, count = [], [], 0
    for stage in model._predictors:
        nodes = stage[0].nodes
        roots.append(count)
        leaf = nodes["is_leaf"].astype(bool)
        parts.append(
            (
                np.where(leaf, -1, nodes["feature_idx"]).astype(np.int16),
                nodes["num_threshold"].astype(np.float32),
                (nodes["left"] + count).astype(np.int32),
                (nodes["right"] + count).astype(np.int32),
                np.where(leaf, nodes["value"], 0.0).astype(np.float32),
            )
        )
        count += nodes.size
    feature, threshold, left, right, value = (np.concatenate(column) for column in zip(*parts, strict=True))
    base = float(np.ravel(model._baseline_prediction)[0])
    return Trees(
        feature=feature,
        threshold=threshold,
        left=left,
        right=right,
        value=value,
        root=np.array(roots, dtype=np.int32),
        base=base,
    )
