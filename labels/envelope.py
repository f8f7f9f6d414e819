"""Envelope analysis: the demodulation band, the envelope of the band-passed signal and its squared spectrum."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from labels.band import Band, components_in
from labels.spectrum import amplitude_spectrum
from physics.arrays import Array
from physics.modes import coupled_resonator_frequency, rated_matrices
from physics.rig import Rig

BAND_SHARE = 0.05
FALLBACK_SHARES = (0.3, 0.45)


def resonance_band(rig: Rig) -> Band:
    """Lower and upper edge (Hz) of the band around the rig's coupled resonator mode in the y direction, ± 5 %.

    The mode is that of the healthy bearing at the rig's rated load.
    """
    stiffness, _ = rated_matrices(rig)
    centre = coupled_resonator_frequency(rig, stiffness)
    return centre * (1.0 - BAND_SHARE), centre * (1.0 + BAND_SHARE)


def default_band(rig: Rig, rate: float) -> Band:
    """Lower and upper edge (Hz) of the band of a recording at `rate` (Hz) of a machine like `rig`: `resonance_band`.

    If that band does not lie below half the sampling `rate` (Hz), the mode is not in the record and the band is
    0.3 to 0.45 of the rate: the upper part of what was recorded, clear of the roll-off before half the rate.
    """
    low, high = resonance_band(rig)
    if high < rate / 2.0:
        return low, high
    return FALLBACK_SHARES[0] * rate, FALLBACK_SHARES[1] * rate


def band_envelope(signal: Array, rate: float, band: Band) -> Array:
    """Envelope (T,), in the unit of the `signal` (T,): magnitude of its analytic signal in `band` (Hz, edges included).

    The filter keeps the Fourier components of the whole record that lie in the band and drops the others, so it has no
    phase and no delay; the record counts as periodic, which touches the first and last 1/(width of the band) seconds.
    ValueError unless 0 ≤ low < high ≤ rate / 2 and the band holds at least one component.
    """
    signal = np.asarray(signal, dtype=np.float64)
    inside = components_in(band, signal.size, rate)
    if inside.start == inside.stop:
        raise ValueError(
            f"band {band[0]:g} to {band[1]:g} Hz holds no component of {signal.size} samples at {rate:g} Hz, "
            f"which lie {rate / signal.size:g} Hz apart"
        )
    place = np.arange(inside.start, inside.stop)
    both_signs = (place > 0) & (2 * place < signal.size)
    analytic = np.zeros(signal.size, dtype=np.complex128)
    analytic[inside] = fft.rfft(signal)[inside] * np.where(both_signs, 2.0, 1.0)
    return np.abs(fft.ifft(analytic))


def stored_envelope(signal: NDArray[np.float32], rate: float, band: Band) -> NDArray[np.float32]:
    """The variable `envelope` (T,) of a record whose stored y axis is `signal` (T,): its `band_envelope`, rounded."""
    return band_envelope(signal.astype(np.float64), rate, band).astype(np.float32)


def squared_envelope_spectrum(envelope: Array, rate: float) -> tuple[Array, Array]:
    """Frequencies (F,) in Hz and one-sided amplitudes (F,) of the squared `envelope` (T,) without its mean.

    The unit is the square of the envelope's. A squared envelope m + a cos(2π f t) has a line of height a at f.
    ValueError as `amplitude_spectrum`.
    """
    return amplitude_spectrum(np.asarray(envelope, dtype=np.float64) ** 2, rate)
