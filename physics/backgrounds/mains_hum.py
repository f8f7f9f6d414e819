"""Mains hum: the grid's frequency and its harmonics, from cables and motors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.backgrounds.tones import draw_phases, tones
from physics.checks import require_not_negative, require_positive, settle_tuples


@dataclass(frozen=True)
class MainsHum:
    """Tones at whole multiples of the mains `frequency` (Hz), of `amplitudes` (m/s²) on each axis, the first at it.

    InvalidParameter unless the frequency is above 0 and no amplitude below it.
    """

    frequency: float
    amplitudes: tuple[float, ...]

    def __post_init__(self) -> None:
        settle_tuples(self, "amplitudes")
        require_positive("frequency", self.frequency, "Hz", what="mains frequency")
        for amplitude in self.amplitudes:
            require_not_negative("amplitudes", amplitude, "m/s²", what="hum amplitude")


def mains_hum(generator: np.random.Generator, layer: MainsHum, samples: int, rate: float) -> Array:
    """The hum (T, 2), m/s²; draws one phase a harmonic and axis.

    Harmonics at or above half the `rate` (Hz) are left out.
    """
    frequency = layer.frequency * np.arange(1, len(layer.amplitudes) + 1, dtype=np.float64)
    phase = draw_phases(generator, frequency.size)
    return tones(frequency, np.array(layer.amplitudes), phase, samples, rate)
