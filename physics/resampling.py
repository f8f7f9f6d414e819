"""Other samples of a signal: at a lower rate without aliasing and without delay, and at any place between its own."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit

Array = NDArray[np.float64]

# Points of the polynomial through a place's neighbours: with 25 samples a period it is right to 1e-6.
POINTS = 6
SHARES = tuple((-1.0) ** (POINTS - 1 - k) / (math.factorial(k) * math.factorial(POINTS - 1 - k)) for k in range(POINTS))

HALF_LENGTH_SAMPLES = 24
PASSED_SHARE = 0.9
STOPBAND_DB = 80.0


def decimate(signal: Array, factor: int) -> Array:
    """Every `factor`-th sample (ceil(T / factor), …) of `signal` (T, …) after a linear-phase low-pass.

    The filter passes up to 0.9 of the new Nyquist frequency and has no delay; beyond its ends the signal is taken to go
    on with its first and last value.
    """
    from scipy.signal import firwin, upfirdn

    if factor == 1:
        return signal
    half = HALF_LENGTH_SAMPLES * factor
    taps = firwin(2 * half + 1, 0.5 * (1.0 + PASSED_SHARE) / factor, window=("kaiser", 0.1102 * (STOPBAND_DB - 8.7)))
    edges = [(half, half)] + [(0, 0)] * (signal.ndim - 1)
    padded = np.pad(signal, edges, mode="edge")
    count = -(-signal.shape[0] // factor)
    filtered = upfirdn(taps, padded, up=1, down=factor, axis=0)
    skip = 2 * HALF_LENGTH_SAMPLES
    return np.ascontiguousarray(filtered[skip : skip + count])


def read_at(signal: Array, place: Array) -> Array:
    """Values (K, C) of `signal` (T, C) at each `place` (K,) in samples, by quintic polynomials.

    Raises ValueError if there are fewer than 6 samples.
    """
    if signal.shape[0] < POINTS:
        raise ValueError(f"{signal.shape[0]} samples; reading between them takes at least {POINTS}")
    values = np.zeros((place.size, signal.shape[1]))
    _read_at(np.ascontiguousarray(signal), np.ascontiguousarray(place), values)
    return values


@njit
def _read_at(signal: Array, place: Array, values: Array) -> None:
    share = np.zeros(POINTS)
    for k in range(place.size):
        first = min(max(int(place[k]) - POINTS // 2 + 1, 0), signal.shape[0] - POINTS)
        x = place[k] - first
        product = 1.0
        for j in range(POINTS):
            share[j] = product * SHARES[j]
            product *= x - j
        product = 1.0
        for j in range(POINTS - 1, -1, -1):
            share[j] *= product
            product *= x - j
        for channel in range(signal.shape[1]):
            total = 0.0
            for j in range(POINTS):
                total += share[j] * signal[first + j, channel]
            values[k, channel] = total
