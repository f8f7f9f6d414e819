"""The band in which a signal is most impulsive, where impacts stand out of everything else [Antoni 2007, MSSP 21, 108].

The kurtosis of the analytic signal in a band is zero for noise, negative for tones and grows with rare, large bursts.
It is taken over stretches of the record, and the median of these, so that one knock does not choose the band.
"""

from __future__ import annotations

import numpy as np
from scipy import fft

from labels.band import Band
from labels.band_tree import band_edges, usable_bandwidth
from labels.squared_envelope import excess_kurtosis, squared_envelope
from physics.arrays import Array, ComplexArray

STRETCHES = 8
FEWEST_COMPONENTS = 2.0


def most_impulsive_band(signal: Array, rate: float, piece: int) -> Band:
    """Lower and upper edge (Hz) of the band of a `signal` (T,) at `rate` (Hz) whose kurtosis is largest.

    The bands are those of `labels.band_tree`, as far as they hold two components of a stretch and of a `piece` of so
    many samples.
    """
    spectrum = np.asarray(fft.rfft(np.asarray(signal, dtype=np.float64) - np.mean(signal)))
    step, top = rate / signal.size, usable_bandwidth(rate)
    edges = top * band_edges(top, FEWEST_COMPONENTS * max(STRETCHES * step, rate / piece))
    low, high = max(edges.tolist(), key=lambda band: _kurtosis(spectrum[int(band[0] / step) : int(band[1] / step)]))
    return low, high


def _kurtosis(inside: ComplexArray) -> float:
    """Median over stretches of the excess kurtosis of the complex signal with these Fourier components."""
    square = squared_envelope(inside, max(inside.size, STRETCHES))
    stretches = [part for part in np.array_split(square, STRETCHES) if part.any()]
    return float(np.median([excess_kurtosis(part) for part in stretches or [square]]))
