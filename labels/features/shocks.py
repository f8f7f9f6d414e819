"""Shocks: blows from outside that ring far above what the machine does in every turn. They are cut down to that level.

A single one of 200 times the RMS fills every band, and the spectrum of the envelope would show nothing else.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation

from labels.features.whole_turns import FEWEST_TURNS
from physics.arrays import Array

# How many times larger a shock is than the usual largest sample of a turn.
OVER_USUAL = 8.0


def without_shocks(signal: Array, turns: float) -> tuple[Array, int]:
    """The signal (T,) with its shocks cut at the median of the `turns`' largest samples, and how many there were.

    Sizes are counted from the signal's median; a turn with a shock is cut together with the one before and after, and
    what rings on from turn to turn is one. The signal as it is and 0 where there is none, or in fewer than
    FEWEST_TURNS.
    """
    blocks = min(int(turns), signal.size)
    if blocks < FEWEST_TURNS:
        return signal, 0
    starts = np.arange(blocks) * signal.size // blocks
    middle = float(np.median(signal))
    largest = np.maximum.reduceat(np.abs(signal - middle), starts)
    usual = float(np.median(largest))
    shocked = largest > OVER_USUAL * usual
    if usual == 0.0 or not shocked.any():
        return signal, 0
    cut = np.repeat(binary_dilation(shocked), np.diff(starts, append=signal.size))
    calm = np.where(cut, np.clip(signal, middle - usual, middle + usual), signal)
    return calm, int(np.count_nonzero(np.diff(shocked, prepend=False) & shocked))
