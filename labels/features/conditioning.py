"""From a raw signal to its spectrum over the common bandwidth, flattened so that no resonance or tone rules it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import fft

from labels.band_tree import COMMON_BANDWIDTH, usable_bandwidth
from labels.features.turning import Turning
from labels.noise import ROUNDING
from physics.arrays import Array, ComplexArray

FEWEST_SAMPLES_USED = 64
BLOCKS = 96
# Components in the smallest block from which a local mean power is taken.
FEWEST_BINS = 24
# A component is cut to this many times the local mean power; noise exceeds it once in e^10 components.
TONE_CEILING = 10.0
MEDIAN_OVER_MEAN = float(np.log(2.0))


@dataclass(frozen=True)
class Conditioned:
    """Fourier components (F,) of a record from 0 to `bandwidth` (Hz), `step` Hz apart: raw, and flattened.

    `samples` of the record were used; `turning` is given where the speed of its shaft changes.
    """

    raw: ComplexArray
    flat: ComplexArray
    step: float
    bandwidth: float
    samples: int
    turning: Turning | None

    @property
    def duration(self) -> float:
        """Length of the record that was used, s."""
        return 1.0 / self.step

    def slow(self, count: int) -> ComplexArray:
        """The first `count` raw components, or fewer; where the speed changes, of the record seen at even angles."""
        if self.turning is None:
            return self.raw[:count]
        count = min(count, self.raw.size)
        return np.asarray(fft.rfft(self.turning.evenly(self.raw, self.samples, count)))[:count]

    def waveform(self, spectrum: ComplexArray) -> Array:
        """The signal (T,) of a spectrum, sampled at about twice the bandwidth, up to a constant factor."""
        return np.asarray(fft.irfft(spectrum, fft.next_fast_len(2 * spectrum.size, real=True)))


def condition(
    signal: Array, rate: float, bandwidth: float = COMMON_BANDWIDTH, turning: Turning | None = None
) -> Conditioned:
    """Spectrum of the `signal` (T,) sampled at `rate` (Hz) below `bandwidth` and below 0.95 of half the rate.

    The end of the record is dropped where its length has no fast transform. The flat spectrum is divided by the square
    root of the local mean power, taken from the median over 1/96 of the bandwidth, and tones are cut to ten times that.
    ValueError for fewer than 64 samples, a rate that is no finite number above 0, samples that are not finite, a signal
    that does not change, or a `turning` of another number of samples.
    """
    signal = sound_signal(signal, rate)
    if turning is not None and turning.angle.size != signal.size:
        raise ValueError(f"{turning.angle.size} angles of the shaft for {signal.size} samples; one for each is needed")
    signal = signal[: fft.prev_fast_len(signal.size, real=True)]
    if np.ptp(signal) == 0.0:
        raise ValueError("the signal does not change")
    centred = signal - signal.mean()
    step = rate / signal.size
    top = usable_bandwidth(rate, bandwidth)
    spectrum = np.asarray(fft.rfft(centred))[: int(top / step) + 1]
    spectrum[0] = 0.0
    used = turning.first(signal.size) if turning is not None else None
    return Conditioned(spectrum, _flattened(spectrum), step, top, signal.size, used)


def sound_signal(signal: Array, rate: float) -> Array:
    """The `signal` (T,) as float64.

    ValueError for fewer than 64 samples or several axes, samples that are not finite, or a `rate` (Hz) that is no
    finite number above 0.
    """
    signal = np.asarray(signal, dtype=np.float64)
    if signal.ndim != 1 or signal.size < FEWEST_SAMPLES_USED or not 0.0 < rate < math.inf:
        needed = f"features need at least {FEWEST_SAMPLES_USED} samples of one axis"
        raise ValueError(f"{signal.shape} samples at {rate:g} Hz; {needed}")
    if not np.isfinite(signal).all():
        raise ValueError("the signal holds a sample that is not finite")
    return signal


def local_mean_power(power: Array, block: int) -> Array:
    """Mean power (…, F) of the noise under the lines of spectra of that `power` (…, F), log-linear between the medians
    of half-overlapping blocks of `block` components.

    The median of an exponential distribution is ln 2 times its mean.
    """
    size = power.shape[-1]
    block = min(max(2, block), size)
    hop = max(1, block // 2)
    starts = np.arange(0, size - block + 1, hop)
    medians = np.median(np.lib.stride_tricks.sliding_window_view(power, block, axis=-1)[..., ::hop, :], axis=-1)
    tiny = np.finfo(np.float64).tiny
    levels = np.log(np.maximum(medians / MEDIAN_OVER_MEAN, tiny))
    return np.exp(_linear_between(starts + 0.5 * (block - 1), levels, size))


def over_floor(power: Array, block: int) -> Array:
    """Power (B, F) of spectra over its local mean, taken from blocks of `block` components; 0 at 0 Hz, which is no
    line.

    Where a signal that repeats itself has nothing between its lines, rounding is the floor.
    """
    least = np.maximum(ROUNDING * power.mean(axis=-1, keepdims=True), np.finfo(np.float64).tiny)
    excess = np.zeros_like(power)
    excess[:, 1:] = power[:, 1:] / np.maximum(local_mean_power(power[:, 1:], block), least)
    return excess


def _linear_between(centres: Array, levels: Array, size: int) -> Array:
    """`levels` (…, B) at `centres` (B,), read at 0 … size − 1; constant beyond the ends."""
    if centres.size == 1:
        return np.broadcast_to(levels, (*levels.shape[:-1], size))
    place = np.interp(np.arange(size), centres, np.arange(centres.size))
    left = np.minimum(place.astype(np.int64), centres.size - 2)
    share = place - left
    return np.asarray(levels[..., left] * (1.0 - share) + levels[..., left + 1] * share)


def _flattened(spectrum: ComplexArray) -> ComplexArray:
    power = np.abs(spectrum) ** 2
    local = local_mean_power(power, max(FEWEST_BINS, spectrum.size // BLOCKS))
    # A stretch of exact silence (a filter's stop band) stays silent instead of being raised to noise.
    local = np.maximum(local, 1e-12 * power.mean())
    excess = power / local
    return spectrum / np.sqrt(local) / np.sqrt(np.maximum(excess / TONE_CEILING, 1.0))
