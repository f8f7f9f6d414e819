"""A resonance between bearing and sensor: a mass on a spring that the outer ring shakes and that does not push back.

With z the stretch of the spring, z̈ + 2ζω ż + ω² z = −ẍo, the mass accelerates at −(2ζω ż + ω² z), times a gain.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm

from physics._jit import njit, njit_inline
from physics.arrays import Array
from physics.checks import HIGHEST_DAMPING, require_below_nyquist, require_finite, require_positive, require_up_to
from physics.trace import OuterMotion

# Acceleration over one sample interval is a cubic in the share τ of it: coefficients of 1, τ, τ², τ³.
CUBIC = 4


@dataclass(frozen=True)
class SensorMode:
    """A resonance of `frequency` (Hz), `damping` (share of critical) and `gain` (1: the mass itself is measured).

    InvalidParameter unless the frequency is above 0, the damping above 0 and 0.7 at most, and the gain finite.
    """

    frequency: float
    damping: float
    gain: float = 1.0

    def __post_init__(self) -> None:
        require_positive("frequency", self.frequency, "Hz", what="sensor resonance")
        require_up_to("damping", self.damping, HIGHEST_DAMPING, what="sensor damping")
        require_finite("gain", self.gain)

    def check_rate(self, rate: float) -> None:
        """Raise InvalidParameter unless the resonance lies below half the sampling `rate` (Hz)."""
        require_below_nyquist("frequency", self.frequency, rate, what="sensor resonance")


def mode_accelerations(modes: Sequence[SensorMode], outer: OuterMotion) -> Array:
    """Sum of the modes' accelerations (R, 2), m/s², at rest at t = 0, from the motion of the `outer` ring.

    Exact for the motion between two samples that is the polynomial of degree 5 through displacement, velocity and
    acceleration at both, so that a push that ends between samples keeps its size. InvalidParameter if a resonance does
    not lie below half the rate of the motion.
    """
    for mode in modes:
        mode.check_rate(outer.rate)
    step = 1.0 / outer.rate
    steps = [_discretised(mode, step) for mode in modes]
    total = np.zeros_like(outer.acceleration)
    _carry_modes(
        np.ascontiguousarray(outer.displacement),
        np.ascontiguousarray(outer.velocity),
        np.ascontiguousarray(outer.acceleration),
        step,
        np.array([transition for transition, _ in steps]).reshape(-1, 2, 2),
        np.array([response for _, response in steps]).reshape(-1, 2, CUBIC),
        np.array([_reading(mode) for mode in modes]).reshape(-1, 2),
        total,
    )
    return total


@njit
def _carry_modes(
    displacement: Array,
    velocity: Array,
    acceleration: Array,
    step: float,
    transition: Array,
    response: Array,
    reading: Array,
    total: Array,
) -> None:
    """Add to `total` (T, 2) what M modes read while the outer ring moves from sample to sample.

    `transition` (M, 2, 2) and `response` (M, 2, 4) of lag and rate over a step, `reading` (M, 2) of both: the lag is
    how far a mass stays behind the ring, −z.
    """
    state = np.zeros((transition.shape[0], 2, 2))
    for k in range(total.shape[0] - 1):
        for axis in range(2):
            first, second, third, fourth = _cubic(displacement, velocity, acceleration, step, k, axis)
            for mode in range(transition.shape[0]):
                lag, rate = state[mode, axis, 0], state[mode, axis, 1]
                for part in range(2):
                    w = response[mode, part]
                    state[mode, axis, part] = (transition[mode, part, 0] * lag + transition[mode, part, 1] * rate) + (
                        w[0] * first + w[1] * second + w[2] * third + w[3] * fourth
                    )
                lag, rate = state[mode, axis, 0], state[mode, axis, 1]
                total[k + 1, axis] += reading[mode, 0] * lag + reading[mode, 1] * rate


@njit_inline
def _cubic(
    displacement: Array, velocity: Array, acceleration: Array, step: float, k: int, axis: int
) -> tuple[float, float, float, float]:
    """Coefficients of 1, τ, τ², τ³ of the acceleration, m/s², over interval `k`, from its quintic displacement."""
    travel = (displacement[k + 1, axis] - displacement[k, axis]) / step**2
    start, stop = velocity[k, axis] / step, velocity[k + 1, axis] / step
    early, late = acceleration[k, axis], acceleration[k + 1, axis]
    third = 10.0 * travel - 6.0 * start - 4.0 * stop - 1.5 * early + 0.5 * late
    fourth = -15.0 * travel + 8.0 * start + 7.0 * stop + 1.5 * early - late
    fifth = 6.0 * travel - 3.0 * (start + stop) - 0.5 * (early - late)
    return early, 6.0 * third, 12.0 * fourth, 20.0 * fifth


def _reading(mode: SensorMode) -> Array:
    """What lag and its rate (2,) add to the mode's acceleration, gain included."""
    omega = 2.0 * math.pi * mode.frequency
    return mode.gain * np.array([omega**2, 2.0 * mode.damping * omega])


def _discretised(mode: SensorMode, step: float) -> tuple[Array, Array]:
    """Transition (2, 2) of lag and its rate over one step, and what unit coefficients of the push add (2, 4)."""
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
