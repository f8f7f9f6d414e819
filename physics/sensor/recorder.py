"""The analogue-to-digital converter: a range, a number of bits, and what does not fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.checks import require_count, require_positive

FEWEST_BITS, MOST_BITS = 2, 32


@dataclass(frozen=True)
class Recorder:
    """A converter of `bits` over −`full_scale` to `full_scale` (m/s²).

    InvalidParameter unless the full scale is above 0 and there are 2 to 32 bits.
    """

    full_scale: float
    bits: int = 16

    def __post_init__(self) -> None:
        require_positive("full_scale", self.full_scale, "m/s²", what="recorder range")
        require_count("bits", self.bits, FEWEST_BITS, MOST_BITS, what="recorder bits")

    @property
    def step(self) -> float:
        """Distance between two recorded values, m/s²: 2 full_scale / 2^bits."""
        return float(2.0 * self.full_scale / 2.0**self.bits)


def recorded(recorder: Recorder, signal: Array) -> tuple[Array, float]:
    """The `signal` (T, 2) rounded to the nearest step and clipped to the range, m/s², and the share of clipped samples.

    The codes are those of two's complement, −2^(bits − 1) to 2^(bits − 1) − 1; halves go to the even code.
    """
    codes = np.round(signal / recorder.step)
    most = 2.0 ** (recorder.bits - 1)
    kept = np.clip(codes, -most, most - 1.0)
    return kept * recorder.step, float(np.mean(kept != codes))
