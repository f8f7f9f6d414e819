"""Lowering a sampling rate without aliasing and without delay."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

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
