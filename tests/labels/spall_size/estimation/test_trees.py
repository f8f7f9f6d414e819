import numpy as np
import pytest
from sklearn.ensemble import HistGradientBoostingRegressor

from datagen.sizing.committee import mean_trees, to_trees
from labels.spall_size.estimation.trees import Trees


def rows_and_aim():
    rows = np.random.default_rng(1).standard_normal((400, 5)).astype(np.float32)
    return rows, rows[:, 0] ** 2 + np.where(rows[:, 1] > 0.3, 1.0, -1.0)


def test_plain_trees_say_what_the_library_says():
    rows, aim = rows_and_aim()
    model = HistGradientBoostingRegressor(max_iter=30, random_state=0).fit(rows, aim)
    assert to_trees(model).predict(rows) == pytest.approx(model.predict(rows), abs=1e-5)  # leaves are stored as float32


def test_the_mean_of_several_trees_is_the_mean_of_what_each_says():
    rows, aim = rows_and_aim()
    models = [
        HistGradientBoostingRegressor(max_iter=10 + seed, max_features=0.4, random_state=seed).fit(rows, aim + seed)
        for seed in range(3)
    ]
    mean = np.mean([model.predict(rows) for model in models], axis=0)
    assert mean_trees([to_trees(model) for model in models]).predict(rows) == pytest.approx(mean, abs=1e-5)  # float32


def test_trees_come_back_from_their_arrays():
    rows, aim = rows_and_aim()
    trees = to_trees(HistGradientBoostingRegressor(max_iter=3, random_state=0).fit(rows, aim))
    again = Trees.from_arrays(trees.to_arrays("any"), "any")
    assert np.array_equal(again.predict(rows), trees.predict(rows))
    with pytest.raises(KeyError, match="other"):
        Trees.from_arrays(trees.to_arrays("any"), "other")


def test_rows_that_lack_a_column_are_refused_with_both_numbers():
    rows, _ = rows_and_aim()
    trees = to_trees(HistGradientBoostingRegressor(max_iter=3, random_state=0).fit(rows, rows[:, 4]))
    with pytest.raises(ValueError, match="rows have 4 columns; the trees need 5"):
        trees.predict(rows[:, :4])
