"""One vote a record."""

import numpy as np
import pytest

from datagen.benchmark.votes import averaged, joined


def test_rows_of_a_record_agree_on_the_geometric_mean_of_their_probabilities():
    probability = np.array([[0.9, 0.1], [0.2, 0.8], [0.5, 0.5]])
    found = joined(probability, np.array([7, 8, 7]), np.array([7, 8, 9]))
    # Odds of 9 and of 1 have a geometric mean of 3.
    assert found[:2] == pytest.approx(np.array([[0.75, 0.25], [0.2, 0.8]]))
    assert np.isnan(found[2]).all()


def test_other_values_are_averaged_as_they_are():
    found = averaged(np.array([9.0, 2.0, 1.0]), np.array([7, 8, 7]), np.array([8, 7, 9]))
    assert found == pytest.approx([2.0, 5.0, np.nan], nan_ok=True)
