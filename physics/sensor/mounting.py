"""How the sensor is fixed: a low-pass that a real mounting (wax, magnet, stud) puts on everything above its cutoff."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.checks import require_below_nyquist, require_count, require_positive

HIGHEST_ORDER = 12


@dataclass(frozen=True)
class Mounting:
    """A Butterworth low-pass of `order` with −3 dB at `cutoff` (Hz); the fan rig's: order 6 at 11 kHz [P14 §6.2].

    InvalidParameter unless the cutoff is above 0 and the order a whole number from 1 to 12.
    """

    cutoff: float
    order: int = 6

    def __post_init__(self) -> None:
        require_positive("cutoff", self.cutoff, "Hz", what="mounting cutoff")
        require_count("order", self.order, 1, HIGHEST_ORDER, what="mounting order")

    def check_rate(self, rate: float) -> None:
        """Raise InvalidParameter unless the cutoff lies below half the sampling `rate` (Hz)."""
        require_below_nyquist("cutoff", self.cutoff, rate, what="mounting cutoff")


def mounted(mounting: Mounting, signal: Array, rate: float) -> Array:
    """The `signal` (T, 2) at `rate` (Hz) after the mounting, in its own unit.

    Causal, like the mounting itself: nothing rings before an impact, and low frequencies come later, by
    1 / (2 rate tan(π cutoff / rate) sin(π / 2n)): 51 µs for order 6 at 11 kHz and 65 536 Hz. The analogue filter in its
    bilinear form, exact at the cutoff. InvalidParameter if the cutoff does not lie below half the rate.
    """
    from scipy.signal import butter, sosfilt

    mounting.check_rate(rate)
    sections = butter(mounting.order, mounting.cutoff, fs=rate, output="sos")
    return np.asarray(sosfilt(sections, signal, axis=0))
