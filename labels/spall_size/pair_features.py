"""What is known of a pair of candidates taken for entry and exit event of one ball: one row of numbers a pair."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.event_shapes import SHAPES, event_shapes
from labels.spall_size.mean_pass import CHANNELS, MeanPass
from labels.spall_size.running_energy import RunningEnergy

Array = NDArray[np.float64]

LONGEST_LAG = 0.97
CORE_SHARE = 0.05
SMALLEST_CORE = 1.0
WAVE_REACH = 8
WAVE_SHIFT = 2
SIDES = ("core", "before", "after", "just_before", "just_after")
GLOBALS = (
    "period",
    "lag",
    "lag_share",
    "passes",
    "score",
    "inner",
    "peakedness",
    "predictability",
    "noise",
    "candidates",
)
PAIRS = ("entry_is_anchor", "exit_is_anchor", "inside", "outside", "alike", "entry_coherence", "exit_coherence")
NAMES = (
    *GLOBALS,
    *(f"{event}_{side}_{channel}" for event in ("entry", "exit") for channel in CHANNELS for side in SIDES),
    "exit_over_entry_low",
    "exit_over_entry_high",
    *PAIRS,
    "sway_inside",
    "sway_after",
    "give_at_entry",
    "give_inside",
    "give_at_exit",
    *(f"{event}_{shape}" for event in ("entry", "exit") for shape in SHAPES),
)


@dataclass(frozen=True)
class RecordFacts:
    """What pairs of one record share: `score` of the pass track, `inner` race or not, `peakedness` log mean over
    median energy of the prewhitened signal, `predictability` log variance of the signal over that of its differences,
    `noise` log share of white noise in it."""

    score: float
    inner: bool
    peakedness: float
    predictability: float
    noise: float


@dataclass(frozen=True)
class Pairs:
    """Ordered pairs of candidates: places `entry`, `exit` (P,) in samples from the anchor, `lag` (P,) in samples,
    between 0 and one period, and `features` (P, len(NAMES))."""

    entry: Array
    exit: Array
    lag: Array
    features: Array


def candidate_pairs(mean: MeanPass, places: Array, facts: RecordFacts) -> Pairs:
    """All ordered pairs of different candidates `places` (C,) whose lag is below 0.97 periods."""
    first, second = (index.ravel() for index in np.meshgrid(np.arange(places.size), np.arange(places.size)))
    entry, leave = places[first], places[second]
    lag = leave - entry
    lag = np.where(lag < 0.0, lag + mean.period, lag)
    kept = (first != second) & (lag < LONGEST_LAG * mean.period)
    entry, leave, lag = entry[kept], leave[kept], lag[kept]
    summed = RunningEnergy(mean)
    shapes = event_shapes(mean, places, summed)
    alone = [shapes[first[kept]], shapes[second[kept]]]
    together = _features(mean, summed, places.size, facts, entry, leave, lag)
    return Pairs(entry, leave, lag, np.column_stack([together, *alone]))


def _features(
    mean: MeanPass, summed: RunningEnergy, count: int, facts: RecordFacts, entry: Array, leave: Array, lag: Array
) -> Array:
    ones = np.ones(lag.size)
    core = np.maximum(SMALLEST_CORE, CORE_SHARE * lag)
    columns = [
        math.log(mean.period) * ones, np.log(lag), lag / mean.period, math.log(max(mean.passes, 1.0)) * ones,
        facts.score * ones, float(facts.inner) * ones, facts.peakedness * ones, facts.predictability * ones,
        facts.noise * ones, count * ones,
    ]  # fmt: skip
    levels = [_levels(summed, place, lag, core) for place in (entry, leave)]
    for level in levels:
        columns += [level[channel, side] for channel in range(len(CHANNELS)) for side in range(len(SIDES))]
    columns += [levels[1][channel, 0] - levels[0][channel, 0] for channel in (1, 3)]
    weaker = np.minimum(levels[0][0, 0], levels[1][0, 0])
    columns += [
        (np.abs(entry) < 1.0).astype(float),
        (np.abs(leave) < 1.0).astype(float),
        _largest_between(mean, entry + core + 1.0, entry + lag - core - 1.0) - weaker,
        _largest_between(mean, entry + lag + core + 1.0, entry + mean.period - core - 1.0) - weaker,
        _alike(mean, entry, leave),
        *(_coherence(mean, place) for place in (entry, leave)),
        _mean_sway(mean, entry, entry + lag),
        _mean_sway(mean, entry + lag, entry + np.minimum(1.5 * lag, mean.period)),
        *(_give(mean, entry + share * lag) for share in (0.0, 0.5, 1.0)),
    ]
    return np.column_stack(columns)


def _levels(summed: RunningEnergy, place: Array, lag: Array, core: Array) -> Array:
    """Log energy (4, 5, P) at, before and after a place, in windows that grow with the lag, and just beside it."""
    half = np.maximum(0.5 * lag, core + 2.0)
    windows = [
        (place - core, place + core),
        (place - half, place - core - 1.0),
        (place + core + 1.0, place + half),
        (place - 6.0, place - 2.0),
        (place + 2.0, place + 6.0),
    ]
    return np.stack([summed.level(start, stop) for start, stop in windows], axis=1)


def _largest_between(mean: MeanPass, start: Array, stop: Array) -> Array:
    """Log of the largest energy strictly between two offsets (P,), −9 where there is no room."""
    level = np.log(mean.energy[0] + 1e-9)
    found = np.full(start.size, -9.0)
    size, period = level.size, round(mean.period)
    for k in range(start.size):
        left, right = int(start[k] - mean.offset[0]), int(stop[k] - mean.offset[0])
        if right <= left:
            continue
        if right >= size:
            left, right = left - period, right - period
        found[k] = level[max(left, 0) : right].max() if right > max(left, 0) else -9.0
    return found


def _waves(mean: MeanPass, place: Array, reach: int) -> Array:
    centre = np.round(place).astype(np.int64) - mean.offset[0]
    return mean.waveform[np.clip(centre[:, None] + np.arange(-reach, reach + 1), 0, mean.waveform.size - 1)]


def _alike(mean: MeanPass, entry: Array, leave: Array) -> Array:
    """Largest signed correlation (P,) of the mean waveforms round both places, shifted by at most two samples."""
    one, other = _waves(mean, entry, WAVE_REACH), _waves(mean, leave, WAVE_REACH + WAVE_SHIFT)
    best = np.zeros(entry.size)
    for shift in range(2 * WAVE_SHIFT + 1):
        part = other[:, shift : shift + 2 * WAVE_REACH + 1]
        size = np.sqrt((one**2).sum(axis=1) * (part**2).sum(axis=1)) + 1e-12
        value = (one * part).sum(axis=1) / size
        best = np.where(np.abs(value) > np.abs(best), value, best)
    return best


def _coherence(mean: MeanPass, place: Array) -> Array:
    """Log of the energy of the mean waveform over the mean energy round a place (P,)."""
    centre = np.round(place).astype(np.int64) - mean.offset[0]
    near = np.clip(centre[:, None] + np.arange(-3, 4), 0, mean.waveform.size - 1)
    return np.log((mean.waveform[near] ** 2).mean(axis=1) + 1e-9) - np.log(mean.energy[0][near].mean(axis=1) + 1e-9)


def _give(mean: MeanPass, place: Array) -> Array:
    shift = np.where(place > mean.offset[-1], mean.period, 0.0)
    return np.interp(place - shift, mean.offset, mean.give)


def _mean_sway(mean: MeanPass, start: Array, stop: Array) -> Array:
    """Mean (P,) of the sway between two offsets, which wrap round one period."""
    shift = np.where(stop > mean.offset[-1], mean.period, 0.0)
    running = np.concatenate([[0.0], np.cumsum(mean.sway)])
    left, right = (
        np.interp(place - shift - mean.offset[0], np.arange(running.size), running) for place in (start, stop)
    )
    return np.asarray((right - left) / np.maximum(stop - start, 1.0))
