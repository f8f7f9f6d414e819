"""Power spectral densities of acceleration and velocity at a stated resolution."""

from __future__ import annotations

import math

import numpy as np
from scipy import fft

from labels.window import periodic_hann
from physics.arrays import Array


def power_density(signal: Array, rate: float, resolution: float) -> tuple[Array, Array]:
    """Frequencies (F,) in Hz and one-sided densities (F,), unit² / Hz, of the `signal` (T,) without its mean.

    Mean over Hann windows of 1/`resolution` seconds (Hz), spread evenly from the first sample to the last so that
    neighbours overlap by half or more [Welch 1967]. ValueError if the signal is shorter than one window, or unless rate
    and resolution are finite and above 0.
    """
    centred = np.asarray(signal, dtype=np.float64) - np.mean(signal)
    if not (0.0 < rate < math.inf and 0.0 < resolution < math.inf):
        raise ValueError(f"a resolution of {resolution:g} Hz at {rate:g} Hz; both must be finite and above 0")
    size = round(rate / resolution)
    if not 2 <= size <= centred.size:
        raise ValueError(
            f"a resolution of {resolution:g} Hz needs {size} samples (2 or more); there are {centred.size}"
        )
    window = periodic_hann(size)
    count = math.ceil((centred.size - size) / (size / 2.0)) + 1
    starts = np.round(np.linspace(0.0, centred.size - size, count)).astype(int)
    power = np.mean([np.abs(fft.rfft(centred[first : first + size] * window)) ** 2 for first in starts], axis=0)
    power *= 2.0 / (rate * np.sum(window**2))
    power[0] /= 2.0
    if size % 2 == 0:
        power[-1] /= 2.0
    return np.arange(power.size, dtype=np.float64) * (rate / size), power


def velocity_density(acceleration: Array, rate: float, resolution: float) -> tuple[Array, Array]:
    """Frequencies (F,) in Hz and one-sided densities (F,) of the velocity, (m/s)²/Hz, of an `acceleration` (T,), m/s².

    Each component over (2π f)²; the one at 0 Hz, which has no velocity, is 0. `rate` and `resolution` in Hz; ValueError
    as `power_density`.
    """
    frequency, power = power_density(acceleration, rate, resolution)
    power[1:] /= (2.0 * np.pi * frequency[1:]) ** 2
    power[0] = 0.0
    return frequency, power
