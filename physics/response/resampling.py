"""Other samples of a signal: at a lower rate without aliasing and without delay, and at any place between its own."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from physics._jit import njit_inline, njit_lean
from physics.arrays import Array

# Points of the polynomial through a place's neighbours: with 25 samples a period it is right to 1e-6.
POINTS = 6
SHARES = tuple((-1.0) ** (POINTS - 1 - k) / (math.factorial(k) * math.factorial(POINTS - 1 - k)) for k in range(POINTS))

# The low-pass of `decimate`: taps on each side for each new sample, the share of the new Nyquist frequency at which it
# halves amplitudes, and the parameter of its Kaiser window, for 80 dB beyond 1.06. It passes amplitudes to 1e-3 up to
# 0.84, 0.91 of them at 0.9 and 0.09 at 1.
HALF_LENGTH_SAMPLES, HALVED_SHARE, KAISER_BETA = 24, 0.95, 0.1102 * (80.0 - 8.7)
FILTERS_KEPT = 16
# Samples that are weighed together: what they and their neighbours take stays in the fastest cache.
BLOCK = 512


def decimate(signal: Array, factor: int) -> Array:
    """Every `factor`-th sample (ceil(T / factor), C) of `signal` (T, C) after a linear-phase low-pass.

    The filter passes up to 0.84 of the new Nyquist frequency and has no delay; from 1.06 on nothing is left. Beyond its
    ends the signal is taken to go on with its first and last value, so HALF_LENGTH_SAMPLES new samples at either end
    are right only if it does.
    """
    if factor == 1:
        return signal
    half, count = HALF_LENGTH_SAMPLES * factor, -(-signal.shape[0] // factor)
    rows = count + 2 * HALF_LENGTH_SAMPLES + 1
    beyond = rows * factor - half - signal.shape[0]
    padded = np.pad(signal, [(half, beyond), (0, 0)], mode="edge")
    phases = np.ascontiguousarray(padded.reshape(rows, factor, -1).transpose(1, 2, 0))
    lowered = np.zeros((signal.shape[1], count))
    _weigh(phases, _low_pass(factor), lowered)
    return np.ascontiguousarray(lowered.T)


@lru_cache(maxsize=FILTERS_KEPT)
def _low_pass(factor: int) -> Array:
    """The weights (24 · factor + 1,) of the sample in the middle and of those ever farther from it, on either side."""
    half = HALF_LENGTH_SAMPLES * factor
    taps = np.sinc(HALVED_SHARE / factor * np.arange(half + 1)) * np.kaiser(2 * half + 1, KAISER_BETA)[half:]
    return taps / (2.0 * taps.sum() - taps[0])


@njit_lean
def _weigh(phases: Array, weights: Array, lowered: Array) -> None:
    """Add to `lowered` (C, T) the sums of the `phases` (factor, C, rows) of a signal: sample r · factor + p is in row r
    of phase p.

    One weight at a time over a block of samples, so that the loop over the block uses vector instructions.
    """
    factor, half = phases.shape[0], weights.size - 1
    for channel in range(lowered.shape[0]):
        for first in range(0, lowered.shape[1], BLOCK):
            block = lowered[channel, first : first + BLOCK]
            for away in range(half + 1):
                before, after = half - away, half + away
                early = phases[before % factor, channel, first + before // factor :]
                late = phases[after % factor, channel, first + after // factor :]
                weight = weights[away] if away > 0 else 0.5 * weights[0]
                for k in range(block.size):
                    block[k] += weight * (early[k] + late[k])


def read_at(signal: Array, place: Array) -> Array:
    """Values (K, 2) of `signal` (T, 2) at each `place` (K,) in samples, by quintic polynomials.

    Raises ValueError if there are fewer than 6 samples.
    """
    if signal.shape[0] < POINTS:
        raise ValueError(f"{signal.shape[0]} samples; reading between them takes at least {POINTS}")
    values = np.zeros((place.size, 2))
    _read_at(np.ascontiguousarray(signal), np.ascontiguousarray(place), values)
    return values


@njit_lean
def _read_at(signal: Array, place: Array, values: Array) -> None:
    for k in range(place.size):
        _read_one(signal, place[k], min(_first_point(place[k]), signal.shape[0] - POINTS), values, k)


def read_repeated(signal: Array, period: int, pace: float, count: int) -> Array:
    """Values (count, 2) at the places k · `pace` of `signal` (T, 2), whose last `period` samples, 6 or more, go on and
    on."""
    values, end = np.zeros((count, 2)), signal.shape[0]
    _read_repeated(np.concatenate([signal, signal[end - period :][:POINTS]]), end, period, pace, values)
    return values


@njit_lean
def _read_repeated(signal: Array, end: int, period: int, pace: float, values: Array) -> None:
    """As `read_repeated`, of a `signal` that goes on behind its `end` by as many samples as are read there."""
    back = 0.0
    for k in range(values.shape[0]):
        place = k * pace - back
        # Counted up, as a division for every sample would take a third of the time.
        while place >= end:
            back += period
            place = k * pace - back
        _read_one(signal, place, _first_point(place), values, k)


@njit_inline
def _first_point(place: float) -> int:
    """The first of the POINTS samples around a `place`."""
    return max(int(place) - POINTS // 2 + 1, 0)


@njit_inline
def _read_one(signal: Array, place: float, first: int, values: Array, row: int) -> None:
    """Fill one `row` of `values` (K, 2): what the polynomial through the POINTS samples of `signal` (T, 2) from the
    `first` on is at a `place`."""
    a = place - first
    b, c, d, e, f = a - 1.0, a - 2.0, a - 3.0, a - 4.0, a - 5.0
    ab, ef = a * b, e * f
    abc, d_to_f = ab * c, d * ef
    shares = (b * c * d_to_f, a * c * d_to_f, ab * d_to_f, abc * ef, abc * d * f, abc * d * e)
    along, across = 0.0, 0.0
    for j in range(POINTS):
        # Unsigned, so that no point is looked at for being counted from the end.
        point, share = np.uint64(first + j), SHARES[j] * shares[j]
        along += share * signal[point, 0]
        across += share * signal[point, 1]
    values[row, 0], values[row, 1] = along, across
