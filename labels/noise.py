"""How much a signal stands above its background, and noise above which it stands by so much."""

from __future__ import annotations

import math

import numpy as np
from scipy import fft

from labels.band import Band, components_in
from physics.arrays import Array

# Share of a signal's power that rounding leaves in a band where it has none.
ROUNDING = 1e-26


def signal_to_noise(signal: Array, noise: Array, rate: float, band: Band | None = None) -> float:
    """Power of `signal` (T,) over that of `noise` (T,), dB, each without its mean; NaN if either has none.

    Over `band` (Hz, edges included), or from 0 to half the `rate` (Hz) if None. ValueError unless 0 ≤ low < high ≤
    rate / 2 in the band.
    """
    parts = (signal, noise)
    if not all(part.any() for part in parts):  # as without background, where no spectrum need be made
        return math.nan
    powers = [float(part.var()) if band is None else band_power(part, rate, band) for part in parts]
    if any(power <= ROUNDING * float(np.mean(part**2)) for power, part in zip(powers, parts, strict=True)):
        return math.nan
    return 10.0 * math.log10(powers[0] / powers[1])


def with_white_noise(signal: Array, snr_db: float, generator: np.random.Generator) -> Array:
    """The `signal` (T,) plus white noise, drawn from `generator`, whose standard deviation is `snr_db` (dB) below its
    own."""
    return np.asarray(signal + signal.std() * 10.0 ** (-snr_db / 20.0) * generator.standard_normal(signal.size))


def band_power(signal: Array, rate: float, band: Band) -> float:
    """Mean square of the components of `signal` (T,) in `band` (Hz, edges included) but that at 0 Hz.

    ValueError unless 0 ≤ low < high ≤ rate / 2.
    """
    inside = components_in(band, signal.size, rate)
    power = 2.0 * np.abs(fft.rfft(signal)[max(inside.start, 1) : inside.stop] / signal.size) ** 2
    if signal.size % 2 == 0 and inside.stop == signal.size // 2 + 1:
        power[-1:] /= 2.0
    return float(power.sum())
