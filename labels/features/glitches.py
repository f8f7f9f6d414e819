"""Glitches: a sample or three that a recorder wrote wrongly, far from all their neighbours. They are replaced.

An impact rings for longer than that. What comes oftener than once a turn belongs to the machine and is left alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from labels.filling import foretold
from physics.arrays import Array

# Samples of a glitch, or of glitches side by side.
MOST_TOGETHER = 3
# Samples to both sides from which they must stand out.
REACH = 12
# By how many times each exceeds all others there, measured from their median.
OVER_NEIGHBOURS = 5.0
# By how many standard deviations of the record, which noise reaches once in 10⁹ samples.
OVER_SPREAD = 6.0
SPREAD_QUANTILE, DEVIATIONS_THERE = 0.95, 1.96


def without_glitches(signal: Array, most: float) -> tuple[Array, int]:
    """The signal (T,) with what goes on from their neighbours in place of its glitches, and how many there were.

    The signal as it is and 0 where there are more than `most`, or fewer samples than a glitch is looked for among.
    """
    if signal.size <= 2 * REACH:
        return signal, 0
    wrong = _glitches(signal)
    count = int(np.count_nonzero(np.diff(wrong, prepend=False) & wrong))
    if not 0 < count <= most:
        return signal, 0
    return foretold(signal, np.flatnonzero(wrong)), count


def _glitches(signal: Array) -> NDArray[np.bool_]:
    """Which samples (T,) belong to a glitch."""
    size = np.abs(signal - median_filter(signal, 2 * REACH + 1, mode="mirror"))
    wrong = np.zeros(signal.size, dtype=bool)
    spread = np.quantile(size, SPREAD_QUANTILE) / DEVIATIONS_THERE
    if spread > 0.0:
        far = np.flatnonzero(size > OVER_SPREAD * spread)
        around = np.pad(size, REACH)[far[:, None] + np.arange(2 * REACH + 1)]
        others = np.partition(around, -MOST_TOGETHER - 1, axis=1)[:, -MOST_TOGETHER - 1]
        wrong[far] = size[far] > OVER_NEIGHBOURS * others
    return wrong
