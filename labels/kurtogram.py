"""The band in which a signal is most impulsive, where impacts stand out of everything else [Antoni 2007, MSSP 21, 108].

The kurtosis of the analytic signal in a band is zero for noise, negative for tones and grows with rare, large bursts.
It is taken over stretches of the record, and the median of these, so that one knock does not choose the band.
"""

from __future__ import annotations

import numpy as np
from scipy import fft

from labels.envelope import Array, Band

DIVISIONS = (1, 2, 4, 8)
HIGHEST = 20_000.0
SHARE_OF_NYQUIST = 0.95
STRETCHES = 8


def most_impulsive_band(signal: Array, rate: float, piece: int) -> Band:
    """Lower and upper edge (Hz) of the band of a `signal` (T,) at `rate` (Hz) whose kurtosis is largest.

    The bands are the whole, the halves, quarters and eighths of what lies below 20 kHz and below 0.95 of half the rate,
    as far as they hold two components of a stretch and of a `piece` of so many samples.
    """
    spectrum = np.asarray(fft.rfft(np.asarray(signal, dtype=np.float64) - np.mean(signal)))
    count = int(min(HIGHEST, SHARE_OF_NYQUIST * rate / 2.0) * signal.size / rate)
    edges = [
        (part * count // parts, (part + 1) * count // parts)
        for parts in DIVISIONS
        for part in range(parts)
        if parts == 1 or count // parts >= 2 * max(STRETCHES, signal.size / piece)
    ]
    first, end = max(edges, key=lambda edge: _kurtosis(spectrum[edge[0] : edge[1]]))
    return first * rate / signal.size, max(end, 1) * rate / signal.size


def _kurtosis(inside: np.ndarray) -> float:
    """Median over stretches of the excess kurtosis of the complex signal with these Fourier components."""
    padded = np.zeros(fft.next_fast_len(max(inside.size, STRETCHES)), dtype=np.complex128)
    padded[: inside.size] = inside
    square = np.abs(fft.ifft(padded)) ** 2
    stretches = [part for part in np.array_split(square, STRETCHES) if part.any()]
    return float(np.median([np.mean(part**2) / np.mean(part) ** 2 - 2.0 for part in stretches])) if stretches else -2.0
