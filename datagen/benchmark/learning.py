"""The learning curve: what more virtual bearings would bring."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.training import Model, TrainingSet, copy_of, train_models, train_user_estimator
from datagen.benchmark.verdicts import vote
from datagen.errors import BadInput
from datagen.progress import Say, ignore
from labels.classifier.scores import balanced_accuracy, bootstrap
from labels.interval import Interval
from labels.schema import HEALTHY

SHARES = (0.125, 0.25, 0.5, 1.0)
HELD_OUT = 0.25
# Virtual bearings that the first point of a curve is learned from, or all where there are fewer.
FEWEST_AT_A_POINT = 10
SEED = 31


def learning_curve(
    training: TrainingSet,
    learner: str,
    estimator: Any | None = None,
    takes_windows: bool = False,
    given: str = "",
    step: Say = ignore,
) -> dict[str, list[dict[str, Any]]]:
    """By model: balanced accuracy of the location of records of a quarter of the bearings, without noise added, learned
    from shares of the others, with its interval over bearings. Shares that cannot be learned from are left out.

    The models are our `learner`, or with the user's `estimator` copies of that, which must not be fitted yet;
    `given` is its name in messages. `step` is called with how far it has got.
    """
    generator = np.random.default_rng(SEED)
    bearings = generator.permutation(np.unique(training.bearings))
    cut = max(1, int(HELD_OUT * bearings.size))
    others = bearings[cut:]
    held_out = training.subset(np.isin(training.bearings, bearings[:cut]) & ~training.rows.noisy)
    counts = {min(others.size, max(FEWEST_AT_A_POINT, round(share * others.size))) for share in SHARES}
    curve: dict[str, list[dict[str, Any]]] = {}
    for count in sorted(counts):
        step(f"learning curve: {count} of {others.size} bearings")
        part = training.subset(np.isin(training.bearings, others[:count]))
        fresh = None if estimator is None else copy_of(estimator, given)
        try:
            models = (
                train_models(part, learner)
                if fresh is None
                else [train_user_estimator(part, fresh, takes_windows, given)]
            )
        except BadInput:
            continue
        for model in models:
            score = _score(model, held_out)
            point = {"bearings": count, "value": score.value, "low": score.low, "high": score.high}
            curve.setdefault(model.name, []).append(point)
    return curve


def _score(model: Model, held_out: TrainingSet) -> Interval:
    records, first = np.unique(held_out.rows.record, return_index=True)
    said = vote(model, held_out.rows, records).called
    truth = _locations(held_out.classes[first])
    return bootstrap(balanced_accuracy, truth, _locations(said), groups=held_out.bearings[first], draws=300)


def _locations(classes: NDArray[np.str_]) -> NDArray[np.str_]:
    return np.array(["none" if name == HEALTHY else name.split()[1] for name in classes.tolist()], dtype=np.str_)
