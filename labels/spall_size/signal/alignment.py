"""Passes lined up on their strongest event, to a fraction of a sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import fftconvolve

from labels.spall_size.signal.divisors import divisor
from labels.spall_size.signal.pass_track import CELLS, PassTrack
from physics.arrays import Array

# Periods by which an anchor may be moved either way.
SEARCH_SHARE = 0.02
# Samples by which an anchor may be moved either way at least.
FEWEST_SEARCHED = 4
# Periods on either side of an anchor that are matched with the mean of all passes.
CORE_SHARE = 0.012
# Samples on either side of an anchor that are matched at least.
SMALLEST_CORE = 8
# How often the mean of all passes is made anew and every pass matched with it.
ROUNDS = 4
# Standard deviation, in samples, of the blur of the magnitude that is matched.
BLUR = 1.0
# Shift, as a share of the largest one, that costs a match twice PRIOR_WEIGHT; others cost in proportion to their
# square.
PRIOR_WIDTH = 0.6
# Half of what that shift costs, in standard deviations of the pass's match.
PRIOR_WEIGHT = 0.25
# A pass of less weight is not heard.
LEAST_WEIGHT = 0.02


@dataclass(frozen=True)
class Alignment:
    """`place` (K,) of the anchor, the strongest event of each pass, in samples; `weight` (K,) of each pass, 0 to 1."""

    place: Array
    weight: Array


def aligned(energy: Array, rate: float, track: PassTrack) -> Alignment | None:
    """The anchors of the passes of `track` in `energy` (T,); None if fewer than three lie well inside the record.

    Each is moved, within 2 % of the period or four samples if these are more, to where its energy best matches the mean
    of all.
    """
    period = track.period * rate
    search, core = max(FEWEST_SEARCHED, int(SEARCH_SHARE * period)), max(SMALLEST_CORE, int(CORE_SHARE * period))
    reach = search + core
    strongest = int(gaussian_filter1d(np.maximum(track.pattern, 0.0), 1.0, mode="wrap").argmax()) - CELLS // 2
    start = np.round((track.time + strongest * track.period / CELLS) * rate).astype(np.int64)
    start = start[(start > reach + 2) & (start < energy.size - reach - 2)]
    if start.size < 3:
        return None
    magnitude = gaussian_filter1d(np.sqrt(energy), BLUR)
    window = magnitude[start[:, None] + np.arange(-reach, reach + 1)] - np.median(magnitude)
    shift, match = np.zeros(start.size), np.zeros(start.size)
    for _ in range(ROUNDS):
        template = _template(window, np.round(shift).astype(np.int64), search, core)
        shift, match = _best_shift(window, template, search)
    level = divisor(np.percentile(match, 90))
    return Alignment(start + shift, np.clip(match / level, 0.0, 1.0) ** 2)


def _template(window: Array, shift: NDArray[np.int64], search: int, core: int) -> Array:
    columns = search + shift[:, None] + np.arange(2 * core + 1)
    cores = np.take_along_axis(window, columns, axis=1)
    mean = np.maximum(cores.sum(axis=1), 0.0) @ cores
    mean = mean - mean.mean()
    return np.asarray(mean / divisor(np.sqrt((mean**2).sum())))


def _best_shift(window: Array, template: Array, search: int) -> tuple[Array, Array]:
    """Shift (K,) in samples, by a parabola through the best match, and that match (K,)."""
    match = fftconvolve(window, template[None, ::-1], mode="valid", axes=1)
    away = np.arange(-search, search + 1) / (PRIOR_WIDTH * search)
    match = match - 2.0 * PRIOR_WEIGHT * match.std(axis=1, keepdims=True) * away**2
    best = np.clip(match.argmax(axis=1), 1, 2 * search - 1)
    row = np.arange(best.size)
    before, here, after = match[row, best - 1], match[row, best], match[row, best + 1]
    bend = before - 2.0 * here + after
    inside = np.where(np.abs(bend) > 1e-12, 0.5 * (before - after) / np.where(bend == 0.0, 1.0, bend), 0.0)
    return best - search + np.clip(inside, -1.0, 1.0), here
