"""The mean ball pass: energy in bands, and the waveform itself, against the time from the anchor."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from labels.spall_size.signal.alignment import Alignment
from labels.spall_size.signal.divisors import divisor
from physics.arrays import Array

# Edges of the bands as shares of the sampling rate: below 2 kHz, to 8 kHz and above at 65 536 Hz. The first two hold
# the entry.
BAND_EDGES = (0.03, 0.12)
# Periods before and after the anchor that a mean pass holds.
REACH = 1.1
# Standard deviation of the blur of the sway, samples.
SWAY_BLUR = 4.0
# Points of one period from which the displacement is made.
GIVE_POINTS = 4096


class Channel(IntEnum):
    """Which row of `energy`: the whole prewhitened signal, or one of its bands; `word` names it in columns."""

    ALL = 0
    LOW = 1
    MIDDLE = 2
    HIGH = 3

    @property
    def word(self) -> str:
        """The name in small letters."""
        return self.name.lower()


@dataclass(frozen=True)
class MeanPass:
    """Weighted means over the passes at `offset` (S,) samples from the anchor, from −1.1 to 1.1 periods.

    `energy` (4, S), a row a Channel: of the prewhitened signal, each over its own median in the record;
    `waveform` (S,): the prewhitened signal itself; `sway` (S,): the signal before it was prewhitened, blurred by four
    samples, in units of `sway_unit`; `give` (S,): the displacement that goes with the sway, in units of `give_unit`;
    both units are standard deviations, the latter in the signal's unit times samples². `passes`: how many passes there
    are in effect; `period` samples.
    """

    offset: NDArray[np.int64]
    energy: Array
    waveform: Array
    sway: Array
    sway_unit: float
    give: Array
    give_unit: float
    passes: float
    period: float

    def around(self, place: Array, reach: int) -> NDArray[np.int64]:
        """Numbers (P, 2 reach + 1) of the samples round each `place` (P,), samples from the anchor; those beyond an end
        are that of the end."""
        centre = np.round(place).astype(np.int64) - self.offset[0]
        return np.clip(centre[:, None] + np.arange(-reach, reach + 1), 0, self.offset.size - 1)


def mean_pass(signal: Array, whitened: Array, alignment: Alignment, period: float) -> MeanPass:
    """The mean pass of `signal` (T,) and of `whitened` (T,), the same prewhitened; `period` in samples."""
    reach = int(np.ceil(REACH * period))
    offset = np.arange(-reach, reach + 1)
    anchor = np.round(alignment.place).astype(np.int64)
    place = anchor[:, None] + offset
    inside = (place >= 0) & (place < whitened.size)
    weight = alignment.weight[:, None] * inside
    total = np.maximum(weight.sum(axis=0), 1e-12)
    place = np.clip(place, 0, whitened.size - 1)
    channels = [whitened**2, *(band**2 for band in _bands(whitened))]
    energy = [(weight * channel[place]).sum(axis=0) / total / _floor(channel) for channel in channels]
    waveform, sway = ((weight * source[place]).sum(axis=0) / total for source in (whitened, signal))
    effective = float(alignment.weight.sum() ** 2 / max((alignment.weight**2).sum(), 1e-12))
    sway = gaussian_filter1d(sway, SWAY_BLUR)
    give = _give(sway, offset, period)
    return MeanPass(offset, np.array(energy), waveform, *_standardised(sway), *_standardised(give), effective, period)


def _standardised(curve: Array) -> tuple[Array, float]:
    unit = divisor(curve.std())
    return np.asarray((curve - curve.mean()) / unit), unit


def _give(sway: Array, offset: NDArray[np.int64], period: float) -> Array:
    """The periodic displacement (S,), in samples² times the unit of `sway` (S,), one period of which accelerates it."""
    phase = np.arange(GIVE_POINTS) / GIVE_POINTS
    period_of_sway = np.interp((phase - 0.5) * period, offset, sway)
    spectrum = np.fft.rfft(period_of_sway)
    turn = 2.0 * math.pi * np.arange(spectrum.size) / period
    spectrum[1:] /= -(turn[1:] ** 2)
    spectrum[0] = 0.0
    return np.interp(offset / period + 0.5, phase, np.fft.irfft(spectrum, GIVE_POINTS), period=1.0)


def _bands(whitened: Array) -> list[Array]:
    """The signal (T,) in each band, without phase shift; Gaussian edges do not ring, so what is quiet stays quiet."""
    spectrum = np.fft.rfft(whitened)
    share = np.fft.rfftfreq(whitened.size)
    below = [np.ones_like(share), *(np.exp(-0.5 * (share / edge) ** 2) for edge in reversed(BAND_EDGES)), 0.0 * share]
    bands = [below[k] - below[k + 1] for k in range(3)]
    return [np.fft.irfft(band * spectrum, whitened.size) for band in reversed(bands)]


def _floor(energy: Array) -> float:
    return divisor(np.median(energy))
