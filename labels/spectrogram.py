"""Short-time spectra: how the frequencies of a record change while balls pass."""

from __future__ import annotations

import numpy as np
from scipy import fft

from physics.arrays import Array

SHARE_OF_SPAN = 0.04
FEWEST_WINDOW_SAMPLES = 48
COLUMNS = 400


def spectrogram(signal: Array, rate: float, start: float, stop: float) -> tuple[Array, Array, Array]:
    """Times (C,) in s, frequencies (F,) in Hz and power (F, C) of the `signal` (T,) from `start` to `stop` (s).

    The window is a Hann window of 4 % of the span, at least 48 samples; a tone of amplitude a has power a²/2. Beyond
    the ends of the signal there is silence.
    """
    size = max(FEWEST_WINDOW_SAMPLES, round(SHARE_OF_SPAN * (stop - start) * rate))
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * (np.arange(size) + 0.5) / size)
    centres = np.linspace(start, stop, COLUMNS)
    first = np.round(centres * rate).astype(np.int64) - size // 2
    place = first[:, None] + np.arange(size)
    signal = np.asarray(signal, dtype=np.float64)
    rows = np.where((place >= 0) & (place < signal.size), signal[np.clip(place, 0, signal.size - 1)], 0.0)
    length = fft.next_fast_len(4 * size, real=True)
    coefficients = fft.rfft(rows * window, length, axis=1) * (2.0 / window.sum())
    return centres, np.arange(length // 2 + 1) * (rate / length), np.abs(coefficients.T) ** 2 / 2.0
