"""The three learners, each made of scikit-learn's with a fixed seed; docs/classifier_choices.md says why these."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

SEED = 2014
LEARNERS = ("forest", "logistic", "boosting")


def learner(name: str, signs: Sequence[int] | None = None) -> Any:
    """A fresh classifier with `fit` and `predict_proba`; ValueError for an unknown name.

    "forest" and "boosting" are half a logistic regression each (`Blend`). `signs` (F,) are 1 for features with
    which the probability may only rise, −1 only fall, 0 either; the trees of "boosting" see only features of 1 or −1.
    """
    from sklearn.ensemble import ExtraTreesClassifier, HistGradientBoostingClassifier
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import StandardScaler

    from labels.classifier.blend import Blend
    from labels.classifier.signed_logistic import SignedLogistic

    logistic = make_pipeline(StandardScaler(), SignedLogistic(signs))
    if name == "logistic":
        return logistic
    if name == "forest":
        trees = ExtraTreesClassifier(
            120, min_samples_leaf=3, max_features=0.4, class_weight="balanced", monotonic_cst=signs, random_state=SEED
        )
        return Blend((trees, logistic))
    if name == "boosting":
        directed = None if signs is None else [place for place, sign in enumerate(signs) if sign]
        steps = HistGradientBoostingClassifier(
            max_iter=200,
            learning_rate=0.08,
            max_leaf_nodes=3,
            min_samples_leaf=15,
            l2_regularization=3.0,
            max_features=0.4,
            early_stopping=False,  # "auto" splits rows at random from 10 000 on, those of one bearing to both sides
            class_weight=None,  # calibration weighs the classes; to bin weighted rows takes most of a fit
            monotonic_cst=None if signs is None else [sign for sign in signs if sign],
            random_state=SEED,
        )
        return Blend((steps if directed is None else _seeing(directed, steps), logistic))
    raise ValueError(f'learner = "{name}"; allowed: {", ".join(LEARNERS)}')


def _seeing(columns: list[int], estimator: Any) -> Any:
    """The estimator, given only these `columns` of a row."""
    from sklearn.compose import ColumnTransformer
    from sklearn.pipeline import make_pipeline

    return make_pipeline(ColumnTransformer([("directed", "passthrough", columns)]), estimator)
