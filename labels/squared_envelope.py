"""Squared envelope of a band, which features and the kurtogram are made of, and how impulsive it is."""

from __future__ import annotations

import numpy as np
from scipy import fft

from physics.arrays import Array, ComplexArray


def squared_envelope(inside: ComplexArray, least: int) -> Array:
    """Squared magnitude (T,) of the complex signal with the Fourier components `inside` (K,), of T ≥ `least` samples
    over the length of the record; `least` is at least K."""
    padded = np.zeros(fft.next_fast_len(least), dtype=np.complex128)
    padded[: inside.size] = inside
    return np.asarray(np.abs(fft.ifft(padded)) ** 2)


def excess_kurtosis(square: Array) -> float:
    """Excess kurtosis of the complex signal with this squared envelope (T,): its mean square over its squared mean,
    minus 2. 0 for noise, -1 for a tone, large for rare bursts; -2 where there is no signal [Antoni 2007, MSSP 21,
    108]."""
    return float(np.mean(square**2)) / max(float(square.mean()) ** 2, np.finfo(np.float64).tiny) - 2.0
