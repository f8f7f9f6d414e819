"""Harmonics of the shaft: unbalance, misalignment, looseness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.angular_speed import in_hertz
from physics.arrays import Array
from physics.backgrounds.tones import draw_phases, tones
from physics.checks import require_count, require_not_negative, settle_tuples

HIGHEST_ORDER = 1000


@dataclass(frozen=True)
class ShaftHarmonics:
    """Tones at whole multiples of the shaft's frequency from `first_order` on, of `amplitudes` (m/s²) on each axis.

    InvalidParameter unless the first order is a whole number from 1 to 1000 and no amplitude below 0.
    """

    amplitudes: tuple[float, ...]
    first_order: int = 1

    def __post_init__(self) -> None:
        settle_tuples(self, "amplitudes")
        require_count("first_order", self.first_order, 1, HIGHEST_ORDER, what="first order")
        for amplitude in self.amplitudes:
            require_not_negative("amplitudes", amplitude, "m/s²", what="shaft harmonic amplitude")


def shaft_harmonics(
    generator: np.random.Generator, layer: ShaftHarmonics, shaft_speed: float, samples: int, rate: float
) -> Array:
    """The tones (T, 2), m/s², of a shaft at `shaft_speed` (rad/s); draws one phase an order and axis.

    Orders at or above half the `rate` (Hz) are left out.
    """
    orders = layer.first_order + np.arange(len(layer.amplitudes), dtype=np.float64)
    phase = draw_phases(generator, orders.size)
    return tones(in_hertz(orders * shaft_speed), np.array(layer.amplitudes), phase, samples, rate)
