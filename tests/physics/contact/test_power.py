"""Powers of the kernels against the C library in extended precision."""

import numpy as np
import pytest

from physics._jit import njit
from physics.contact.power import power


@njit
def powers(bases, exponent, found):
    for k in range(bases.size):
        found[k] = power(bases[k], exponent)


def found_for(bases, exponent):
    found = np.empty(bases.size)
    powers(bases, exponent, found)
    return found


@pytest.mark.parametrize("exponent", [1.0 / 9.0, 0.08, 0.5, 1.0])
def test_powers_are_right_to_the_last_places(exponent):
    # From the compression of an atom's size to a metre, and beside every power of two, where the mantissa jumps.
    bases = np.concatenate([np.geomspace(1e-12, 1.0, 20001), 2.0 ** np.arange(-40, 3)])
    bases = np.concatenate([bases, np.nextafter(bases, 0.0), bases * np.sqrt(2.0)])
    exact = bases.astype(np.longdouble) ** np.longdouble(exponent)
    assert np.abs(found_for(bases, exponent) / exact - 1.0).max() < 1e-15


def test_whole_powers_of_two_are_exact():
    assert found_for(np.array([4.0, 1.0, 0.25]), 0.5).tolist() == [2.0, 1.0, 0.5]
    assert found_for(np.array([1e-9, 0.3]), 0.0).tolist() == [1.0, 1.0]


def test_nothing_to_a_power_is_next_to_nothing_and_no_exception():
    assert np.all(found_for(np.array([0.0, 1e-310]), 1.0 / 9.0) < 1e-33)
