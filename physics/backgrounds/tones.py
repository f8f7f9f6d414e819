"""Sums of steady tones, as shafts, gears and the mains make them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_lean

Array = NDArray[np.float64]

BLOCK = 256


def tones(frequency: Array, amplitude: Array, phase: Array, samples: int, rate: float) -> Array:
    """Sum over lines of amplitude cos(2π frequency t + phase), (T, 2).

    `frequency` (L,) Hz, `amplitude` (L,), `phase` (L, 2) rad, one a line and axis. Lines at or above half the `rate`
    (Hz) are left out, as by an anti-aliasing filter; those below 0 Hz lie at their absolute frequency.
    """
    heard = np.flatnonzero((np.abs(frequency) < rate / 2.0) & (amplitude != 0.0))
    blocks = -(-samples // BLOCK)
    turn = 2.0 * np.pi * frequency[heard] / rate
    # cos(a + b) = cos a cos b - sin a sin b: a at the start of each block, b within it.
    within = turn[:, None] * np.arange(BLOCK)
    start = turn[:, None, None] * (BLOCK * np.arange(blocks)) + phase[heard][:, :, None]
    loud = amplitude[heard][:, None, None]
    total = np.zeros((samples, 2))
    _add_up(loud * np.cos(start), loud * np.sin(start), np.cos(within), np.sin(within), total)
    return total


@njit_lean
def _add_up(cosine: Array, sine: Array, within_cosine: Array, within_sine: Array, total: Array) -> None:
    """Add the lines that start the blocks as `cosine` and `sine` (L, 2, B) and go on `within` (L, K) to `total`."""
    samples, width = total.shape[0], within_cosine.shape[1]
    for block in range(cosine.shape[2]):
        first = block * width
        for line in range(cosine.shape[0]):
            cx, sx = cosine[line, 0, block], sine[line, 0, block]
            cy, sy = cosine[line, 1, block], sine[line, 1, block]
            for k in range(min(width, samples - first)):
                c, s = within_cosine[line, k], within_sine[line, k]
                total[first + k, 0] += cx * c - sx * s
                total[first + k, 1] += cy * c - sy * s


def draw_phases(generator: np.random.Generator, lines: int) -> Array:
    """Phases (lines, 2), one a line and axis, equally likely from 0 to 2π: `lines` × 2 numbers."""
    return 2.0 * np.pi * generator.random((lines, 2))
