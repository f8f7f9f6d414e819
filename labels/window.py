"""The window under which spectra are taken."""

import numpy as np

from physics.arrays import Array


def periodic_hann(size: int) -> Array:
    """Hann window (`size`,) of mean 1, one period of 1 − cos: a line on a component keeps its height."""
    return np.asarray(1.0 - np.cos(2.0 * np.pi * np.arange(size) / size))
