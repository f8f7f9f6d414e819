"""The bands that signals are searched in: the bandwidth that is usable at a rate, its halves, quarters and eighths."""

from __future__ import annotations

import numpy as np

from physics.arrays import Array

# Highest frequency that is looked at, Hz: records of any higher rate are limited to it.
COMMON_BANDWIDTH = 20_000.0
SHARE_OF_NYQUIST = 0.95
LEVELS = 4


def usable_bandwidth(rate: float, bandwidth: float = COMMON_BANDWIDTH) -> float:
    """Highest frequency (Hz) to look at in a signal at `rate` (Hz): the `bandwidth`, or 0.95 of half the rate."""
    return min(bandwidth, SHARE_OF_NYQUIST * rate / 2.0)


def band_edges(bandwidth: float, narrowest: float) -> Array:
    """Edges (B, 2) in shares of the `bandwidth`: the whole, its halves, quarters and eighths, none below `narrowest`
    (Hz) but the whole."""
    edges = []
    for level in range(LEVELS):
        count = 2**level
        if level and bandwidth / count < narrowest:
            break
        edges += [(part / count, (part + 1) / count) for part in range(count)]
    return np.array(edges)
