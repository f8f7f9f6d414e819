"""Whether a signal is that of a sensor at all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FEWEST_LEVELS = 4


def is_dead(signal: NDArray[Any]) -> bool:
    """True if a signal (T,) has NaN or fewer than four different values: no sensor was connected."""
    return not np.isfinite(signal).all() or np.unique(signal).size < FEWEST_LEVELS
