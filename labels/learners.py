"""The three learners, each a scikit-learn pipeline with a fixed seed and settings chosen on synthetic data alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

SEED = 2014
LEARNERS = ("forest", "logistic", "boosting")


def learner(name: str, seed: int = SEED, signs: Sequence[int] | None = None) -> Any:
    """A fresh classifier with `fit` and `predict_proba`; ValueError for an unknown name.

    `signs` (F,) are 1 for features with which the probability may only rise, −1 only fall, 0 either.
    """
    from sklearn.ensemble import ExtraTreesClassifier, HistGradientBoostingClassifier
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from labels.signed_logistic import SignedLogistic

    if name == "forest":
        return make_pipeline(
            ExtraTreesClassifier(
                120,
                min_samples_leaf=3,
                max_features=0.4,
                class_weight="balanced",
                monotonic_cst=signs,
                random_state=seed,
            )
        )
    if name == "logistic":
        return make_pipeline(StandardScaler(), SignedLogistic(0.05, signs))
    if name == "boosting":
        return make_pipeline(
            HistGradientBoostingClassifier(
                max_iter=100,
                learning_rate=0.08,
                max_leaf_nodes=8,
                min_samples_leaf=15,
                l2_regularization=3.0,
                max_features=0.4,
                class_weight="balanced",
                monotonic_cst=signs,
                random_state=seed,
            )
        )
    raise ValueError(f'learner = "{name}"; allowed: {", ".join(LEARNERS)}')
