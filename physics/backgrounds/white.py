"""White noise: sensor and amplifier."""

from __future__ import annotations

import numpy as np

from physics.arrays import Array
from physics.checks import require_not_negative


def white_noise(generator: np.random.Generator, rms: float, samples: int) -> Array:
    """Gaussian white noise (T, 2) from 0 to half the sampling rate, of standard deviation `rms` (m/s²) on each axis.

    Draws `samples` × 2 standard normal numbers. InvalidParameter if `rms` is below 0.
    """
    require_not_negative("rms", rms, "m/s²", what="white rms")
    return rms * generator.standard_normal((samples, 2))
