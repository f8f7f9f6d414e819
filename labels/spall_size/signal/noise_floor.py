"""How much of a record is white noise, from the quietest part of its spectrum."""

from __future__ import annotations

import math

import numpy as np
from scipy.ndimage import uniform_filter1d

from labels.spall_size.signal.divisors import divisor
from physics.arrays import Array

# Samples of each of the stretches whose spectra are averaged.
SEGMENT = 1024
# Bins of that spectrum over which it is smoothed.
SMOOTHED = 9
# Share of noise below which there is none to speak of.
CLEANEST = 1e-9


def log_noise_share(signal: Array) -> float:
    """Logarithm of the share of white noise in the variance of `signal` (T,), were its quietest band noise alone.

    That of CLEANEST at least, and of a record shorter than 1024 samples, which counts as clean.
    """
    windows = signal[: signal.size // SEGMENT * SEGMENT].reshape(-1, SEGMENT)
    if windows.size == 0:
        return math.log(CLEANEST)
    shaped = (windows - signal.mean()) * np.hanning(SEGMENT)
    power = (np.abs(np.fft.rfft(shaped, axis=1)) ** 2).mean(axis=0)[1:-1]
    quietest = float(uniform_filter1d(power, SMOOTHED, mode="nearest").min())
    return math.log(max(quietest * power.size / divisor(power.sum()), CLEANEST))
