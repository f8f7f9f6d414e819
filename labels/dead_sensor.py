"""Whether a signal is that of a sensor at all."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FEWEST_LEVELS = 4
# So many samples of a signal nearly always have as many different values; looking at all of them takes long.
FIRST_LOOK = 64


def is_dead(signal: NDArray[Any]) -> bool:
    """True if a signal (T,) has a sample that is not finite, or fewer than four values: no sensor was connected."""
    if not np.isfinite(signal).all():
        return True
    return np.unique(signal[:FIRST_LOOK]).size < FEWEST_LEVELS and np.unique(signal).size < FEWEST_LEVELS


def live_axis(signals: NDArray[Any]) -> NDArray[Any] | None:
    """The last axis (T,) of `signals` (T,) or (T, axes: y last) whose sensor is not dead; None if there is none."""
    columns = signals[:, None] if signals.ndim == 1 else signals
    return next((signal for signal in columns.T[::-1] if not is_dead(signal)), None)
