"""How large a signal is, and how far one is from another, measured by that."""

from __future__ import annotations

import math

import numpy as np

from physics._jit import njit_lean
from physics.arrays import Array


def rms(values: Array) -> float:
    """Root mean square over all entries, in their unit."""
    # The same bits as of np.mean in a third of the time: most of these arrays are short.
    return math.sqrt(np.add.reduce(np.square(values), axis=None) / values.size)


def relative_error(found: Array, exact: Array) -> float:
    """RMS of the difference over that of `exact`, dimensionless; silence is 0 off from silence, all else infinitely."""
    difference, size = rms(found - exact), rms(exact)
    if difference == 0.0:
        return 0.0
    return difference / size if size != 0.0 else math.inf


@njit_lean
def stretches_apart(signal: Array, one: int, other: int, count: int) -> float:
    """RMS, over both columns, of what `count` samples of `signal` (T, 2) from the place `one` on differ by from those
    from the `other` on."""
    along, across = 0.0, 0.0
    for k in range(count):
        along += (signal[one + k, 0] - signal[other + k, 0]) ** 2
        across += (signal[one + k, 1] - signal[other + k, 1]) ** 2
    return math.sqrt(0.5 * (along + across) / count)
