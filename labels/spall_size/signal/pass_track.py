"""When balls pass the spall: a path through the record as regular as a slipping cage, through its busiest instants."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import fftconvolve

from labels.spall_size.signal.divisors import divisor
from physics.arrays import Array
from physics.compiled import njit

# Cells into which a period is cut.
CELLS = 256
# Share by which a step of the first path may differ from the stated period.
FIRST_TOLERANCE = 0.05
# Share by which a step of a later path may differ from the mean step of the path before.
TOLERANCE = 0.04
# Standard deviation of the steps of the first path, in periods.
FIRST_DEVIATION = 0.02
# Standard deviation of the steps of a later path, in periods: the scatter that a slipping cage has.
DEVIATION = 0.009
# How often the pattern is learned from a path and a new path laid by it.
ROUNDS = 3
# Standard deviation of the blur of the log energy along which the first path is laid, cells.
BLUR = 1.5
# Passes that a record must be long enough for.
FEWEST_TRACKED = 5


@dataclass(frozen=True)
class PassTrack:
    """Ball passes found in a record.

    `time` (K,) s, each at the same but unknown phase of its pass; `period` s, the mean time between them; `pattern`
    (256,) is the mean log energy over one period centred on `time`; `score` the mean match of the passes with it, in
    standard deviations of the record.
    """

    time: Array
    period: float
    pattern: Array
    score: float


def track_passes(energy: Array, rate: float, period: float) -> PassTrack | None:
    """The passes in `energy` (T,) sampled at `rate` (Hz), their `period` (s) known to within FIRST_TOLERANCE.

    None if the record is shorter than FEWEST_TRACKED of them. The path is the best one by dynamic programming under
    a random walk of 0.9 % of a period a pass, its pattern learned from the record in three rounds.
    """
    step = period * rate / CELLS
    log_energy = _cells(energy, step)
    if log_energy.size < FEWEST_TRACKED * CELLS:
        return None
    log_energy = np.log1p(log_energy / divisor(np.median(log_energy)))
    log_energy -= log_energy.mean()
    spread = divisor(log_energy.std())
    match = gaussian_filter1d(log_energy, BLUR)
    match /= divisor(match.std())
    path = _best_path(match, 1.0 - FIRST_TOLERANCE, 1.0 + FIRST_TOLERANCE, float(CELLS), FIRST_DEVIATION * CELLS)
    pattern = np.zeros(CELLS)
    for _ in range(ROUNDS):
        mean = float(np.polyfit(np.arange(path.size), path, 1)[0])
        pattern = _mean_pattern(log_energy, path)
        match = fftconvolve(log_energy, pattern[::-1])[CELLS // 2 - 1 :][: log_energy.size]
        match /= divisor(np.sqrt((pattern**2).sum()) * spread)
        share = mean / CELLS
        path = _best_path(match, share * (1.0 - TOLERANCE), share * (1.0 + TOLERANCE), mean, DEVIATION * CELLS)
    seconds = step / rate
    mean = float(np.mean(np.diff(path)))
    return PassTrack((path.astype(np.float64) + 0.5) * seconds, mean * seconds, pattern, float(match[path].mean()))


def _cells(energy: Array, step: float) -> Array:
    """Mean of `energy` over consecutive cells of `step` samples."""
    summed = np.concatenate([[0.0], np.cumsum(energy)])
    edges = np.arange(0.0, energy.size, step)
    return np.diff(np.interp(edges, np.arange(energy.size + 1), summed)) / step


def _mean_pattern(log_energy: Array, path: NDArray[np.int64]) -> Array:
    """Mean (256,) over the passes, those that resemble their mean counting more."""
    place = path[:, None] + np.arange(-CELLS // 2, CELLS // 2)
    inside = (place >= 0) & (place < log_energy.size)
    passes = np.where(inside, log_energy[np.clip(place, 0, log_energy.size - 1)], 0.0)
    weight = np.maximum(passes @ passes.mean(axis=0), 0.0)
    total = float(weight.sum())
    mean = passes.mean(axis=0) if total == 0.0 else weight @ passes / total
    return np.asarray(mean - mean.mean())


def _best_path(match: Array, shortest: float, longest: float, mean: float, deviation: float) -> NDArray[np.int64]:
    low, high = int(shortest * CELLS), int(longest * CELLS) + 1
    penalty: Array = 0.5 * ((np.arange(low, high + 1, dtype=np.float64) - mean) / deviation) ** 2
    return _dynamic_programme(np.ascontiguousarray(match), low, penalty)


@njit
def _dynamic_programme(match: Array, low: int, penalty: Array) -> NDArray[np.int64]:
    """The path of the largest sum of `match` (C,) whose steps are `low`, `low` + 1 … cells long, each less its
    `penalty`."""
    count, high = match.size, low + penalty.size - 1
    total = match.copy()
    before = np.full(count, -1)
    for k in range(low, count):
        best, longer = total[k - low] - penalty[0], 0
        for j in range(1, min(penalty.size, k - low + 1)):
            value = total[k - low - j] - penalty[j]
            if value > best:
                best, longer = value, j
        total[k] += best
        before[k] = k - low - longer
    end = count - high + int(np.argmax(total[count - high :]))
    length = 0
    k = end
    while k >= 0:
        length += 1
        k = before[k]
    path = np.empty(length, dtype=np.int64)
    k = end
    for place in range(length - 1, -1, -1):
        path[place] = k
        k = before[k]
    return path
