"""The learning curve: what more virtual bearings would bring."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.training import TrainingSet, train_models
from labels.classifier import HEALTHY, decide
from labels.scores import balanced_accuracy, bootstrap

SHARES = (0.125, 0.25, 0.5, 1.0)
HELD_OUT = 0.25
SEED = 31


def learning_curve(training: TrainingSet, learner: str) -> dict[str, list[dict[str, Any]]]:
    """By model: balanced accuracy of the location of single rows on a quarter of the bearings, learned from shares of
    the others, with its interval."""
    generator = np.random.default_rng(SEED)
    bearings = generator.permutation(np.unique(training.bearings))
    cut = max(1, int(HELD_OUT * bearings.size))
    held_out, others = np.isin(training.bearings, bearings[:cut]), bearings[cut:]
    curve: dict[str, list[dict[str, Any]]] = {}
    for share in SHARES:
        chosen = np.isin(training.bearings, others[: max(10, round(share * others.size))])
        part = _part(training, chosen)
        for model in train_models(part, learner):
            said = decide(model.probability(training.table[held_out]), model.alarms(training.table[held_out]))
            truth, found = _locations(training.classes[held_out]), _locations(said)
            score = bootstrap(balanced_accuracy, truth, found, draws=300)
            point = {"bearings": int(np.unique(part.bearings).size), "value": score.value}
            curve.setdefault(model.name, []).append(point | {"low": score.low, "high": score.high})
    return curve


def _part(training: TrainingSet, chosen: NDArray[np.bool_]) -> TrainingSet:
    return TrainingSet(
        training.table[chosen],
        training.classes[chosen],
        training.bearings[chosen],
        training.records[chosen],
        training.noisy[chosen],
    )


def _locations(classes: np.ndarray) -> np.ndarray:
    return np.array(["none" if name == HEALTHY else name.split()[1] for name in classes.tolist()])
