"""Signals through recursive filters of order two, section after section.

Not SciPy's, as `scipy.signal` takes 0.3 s to load, and every process that makes records would have to.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from physics._jit import njit_lean
from physics.arrays import Array

# What a section weighs: three samples that go in, the newest first, and the two that came out before the newest.
Section = tuple[tuple[float, float, float], tuple[float, float]]


def filtered(signal: Array, sections: Iterable[Section]) -> Array:
    """The `signal` (T, C) after every section in turn, each at rest before it.

    A section ((b0, b1, b2), (a1, a2)) makes y[k] = b0 x[k] + b1 x[k−1] + b2 x[k−2] − a1 y[k−1] − a2 y[k−2].
    """
    passed = np.array(signal, dtype=np.float64)
    for forward, back in sections:
        _filter(passed, forward, back)
    return passed


@njit_lean
def _filter(signal: Array, forward: tuple[float, float, float], back: tuple[float, float]) -> None:
    """The `signal` (T, C) in place, in the transposed direct form, whose two memories are sums."""
    for channel in range(signal.shape[1]):
        first, second = 0.0, 0.0
        for k in range(signal.shape[0]):
            came = signal[k, channel]
            goes = forward[0] * came + first
            first = (forward[1] * came + second) - back[0] * goes
            second = forward[2] * came - back[1] * goes
            signal[k, channel] = goes
