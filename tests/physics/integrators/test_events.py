"""Where a contact change is looked for first."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from physics.integrators import events

hermite_root = events.hermite_root.py_func


@given(st.floats(0.05, 0.95), st.floats(-0.9, 3.0), st.floats(-0.9, 3.0), st.floats(1e-9, 1e3))
def test_the_root_of_a_falling_cubic_is_found_from_values_and_slopes_at_both_ends(place, early, late, size):
    # Slope −(1 + early)(1 − x) − (1 + late) x is below zero from 0 to 1, so the parabola falls through zero once.
    slope = np.polynomial.Polynomial([-(1.0 + early), early - late]) * size
    fall = slope.integ()
    fall -= fall(place)
    if fall(0.0) > 0.0 > fall(1.0):
        root = hermite_root(0.0, 1.0, fall(0.0), fall(1.0), slope(0.0), slope(1.0))
        assert root == pytest.approx(place, abs=0.02)  # three steps of Newton's method from the chord


def test_a_cubic_that_hardly_bends_is_met_as_exactly_as_numbers_go():
    cubic = np.polynomial.Polynomial([0.3, -1.0, 0.05, -0.1])
    slope = cubic.deriv()
    found = hermite_root(0.0, 1.0, cubic(0.0), cubic(1.0), slope(0.0), slope(1.0))
    assert cubic(found) == pytest.approx(0.0, abs=1e-12)


def test_without_slopes_the_root_is_that_of_the_chord():
    assert hermite_root(0.2, 0.6, 3.0, -1.0, 0.0, 0.0) == pytest.approx(0.5, rel=1e-12)
