"""How large a signal is, and how far one is from another, measured by that."""

from __future__ import annotations

import math

import numpy as np

from physics.arrays import Array


def rms(values: Array) -> float:
    """Root mean square over all entries, in their unit."""
    return float(np.sqrt(np.mean(np.square(values))))


def relative_error(found: Array, exact: Array) -> float:
    """RMS of the difference over that of `exact`, dimensionless; silence is 0 off from silence, all else infinitely."""
    difference, size = rms(found - exact), rms(exact)
    if difference == 0.0:
        return 0.0
    return difference / size if size != 0.0 else math.inf
