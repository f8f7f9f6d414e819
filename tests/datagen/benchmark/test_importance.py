"""What shuffling a feature costs a model that reads one feature only."""

import math

import numpy as np
import pytest

from datagen.benchmark.importance import importances
from datagen.benchmark.rows import Rows
from datagen.benchmark.training import Model, TrainingSet
from labels.features.table import FEATURE_NAMES


def test_only_the_feature_that_a_model_reads_matters_and_by_as_much_as_chance_costs():
    size, column = 400, FEATURE_NAMES.index("kurtosis")
    table = np.random.default_rng(0).standard_normal((size, len(FEATURE_NAMES)))
    classes = np.where(table[:, column] > 0.0, "line outer", "healthy")

    def says(rows):
        faulty = np.where(rows[:, column] > 0.0, 0.9, 0.1)
        return np.column_stack([1.0 - faulty, faulty, *np.zeros((3, len(rows)))])

    rows = Rows(table, np.arange(size), np.zeros(size, dtype=np.int64), np.zeros(size, dtype=bool))
    training = TrainingSet(rows, classes, classes)
    found = importances(Model("reads one", says, 0.5), training)
    assert next(iter(found)) == "kurtosis"
    # Shuffled, every second answer is wrong: its loss rises from −ln 0.9 to −ln 0.1.
    assert found.pop("kurtosis") == pytest.approx(0.5 * math.log(9.0), rel=0.15)
    assert set(found.values()) == {0.0}
