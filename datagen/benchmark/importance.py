"""How much each feature matters to a model: what shuffling it costs."""

from __future__ import annotations

import numpy as np

from datagen.benchmark.training import Model, TrainingSet
from labels.classifier.classes import CLASSES
from labels.features.table import FEATURE_NAMES

MOST_ROWS = 600
SEED = 7
SMALLEST = 1e-4


def importances(model: Model, training: TrainingSet) -> dict[str, float]:
    """Rise of the mean log loss (nats) of the true class when one feature is shuffled, by name, largest first.

    Measured on at most 600 rows of the training set: it says what the model uses, not how well it does.
    """
    generator = np.random.default_rng(SEED)
    rows = generator.permutation(len(training.rows))[:MOST_ROWS]
    table, classes = training.rows.table[rows], training.classes[rows]
    before = _loss(model, table, classes)
    rise = {}
    for column, name in enumerate(FEATURE_NAMES):
        shuffled = table.copy()
        shuffled[:, column] = shuffled[generator.permutation(len(rows)), column]
        rise[name] = _loss(model, shuffled, classes) - before
    return dict(sorted(rise.items(), key=lambda item: -item[1]))


def _loss(model: Model, table: np.ndarray, classes: np.ndarray) -> float:
    probability = model.probability(table)
    of_true_class = probability[np.arange(len(classes)), [CLASSES.index(name) for name in classes]]
    return float(-np.log(np.maximum(of_true_class, SMALLEST)).mean())
