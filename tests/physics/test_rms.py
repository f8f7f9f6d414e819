"""Loudness and relative error, on numbers worked out by hand."""

import math

import numpy as np
import pytest

from physics.rms import relative_error, rms, stretches_apart


def test_the_root_mean_square_is_over_all_entries():
    assert rms(np.array([[3.0, 4.0], [0.0, 5.0]])) == pytest.approx(math.sqrt(12.5), rel=1e-15)


def test_the_error_is_measured_by_the_exact_signal_and_not_by_the_one_found():
    assert relative_error(np.array([[3.0, 0.0], [0.0, 8.0]]), np.array([[3.0, 0.0], [0.0, 4.0]])) == 4.0 / 5.0


@pytest.mark.parametrize(
    ("found", "exact", "error"), [(0.0, 0.0, 0.0), (1.0, 0.0, np.inf), (1.0, 2.0, 0.5), (0.0, 2.0, 1.0)]
)
def test_silence_agrees_with_silence_and_with_nothing_else(found, exact, error):
    assert relative_error(np.full((4, 2), found), np.full((4, 2), exact)) == error


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_finite_never_passes_for_exact(bad):
    assert not relative_error(np.array([bad, 1.0]), np.ones(2)) <= 1.0


def test_two_stretches_of_a_signal_are_as_far_apart_as_their_difference_is_large():
    signal = np.array([[9.0, 9.0], [1.0, 2.0], [3.0, 4.0], [1.0, 5.0], [7.0, 4.0]])
    assert stretches_apart(signal, 1, 3, 2) == pytest.approx(math.sqrt((0.0 + 9.0 + 16.0 + 0.0) / 4.0), rel=1e-15)
