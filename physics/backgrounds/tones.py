"""Sums of steady tones, as shafts, gears and the mains make them."""

from __future__ import annotations

import numpy as np

from physics._jit import njit_lean
from physics.arrays import Array

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
    total = np.zeros((2, blocks * BLOCK))
    _add_up(loud * np.cos(start), loud * np.sin(start), np.cos(within), np.sin(within), total)
    return np.ascontiguousarray(total[:, :samples].T)


@njit_lean
def _add_up(cosine: Array, sine: Array, within_cosine: Array, within_sine: Array, total: Array) -> None:
    """Add the lines that start the blocks as `cosine` and `sine` (L, 2, B) and go on `within` (L, K) to `total`
    (2, B · K)."""
    width = within_cosine.shape[1]
    for block in range(cosine.shape[2]):
        for axis in range(2):
            sums = total[axis, block * width : (block + 1) * width]
            for line in range(cosine.shape[0]):
                a, b = cosine[line, axis, block], sine[line, axis, block]
                c, s = within_cosine[line], within_sine[line]
                for k in range(width):
                    sums[k] += a * c[k] - b * s[k]


def draw_phases(generator: np.random.Generator, lines: int) -> Array:
    """Phases (lines, 2), one a line and axis, equally likely from 0 to 2π: `lines` × 2 numbers."""
    return 2.0 * np.pi * generator.random((lines, 2))
