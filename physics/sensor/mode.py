"""A resonance between bearing and sensor: a mass on a spring that the outer ring shakes and that does not push back.

With z the stretch of the spring, z̈ + 2ζω ż + ω² z = −ẍo, the mass accelerates at −(2ζω ż + ω² z), times a gain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from physics.checks import require_between, require_finite, require_positive

Array = NDArray[np.float64]

HIGHEST_DAMPING = 0.7
# Acceleration over one sample interval is a cubic in the share τ of it: coefficients of 1, τ, τ², τ³.
CUBIC = 4


@dataclass(frozen=True)
class SensorMode:
    """A resonance of `frequency` (Hz), `damping` (share of critical) and `gain` (1: the mass itself is measured)."""

    frequency: float
    damping: float
    gain: float = 1.0

    def __post_init__(self) -> None:
        require_positive("frequency", self.frequency, "Hz")
        require_between("damping", self.damping, 0.0, HIGHEST_DAMPING)
        require_positive("damping", self.damping)
        require_finite("gain", self.gain)


def mode_accelerations(
    modes: Sequence[SensorMode], displacement: Array, velocity: Array, acceleration: Array, rate: float
) -> Array:
    """Sum of the modes' accelerations (T, 2), m/s², at rest at t = 0, from the outer ring's motion (T, 2) at `rate`.

    Exact for the motion between two samples that is the polynomial of degree 5 through displacement (m), velocity
    (m/s) and acceleration (m/s²) at both, so that a push that ends between samples keeps its size. InvalidParameter if
    a resonance does not lie below half the rate.
    """
    push = _cubics(displacement, velocity, acceleration, 1.0 / rate)
    return sum((_driven(mode, push, rate) for mode in modes), np.zeros_like(acceleration))


def _driven(mode: SensorMode, push: Array, rate: float) -> Array:
    """Acceleration (T, 2) of one mode under the cubics (4, T − 1, 2) of the outer ring's acceleration."""
    from scipy.signal import lfilter

    require_below_nyquist(mode.frequency, rate)
    transition, response = _discretised(mode, 1.0 / rate)
    omega = 2.0 * math.pi * mode.frequency
    read = -np.array([omega**2, 2.0 * mode.damping * omega])
    trace, determinant = float(np.trace(transition)), float(np.linalg.det(transition))
    now, before = -read @ response, -(read @ transition - trace * read) @ response
    source = np.zeros((push.shape[1] + 1, 2))
    for power in range(CUBIC):
        source[1:] += now[power] * push[power]
        source[2:] += before[power] * push[power, :-1]
    return mode.gain * np.asarray(lfilter([1.0], [1.0, -trace, determinant], source, axis=0))


def require_below_nyquist(frequency: float, rate: float) -> None:
    """Raise InvalidParameter unless `frequency` (Hz) lies below half the `rate` (Hz)."""
    require_positive("rate", rate, "Hz")
    require_between("frequency", frequency, 0.0, np.nextafter(rate / 2.0, 0.0), "Hz")


def _cubics(displacement: Array, velocity: Array, acceleration: Array, step: float) -> Array:
    """Coefficients (4, T − 1, 2) of the acceleration, m/s², over each interval, from its quintic displacement."""
    travel = (displacement[1:] - displacement[:-1]) / step**2
    start, stop = velocity[:-1] / step, velocity[1:] / step
    early, late = acceleration[:-1], acceleration[1:]
    third = 10.0 * travel - 6.0 * start - 4.0 * stop - 1.5 * early + 0.5 * late
    fourth = -15.0 * travel + 8.0 * start + 7.0 * stop + 1.5 * early - late
    fifth = 6.0 * travel - 3.0 * (start + stop) - 0.5 * (early - late)
    return np.stack([early, 6.0 * third, 12.0 * fourth, 20.0 * fifth])


def _discretised(mode: SensorMode, step: float) -> tuple[Array, Array]:
    """Transition (2, 2) of stretch and its rate over one step, and what unit coefficients of the push add (2, 4)."""
    omega = 2.0 * math.pi * mode.frequency
    system = np.zeros((2 + CUBIC, 2 + CUBIC))
    system[0, 1] = step
    system[1, 0] = -(omega**2) * step
    system[1, 1] = -2.0 * mode.damping * omega * step
    system[1, 2] = step
    for power in range(CUBIC - 1):
        system[2 + power, 3 + power] = 1.0
    flow = expm(system)
    # The chain of integrators behind the push holds τ^m / m!, so the coefficient of τ^m enters it as m!.
    factorial = np.array([math.factorial(power) for power in range(CUBIC)], dtype=np.float64)
    return flow[:2, :2], flow[:2, 2:] * factorial
