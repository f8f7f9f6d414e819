"""Sums of steady tones, as shafts, gears and the mains make them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BLOCK = 256


def tones(frequency: Array, amplitude: Array, phase: Array, samples: int, rate: float) -> Array:
    """Sum over lines of amplitude cos(2π frequency t + phase), (T, 2).

    `frequency` (L,) Hz, `amplitude` (L,), `phase` (L, 2) rad, one a line and axis. Lines at or above half the `rate`
    (Hz) are left out, as by an anti-aliasing filter; those below 0 Hz lie at their absolute frequency.
    """
    blocks = -(-samples // BLOCK)
    total = np.zeros((blocks, BLOCK, 2))
    for line in np.flatnonzero((np.abs(frequency) < rate / 2.0) & (amplitude != 0.0)):
        turn = 2.0 * np.pi * frequency[line] / rate
        # cos(a + b) = cos a cos b - sin a sin b: a at the start of each block, b within it.
        within = turn * np.arange(BLOCK)
        for axis in (0, 1):
            start = turn * BLOCK * np.arange(blocks) + phase[line, axis]
            total[:, :, axis] += np.outer(amplitude[line] * np.cos(start), np.cos(within))
            total[:, :, axis] -= np.outer(amplitude[line] * np.sin(start), np.sin(within))
    return total.reshape(-1, 2)[:samples]


def draw_phases(generator: np.random.Generator, lines: int) -> Array:
    """Phases (lines, 2), one a line and axis, equally likely from 0 to 2π: `lines` × 2 numbers."""
    return 2.0 * np.pi * generator.random((lines, 2))
