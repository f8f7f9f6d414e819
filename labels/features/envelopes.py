"""Squared envelope spectra of a tree of bands, over their local noise floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from labels.band_tree import band_edges
from labels.features.conditioning import Conditioned, over_floor
from labels.features.known_lines import mains_components
from labels.features.turning import Turning
from labels.squared_envelope import excess_kurtosis, squared_envelope
from labels.window import periodic_hann
from physics.arrays import Array, ComplexArray

ENVELOPE_HARMONICS = 4.0
# Share of the bandwidth above which no band has lines of an envelope.
HIGHEST_SHARE = 0.45
# Shaft orders over which the floor is taken, and how many components these are at least.
FLOOR_ORDERS = 3.0
FEWEST_FLOOR_BINS = 16
# Share of a band's width up to which enough pairs of its frequencies lie that far apart.
FULL_SHARE = 0.85


@dataclass(frozen=True)
class EnvelopeSpectra:
    """Squared envelope spectra of B bands on one axis of frequencies, `step` Hz apart from 0.

    `excess` (B, F) is power over the local mean noise power; `depth` (B, F) the amplitude of each component over the
    mean square envelope (the depth of modulation); `kurtosis` (B,) that of the band's complex signal, 0 for noise;
    `edges` (B, 2) in shares of the bandwidth.
    """

    step: float
    excess: Array
    depth: Array
    kurtosis: Array
    edges: Array


def envelope_spectra(record: Conditioned, shaft_hz: float, top_hz: float, narrowest: float) -> EnvelopeSpectra:
    """Envelope spectra of the flattened record up to `top_hz`, of bands no narrower than `narrowest` (Hz).

    A band holds no difference of frequencies above its width; there the spectrum is set to its floor.

    The floor is the median over stretches of three shaft orders, so it follows the slow fall of an envelope spectrum
    and passes under lines. Where the speed changes, they are spectra over the angle turned, and mains, which is no line
    then, is taken out before.
    """
    edges = band_edges(record.bandwidth, narrowest)
    count = max(FEWEST_FLOOR_BINS, int(top_hz / record.step) + 1)
    power = np.zeros((len(edges), count))
    square_mean, kurtosis = np.zeros(len(edges)), np.zeros(len(edges))
    for band, (low, high) in enumerate(edges):
        inside = record.flat[int(low * record.flat.size) : int(high * record.flat.size)]
        power[band], square_mean[band], kurtosis[band] = _envelope_lines(inside, count, record)
    block = max(FEWEST_FLOOR_BINS, int(FLOOR_ORDERS * shaft_hz / record.step))
    excess = over_floor(power, block)
    widths = (edges[:, 1] - edges[:, 0]) * record.bandwidth
    beyond = np.arange(count) * record.step > FULL_SHARE * widths[:, None]
    excess[beyond] = 1.0
    depth = np.sqrt(power) / square_mean[:, None]
    depth[:, 0] = 0.0
    return EnvelopeSpectra(record.step, excess, depth, kurtosis, edges)


def _envelope_lines(inside: ComplexArray, count: int, record: Conditioned) -> tuple[Array, float, float]:
    """One-sided power (count,) of the Hann-windowed squared envelope of a band's Fourier components, the mean of that
    envelope, and the excess kurtosis of their signal."""
    square = squared_envelope(inside, 2 * max(inside.size, count))
    mean = float(square.mean())
    course = square - mean
    if record.turning is not None:
        course = _at_even_angles(course, count, record.step, record.turning)
    lines = np.asarray(fft.rfft(course * periodic_hann(course.size)))[:count] * (2.0 / course.size)
    return np.abs(lines) ** 2, max(mean, float(np.finfo(np.float64).tiny)), excess_kurtosis(square)


def _at_even_angles(course: Array, count: int, step: float, turning: Turning) -> Array:
    """An envelope's `course` over the record seen at even angles of the shaft, without what the mains does to it."""
    spectrum = np.asarray(fft.rfft(course))
    spectrum[mains_components(spectrum.size, step)] = 0.0
    return turning.evenly(spectrum, course.size, count)
