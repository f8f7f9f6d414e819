"""Cosine and sine of the kernels against the C library in extended precision."""

import numpy as np
import pytest

from physics._jit import njit
from physics.contact.turning import cosine_sine


@njit
def both(angles, found):
    for k in range(angles.size):
        found[k, 0], found[k, 1] = cosine_sine(angles[k])


@pytest.mark.parametrize("size", [1.0, 1e3, 1e6])
def test_cosine_and_sine_are_right_to_the_last_places(size):
    angles = np.concatenate([np.linspace(-size, size, 20001), size * np.pi * np.arange(-8, 9) / 8.0])
    found = np.empty((angles.size, 2))
    both(angles, found)
    exact = np.column_stack([np.cos(angles.astype(np.longdouble)), np.sin(angles.astype(np.longdouble))])
    assert np.abs(found - exact).max() < 4.5e-16  # two units in the last place


def test_the_square_sum_is_one():
    angles = np.random.default_rng(3).uniform(-1e4, 1e4, 10000)
    found = np.empty((angles.size, 2))
    both(angles, found)
    assert np.abs((found**2).sum(axis=1) - 1.0).max() < 5e-16
