"""Instants of the mean pass that could be an event: peaks and edges of its energy, at several degrees of blur."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from labels.spall_size.signal.divisors import divisor
from labels.spall_size.signal.mean_pass import Channel, MeanPass
from physics.arrays import Array

Ranked = list[tuple[float, float]]

# Channels whose peaks are candidates; edges are looked for in the first alone.
SEARCHED = (Channel.ALL, Channel.LOW, Channel.HIGH)
# Standard deviations of the blurs under which peaks and edges are looked for, samples.
BLURS = (0.7, 2.0, 5.0)
# Standard deviation of one more blur, periods.
PERIOD_BLUR = 0.006
# Its smallest value, samples.
LEAST_PERIOD_BLUR = 0.5
# Candidates that are kept at most.
MOST = 18
# Least distance between two candidates, samples.
CLOSEST = 1.6
# Log energy by which a peak must stand above what surrounds it.
LEAST_PROMINENCE = 0.08
# Log energy over twice the blur by which an edge must be steeper than what surrounds it.
LEAST_STEP = 0.3
# Log energy this far and further below the largest counts as nearly constant.
DEPTH = 8.0
# Prominence beyond which a candidate ranks no higher, log energy.
MOST_PROMINENT = 4.0
# Weight of the prominence of an edge, that of a peak being 1.
EDGE_SHARE = 0.7
# Weight of the log energy at a candidate, that of its prominence being 1.
LEVEL_SHARE = 0.15
# Samples from an edge to where the peak of a short event would lie, without blur.
EDGE_SHIFT = 0.5
# How much further that is, as a share of the blur.
EDGE_SHIFT_OF_BLUR = 0.7


def candidate_places(mean: MeanPass) -> Array:
    """At most eighteen candidates (C,), samples from the anchor, within half a period of it, the most prominent.

    An edge counts where the peak of a short event would lie: a rise is the start of an event, a fall is the end of a
    rumble along a rough entry, where the ball is released.
    """
    half = 0.5 * mean.period
    near = (mean.offset >= -half) & (mean.offset < half)
    found: Ranked = []
    for channel in SEARCHED:
        energy = mean.energy[channel]
        level = np.log(energy / divisor(energy[near].max()) + math.exp(-DEPTH))
        for blur in (*BLURS, max(PERIOD_BLUR * mean.period, LEAST_PERIOD_BLUR)):
            found += _peaks(level, blur, mean.offset)
            if channel is SEARCHED[0]:
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
    away = EDGE_SHIFT + EDGE_SHIFT_OF_BLUR * blur
    edges: Ranked = []
    for steepness, shift in ((slope, away), (-slope, -away)):
        peaks, found = find_peaks(steepness, prominence=LEAST_STEP)
        rank = EDGE_SHARE * np.minimum(found["prominences"], MOST_PROMINENT) + LEVEL_SHARE * smooth[peaks]
        edges += list(zip(rank.tolist(), (offset[peaks] + shift).tolist(), strict=True))
    return edges
