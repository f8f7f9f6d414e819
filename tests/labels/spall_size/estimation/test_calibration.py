"""What a guess makes of what its trees say, and what a calibration keeps in its file."""

import math

import numpy as np
import pytest

from datagen.sizing.estimators import default_estimator
from labels.spall_size.columns.table import PAIR_COLUMNS
from labels.spall_size.estimation.calibration import (
    FITTED_ON,
    SMALLEST_SPREAD,
    Calibration,
    Guess,
    Judgement,
    MisfitCalibration,
)
from labels.spall_size.estimation.trees import Trees


@pytest.mark.parametrize(("spread", "expected"), [(0.2, 0.2 + SMALLEST_SPREAD), (-0.5, SMALLEST_SPREAD)])
def test_an_interval_is_never_narrower_than_the_smallest_spread(saying, spread, expected):
    factor, reach = Guess(saying(0.1), saying(spread), 2.0).correction(np.zeros(3))
    assert (factor, reach) == (pytest.approx(math.exp(0.1)), pytest.approx(math.exp(2.0 * expected)))


@pytest.fixture
def learned():
    """A calibration no two of whose numbers are the same."""
    generator = np.random.default_rng(4)

    def trees():
        nodes = int(generator.integers(300, 400))
        links = generator.integers(0, nodes, (3, nodes)).astype(np.int32)
        numbers = generator.standard_normal((2, nodes)).astype(np.float32)
        feature = generator.integers(-1, len(PAIR_COLUMNS), nodes).astype(np.int16)
        return Trees(feature, numbers[0], links[0], links[1], numbers[1], links[2][:3], float(generator.random()))

    def guess():
        return Guess(trees(), trees(), float(generator.random()))

    def judgement():
        return Judgement(trees(), guess(), guess(), trees(), float(generator.random()))

    return Calibration(trees(), judgement(), judgement(), "drawn at random")


def test_every_array_comes_back(learned):
    arrays = learned.to_arrays()
    again = Calibration.from_arrays(dict(arrays)).to_arrays()
    assert again.keys() == arrays.keys()
    for name, array in arrays.items():
        assert again[name].dtype == array.dtype, name
        assert np.array_equal(again[name], array), name
    values = [array.tobytes() for name, array in arrays.items() if not name.endswith(".columns")]
    assert len(set(values)) == len(values)  # so that no two could be mistaken for each other
    assert Calibration.from_arrays(arrays).origin == "drawn at random"


@pytest.mark.parametrize("model", FITTED_ON)
def test_a_model_fitted_on_other_columns_is_refused(learned, model):
    arrays, key = learned.to_arrays(), f"{model}.columns"
    names = arrays[key].copy()
    names[[3, 4]] = names[[4, 3]]
    with pytest.raises(MisfitCalibration, match=f'column 3 of {model} was "score" when it was fitted, and is "passes"'):
        Calibration.from_arrays(arrays | {key: names})
    with pytest.raises(
        MisfitCalibration, match=f"{model} was fitted on {names.size - 1} columns, and there are {names.size} "
    ):
        Calibration.from_arrays(arrays | {key: names[:-1]})
    del arrays[key]
    with pytest.raises(MisfitCalibration, match=f"does not say on which columns {model} was fitted"):
        Calibration.from_arrays(arrays)


def test_the_calibration_that_comes_with_the_package_fits_and_says_where_it_comes_from():
    shipped = default_estimator().calibration
    assert all(word in shipped.origin for word in ("size_ladder", "size_training", "size_imperfect", "65536 Hz"))
    for name, trees in (("pair_score", shipped.pair_score), ("blind.rank", shipped.blind.rank),
                        ("with_load.rank", shipped.with_load.rank), ("blind.doubt", shipped.blind.doubt),
                        ("with_load.lag", shipped.with_load.lag.centre)):  # fmt: skip
        assert trees.feature.max() == len(FITTED_ON[name]) - 1, name  # every one of them looks at its last column


@pytest.mark.parametrize("model", FITTED_ON)
def test_a_model_fitted_on_another_last_column_is_refused(learned, model):
    arrays, key = learned.to_arrays(), f"{model}.columns"
    renamed = np.array([*arrays[key][:-1], "another"])
    with pytest.raises(MisfitCalibration, match=f'column {renamed.size - 1} of {model} was "another" when it was'):
        Calibration.from_arrays(arrays | {key: renamed})


@pytest.mark.parametrize("key", ["origin", "pair_score.base", "blind.most", "with_load.arc.reach"])
def test_a_calibration_of_which_anything_is_missing_is_not_taken(learned, key):
    arrays = learned.to_arrays()
    del arrays[key]
    with pytest.raises(KeyError, match=key):
        Calibration.from_arrays(arrays)


def test_trees_that_are_sure_leave_an_interval_of_a_hundredth(saying):
    assert Guess(saying(0.0), saying(0.0), 1.0).correction(np.zeros(3)) == (1.0, pytest.approx(math.exp(0.01)))
