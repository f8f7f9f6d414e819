"""The learning curve: what more virtual bearings would bring."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.answers import estimator_name
from datagen.benchmark.options import Learning
from datagen.benchmark.training import Model, TrainingSet, copy_of, train
from datagen.benchmark.verdicts import vote
from datagen.counts import counted
from datagen.errors import BadInput
from datagen.progress import SILENT, Listener
from labels.classifier.scores import balanced_accuracy, bootstrap
from labels.interval import Interval
from labels.schema import HEALTHY

SHARES = (0.125, 0.25, 0.5, 1.0)
HELD_OUT = 0.25
# Virtual bearings that the first point of a curve is learned from, or all where there are fewer.
FEWEST_AT_A_POINT = 10
SEED = 31


def learning_curve(
    training: TrainingSet, learning: Learning, estimator: Any | None = None, listener: Listener = SILENT
) -> dict[str, list[dict[str, Any]]]:
    """How well the location of spalls is told after learning from growing shares of the bearings, by model.

    A quarter of the bearings is held out. Each point gives the number of `bearings` learned from, and the `value` of
    the balanced accuracy over the held-out records, without added noise, with the ends `low` and `high` of its interval
    over bearings. Shares that cannot be learned from are left out, and the `listener` is told why. The models are the
    learners that `learning` names, or copies of the user's `estimator`, which must not be fitted yet.
    """
    generator = np.random.default_rng(SEED)
    bearings = generator.permutation(np.unique(training.bearings))
    cut = max(1, int(HELD_OUT * bearings.size))
    others = bearings[cut:]
    held_out = training.subset(np.isin(training.bearings, bearings[:cut]) & ~training.rows.noisy)
    counts = {min(others.size, max(FEWEST_AT_A_POINT, round(share * others.size))) for share in SHARES}
    curve: dict[str, list[dict[str, Any]]] = {}
    for count in sorted(counts):
        listener.step(f"learning curve: {count} of {others.size} bearings")
        part = training.subset(np.isin(training.bearings, others[:count]))
        fresh = None if estimator is None else copy_of(estimator, learning.estimator or estimator_name(estimator))
        try:
            models = train(part, learning, fresh)
        except BadInput as problem:
            listener.say(f"learning curve: none from {counted(count, 'virtual bearing')}: {problem.problem}")
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
