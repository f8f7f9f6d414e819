"""Amplitude spectra, and the height of a line in them."""

from __future__ import annotations

import math

import numpy as np
from scipy import fft

from labels.window import periodic_hann
from physics.arrays import Array


def amplitude_spectrum(signal: Array, rate: float) -> tuple[Array, Array]:
    """Frequencies (F,) in Hz and one-sided amplitudes (F,), in the unit of the `signal` (T,), without its mean.

    The window is the periodic Hann window over its mean, so that a line a cos(2π f t) on a bin has height a. ValueError
    for fewer than two samples or a rate that is no finite number above 0.
    """
    signal = np.asarray(signal, dtype=np.float64)
    if signal.size < 2 or not 0.0 < rate < math.inf:
        raise ValueError(
            f"{signal.size} samples at {rate:g} Hz; a spectrum needs at least 2 samples and a rate above 0"
        )
    centred = (signal - signal.mean()) * periodic_hann(signal.size)
    coefficients = fft.rfft(centred) * (2.0 / signal.size)
    # A component without a mirror image is not halved between two of them.
    coefficients[0] /= 2.0
    if signal.size % 2 == 0:
        coefficients[-1] /= 2.0
    frequency = np.arange(coefficients.size) * (rate / signal.size)
    return frequency, np.abs(coefficients)


def line_amplitude(frequency: Array, amplitude: Array, target: float, tolerance: float) -> float:
    """Largest `amplitude` (F,) of a spectrum within `target` ± `tolerance` (Hz) on its `frequency` axis (F,), Hz;
    ValueError if no bin lies there."""
    slack = 1e-9 * max(abs(target), 1.0)
    near = np.abs(np.asarray(frequency) - target) <= tolerance + slack
    if not near.any():
        raise ValueError(
            f"no component within {target:g} ± {tolerance:g} Hz; they lie {frequency[1] - frequency[0]:g} Hz apart"
        )
    return float(np.asarray(amplitude)[near].max())
