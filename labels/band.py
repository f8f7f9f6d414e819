"""A band of frequencies, and the Fourier components of a signal in it."""

from __future__ import annotations

import math

import numpy as np

Band = tuple[float, float]
"""Lower and upper edge, Hz; both belong to it."""


def components_in(band: Band, samples: int, rate: float) -> slice:
    """Which of the components that `numpy.fft.rfft` gives of so many `samples` at `rate` (Hz) lie in `band`.

    ValueError unless 0 ≤ low < high ≤ rate / 2 and the rate is finite.
    """
    low, high = band
    if not 0.0 <= low < high <= rate / 2.0 < math.inf:
        raise ValueError(f"band {low:g} to {high:g} Hz; allowed: 0 <= low < high <= {rate / 2.0:g} Hz (half the rate)")
    # Multiplied first, a frequency is that of the band's edge wherever both can be written: rfftfreq rounds twice.
    frequency = np.arange(samples // 2 + 1) * rate / samples
    first, end = np.searchsorted(frequency, low, side="left"), np.searchsorted(frequency, high, side="right")
    return slice(int(first), int(end))


def holds_a_line(band: Band, samples: int, rate: float) -> bool:
    """Whether the spectrum of so many `samples` at `rate` (Hz) has a component above 0 Hz in `band`.

    A band at least rate / samples wide, the distance of the components, always holds one.
    """
    low, high = band
    first = max(math.ceil(low * samples / rate) - 1, 1)
    # As `components_in` rounds.
    return any(low <= line * rate / samples <= high for line in range(first, min(first + 2, samples // 2) + 1))
