"""The three learners, each a scikit-learn pipeline with a fixed seed and settings chosen on synthetic data alone."""

from __future__ import annotations

from typing import Any

SEED = 2014
LEARNERS = ("forest", "logistic", "boosting")


def learner(name: str, seed: int = SEED) -> Any:
    """A fresh classifier with `fit` and `predict_proba`; ValueError for an unknown name."""
    from sklearn.ensemble import ExtraTreesClassifier, HistGradientBoostingClassifier
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    if name == "forest":
        return make_pipeline(
            ExtraTreesClassifier(120, min_samples_leaf=3, max_features=0.4, class_weight="balanced", random_state=seed)
        )
    if name == "logistic":
        return make_pipeline(StandardScaler(), LogisticRegression(C=0.05, max_iter=3000, class_weight="balanced"))
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
                random_state=seed,
            )
        )
    raise ValueError(f'learner = "{name}"; allowed: {", ".join(LEARNERS)}')
