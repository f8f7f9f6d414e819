"""Instants of the mean pass that could be an event: peaks and edges of its energy, at several degrees of blur."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from labels.spall_size.mean_pass import MeanPass

Array = NDArray[np.float64]
Ranked = list[tuple[float, float]]

BLURS = (0.7, 2.0, 5.0)
PERIOD_BLUR = 0.006
MOST = 18
CLOSEST = 1.6
LEAST_PROMINENCE = 0.08
LEAST_STEP = 0.3
DEPTH = 8.0  # what lies further below the largest energy (logarithm) does not vary
MOST_PROMINENT = 4.0
EDGE_SHARE = 0.7
LEVEL_SHARE = 0.15


def candidate_places(mean: MeanPass) -> Array:
    """At most eighteen candidates (C,), samples from the anchor, within half a period of it, the most prominent.

    An edge counts where the peak of a short event would lie: a rise is the start of an event, a fall is the end of a
    rumble along a rough entry, where the ball is released.
    """
    half = 0.5 * mean.period
    near = (mean.offset >= -half) & (mean.offset < half)
    found: Ranked = []
    for channel in (0, 1, 3):
        energy = mean.energy[channel]
        level = np.log(energy / max(float(energy[near].max()), 1e-300) + math.exp(-DEPTH))
        for blur in (*BLURS, max(PERIOD_BLUR * mean.period, 0.5)):
            found += _peaks(level, blur, mean.offset)
            if channel == 0:
                found += _edges(level, blur, mean.offset)
    chosen: list[float] = []
    for _, place in sorted(found, reverse=True):
        if -half <= place < half and all(abs(place - other) >= CLOSEST for other in chosen):
            chosen.append(place)
        if len(chosen) == MOST:
            break
    return np.array(sorted(chosen))


def _peaks(level: Array, blur: float, offset: NDArray[np.int64]) -> Ranked:
    """Rank and place, to a fraction of a sample, of each peak of the blurred `level` (S,)."""
    smooth = gaussian_filter1d(level, blur)
    peaks, found = find_peaks(smooth, prominence=LEAST_PROMINENCE)
    before, here, after = smooth[peaks - 1], smooth[peaks], smooth[peaks + 1]
    bend = np.minimum(before - 2.0 * here + after, -1e-12)
    place = offset[peaks] + np.clip(0.5 * (before - after) / bend, -0.5, 0.5)
    rank = np.minimum(found["prominences"], MOST_PROMINENT) + LEVEL_SHARE * smooth[peaks]
    return list(zip(rank.tolist(), place.tolist(), strict=True))


def _edges(level: Array, blur: float, offset: NDArray[np.int64]) -> Ranked:
    """Rank and place of each steepest rise and fall of the blurred `level` (S,)."""
    smooth, slope = gaussian_filter1d(level, blur), 2.0 * blur * gaussian_filter1d(level, blur, order=1)
    away = 0.5 + 0.7 * blur
    edges: Ranked = []
    for steepness, shift in ((slope, away), (-slope, -away)):
        peaks, found = find_peaks(steepness, prominence=LEAST_STEP)
        rank = EDGE_SHARE * np.minimum(found["prominences"], MOST_PROMINENT) + LEVEL_SHARE * smooth[peaks]
        edges += list(zip(rank.tolist(), (offset[peaks] + shift).tolist(), strict=True))
    return edges
