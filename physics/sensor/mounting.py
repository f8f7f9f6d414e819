"""How the sensor is fixed: a low-pass that a real mounting (wax, magnet, stud) puts on everything above its cutoff."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physics.arrays import Array
from physics.checks import require_below_nyquist, require_count, require_positive
from physics.recursive_filter import Section, filtered

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
    mounting.check_rate(rate)
    return filtered(signal, _sections(mounting, rate))


def _sections(mounting: Mounting, rate: float) -> list[Section]:
    """The sections of the filter, the most damped first.

    The pole of an odd order is 1 / (s + 1), each pair 1 / (s² + 2ζ s + 1) with ζ = sin(π (2k + 1) / 2n), and s the
    bilinear form (1 − z⁻¹) / (1 + z⁻¹) over tan(π cutoff / rate).
    """
    edge = math.tan(math.pi * mounting.cutoff / rate)
    sections: list[Section] = []
    if mounting.order % 2:
        share = edge / (1.0 + edge)
        sections.append(((share, share, 0.0), ((edge - 1.0) / (edge + 1.0), 0.0)))
    for pair in reversed(range(mounting.order // 2)):
        damped = 2.0 * math.sin(math.pi * (2 * pair + 1) / (2 * mounting.order)) * edge
        whole = 1.0 + damped + edge**2
        share, back = edge**2 / whole, (2.0 * (edge**2 - 1.0) / whole, (1.0 - damped + edge**2) / whole)
        sections.append(((share, 2.0 * share, share), back))
    return sections
