"""Pink noise: the floor of a machine that rises towards low frequencies."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.checks import require_below_nyquist, require_between, require_not_negative, require_positive

STEEPEST = 3.0


@dataclass(frozen=True)
class PinkNoise:
    """Noise whose power density falls as frequency to −`slope`, of `rms` (m/s²) from `lowest` (Hz) to half the rate.

    InvalidParameter unless `rms` is not below 0, `lowest` above 0 and `slope` from 0 to 3.
    """

    rms: float
    lowest: float = 1.0
    slope: float = 1.0

    def __post_init__(self) -> None:
        require_not_negative("rms", self.rms, "m/s²", what="pink rms")
        require_positive("lowest", self.lowest, "Hz", what="pink lowest frequency")
        require_between("slope", self.slope, 0.0, STEEPEST, what="pink slope")

    def check_rate(self, rate: float) -> None:
        """Raise InvalidParameter unless the lowest frequency lies below half the sampling `rate` (Hz)."""
        require_below_nyquist("lowest", self.lowest, rate, what="pink lowest frequency")


def pink_noise(generator: np.random.Generator, noise: PinkNoise, samples: int, rate: float) -> Array:
    """Gaussian noise (T, 2), m/s², with nothing below the lowest frequency, the two axes independent.

    Draws `samples` × 2 standard normal numbers and weighs their discrete Fourier transform with the square root of
    density × rate / 2: the density belongs to the machine, whatever the length of the record. InvalidParameter if the
    lowest frequency does not lie below half the `rate` (Hz).
    """
    noise.check_rate(rate)
    white = np.fft.rfft(generator.standard_normal((samples, 2)), axis=0)
    frequency = np.asarray(np.fft.rfftfreq(samples, 1.0 / rate), dtype=np.float64)
    weight = np.sqrt(pink_density(noise, frequency, rate) * rate / 2.0)
    return np.asarray(np.fft.irfft(weight[:, None] * white, samples, axis=0))


def pink_density(noise: PinkNoise, frequency: Array, rate: float) -> Array:
    """One-sided power density (F,), (m/s²)²/Hz, at `frequency` (F,) Hz: its integral up to rate / 2 is rms².

    InvalidParameter if the lowest frequency does not lie below half the `rate` (Hz).
    """
    noise.check_rate(rate)
    low, high, power = noise.lowest, rate / 2.0, 1.0 - noise.slope
    area = math.log(high / low) if abs(power) < 1e-9 else (high**power - low**power) / power
    inside = frequency >= low
    return np.where(inside, noise.rms**2 / area * np.where(inside, frequency, 1.0) ** -noise.slope, 0.0)
