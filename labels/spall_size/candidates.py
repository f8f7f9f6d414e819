"""Instants of the mean pass that could be an event: peaks of its energy in any band, at several degrees of blur."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import find_peaks

from labels.spall_size.mean_pass import MeanPass

Array = NDArray[np.float64]

BLURS = (0.7, 2.0, 5.0)
PERIOD_BLUR = 0.006
MOST = 12
CLOSEST = 1.6
LEAST_PROMINENCE = 0.08


def candidate_places(mean: MeanPass) -> Array:
    """At most twelve candidates (C,), samples from the anchor, within half a period of it, the most prominent."""
    found: list[tuple[float, float]] = []
    level = np.log(mean.energy + 1e-12)
    for channel in (0, 1, 3):
        for blur in (*BLURS, PERIOD_BLUR * mean.period):
            found += _peaks(level[channel], blur, mean.offset)
    half = 0.5 * mean.period
    found = [(rank, place) for rank, place in found if -half <= place < half]
    chosen: list[float] = []
    for _, place in sorted(found, reverse=True):
        if all(abs(place - other) >= CLOSEST for other in chosen):
            chosen.append(place)
        if len(chosen) == MOST:
            break
    return np.array(sorted(chosen))


def _peaks(level: Array, blur: float, offset: NDArray[np.int64]) -> list[tuple[float, float]]:
    """Prominence and place, to a fraction of a sample, of each peak of the blurred `level` (S,)."""
    smooth = gaussian_filter1d(level, max(blur, 0.5))
    peaks, found = find_peaks(smooth, prominence=LEAST_PROMINENCE)
    if peaks.size == 0:
        return []
    before, here, after = smooth[peaks - 1], smooth[peaks], smooth[peaks + 1]
    bend = np.minimum(before - 2.0 * here + after, -1e-12)
    place = offset[peaks] + np.clip(0.5 * (before - after) / bend, -0.5, 0.5)
    return list(zip(found["prominences"].tolist(), place.tolist(), strict=True))
