"""The cage's path in continuous time: slip drawn once, read alike by every method, step and sample rate."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from physics.arrays import Array
from physics.checks import (
    require,
    require_angle,
    require_between,
    require_finite,
    require_not_negative,
    require_positive,
    settle_tuples,
)

KNOTS_PER_CORRELATION_TIME = 4
MOST_KNOTS = 10_000_000  # about two gigabytes and half a minute of work
LARGEST_MEAN_SLIP, LARGEST_SLIP = 0.2, 0.5
INTERPOLATION_RULE = (
    "slip s(t) is the natural cubic spline through the knots (scipy.interpolate.CubicSpline(t, s, bc_type='natural')); "
    "cage speed = nominal_speed * (1 - mean_slip + s(t)); cage angle = phi_c0 + integral of the cage speed from t = 0"
)


@dataclass(frozen=True)
class CagePath:
    """Cage angle φc(t) = φc(0) + ∫ ωc (1 − s̄ + s(t)) dt, rad, from t = 0 to `duration` (s).

    `knot_values` are s at the times `knot_start + k · knot_step`; none means constant slip s̄. This replaces [P14 Eq.
    3], whose random step depends on the solver's step. InvalidParameter unless speed and duration are above 0, s̄ lies
    within ±0.2, every knot within ±0.5, and the knots, if any, cover 0 to `duration`.
    """

    nominal_speed: float
    duration: float
    start_angle: float = 0.0
    mean_slip: float = 0.0
    knot_step: float = 0.0
    knot_start: float = 0.0
    knot_values: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        settle_tuples(self, "knot_values")
        require_positive("nominal_speed", self.nominal_speed, "rad/s")
        require_positive("duration", self.duration, "s")
        require_angle("start_angle", self.start_angle)
        require_between("mean_slip", self.mean_slip, -LARGEST_MEAN_SLIP, LARGEST_MEAN_SLIP)
        if self.knot_values:
            self._check_knots()

    def _check_knots(self) -> None:
        require_positive("knot_step", self.knot_step, "s")
        require_finite("knot_start", self.knot_start, "s")
        self._require_known_slip(self.knot_start + self.knot_step * (len(self.knot_values) - 1))
        for slip in self.knot_values:
            if not abs(slip) <= LARGEST_SLIP:
                require_between("knot_values", slip, -LARGEST_SLIP, LARGEST_SLIP)

    def _require_known_slip(self, last: float) -> None:
        require(
            self.knot_start <= 0.0 and last >= self.duration,
            f"slip knots cover {self.knot_start:g} to {last:g} s; they must cover 0 to {self.duration:g} s",
            "knot_values",
        )

    def going_on(self, seconds: float) -> CagePath:
        """The same path for so many seconds longer, behind its last knot at the speed that it has there."""
        settings = {field.name: getattr(self, field.name) for field in fields(self)}
        return LongerPath(**settings | {"duration": self.duration + seconds})

    @property
    def mean_speed(self) -> float:
        """Cage speed without the random part, rad/s."""
        return self.nominal_speed * (1.0 - self.mean_slip)

    @cached_property
    def fastest(self) -> float:
        """Largest cage speed between 0 and `duration`, rad/s: at an end, or at a maximum between."""
        if not self.knot_values:
            return self.mean_speed
        turns = self.polynomial.derivative(2).roots(discontinuity=False, extrapolate=False)
        inside = turns[(turns > 0.0) & (turns < self.duration)]
        return float(self.speed(np.concatenate([[0.0, self.duration], inside])).max())

    @cached_property
    def knot_times(self) -> Array:
        """Times of the knots, shape (K,), s."""
        return self.knot_start + self.knot_step * np.arange(len(self.knot_values), dtype=np.float64)

    @cached_property
    def polynomial(self) -> PPoly:
        """The angle as a piecewise polynomial in time (rad); one piece between each two knots."""
        return self._polynomial()

    def _polynomial(self) -> PPoly:
        if not self.knot_values:
            straight = np.array([[self.mean_speed], [self.start_angle]])
            return PPoly(straight, np.array([0.0, self.duration]), extrapolate=True)
        slip = CubicSpline(self.knot_times, np.array(self.knot_values), bc_type="natural")
        speed = PPoly(self.nominal_speed * slip.c, slip.x)
        speed.c[-1] += self.mean_speed
        angle = speed.antiderivative()
        angle.c[-1] += self.start_angle - float(angle(0.0))
        return angle

    def angle(self, time: Array) -> Array:
        """Unwrapped cage angle at `time` (T,), rad: the position of ball 1 of row 1."""
        return np.asarray(self.polynomial(time))

    def speed(self, time: Array) -> Array:
        """Cage speed at `time` (T,), rad/s."""
        return np.asarray(self.polynomial.derivative()(time))


@dataclass(frozen=True)
class LongerPath(CagePath):
    """A path that goes on behind its last knot, at the speed that it has there."""

    def _require_known_slip(self, last: float) -> None:
        """Its slip is known, however long it lasts."""

    def _polynomial(self) -> PPoly:
        """As that between the knots, with pieces as long behind the last one."""
        known = super()._polynomial()
        beyond = math.ceil((self.duration - known.x[-1]) / self.knot_step) if self.knot_values else 0
        if beyond <= 0:
            return known
        since = self.knot_step * np.arange(beyond)
        straight = np.zeros((known.c.shape[0], beyond))
        straight[-2] = known(known.x[-1], nu=1)
        straight[-1] = known(known.x[-1]) + straight[-2] * since
        edges = np.concatenate([known.x, known.x[-1] + since + self.knot_step])
        return PPoly(np.concatenate([known.c, straight], axis=1), edges, extrapolate=True)


@lru_cache(maxsize=16)
def slip_knot_scale(correlation: float) -> float:
    """Factor that gives the spline through unit-variance AR(1) knots of neighbour `correlation` unit mean variance."""
    # Over the middle one of forty intervals, in which neither end of the spline is felt.
    knots = np.arange(41)
    fine = np.linspace(20.0, 21.0, 65)[:-1] + 1.0 / 128.0
    weights = CubicSpline(knots, np.eye(knots.size), bc_type="natural")(fine)
    covariance = correlation ** np.abs(knots[:, None] - knots[None, :])
    variance = np.einsum("ti,ij,tj->t", weights, covariance, weights).mean()
    return 1.0 / math.sqrt(float(variance))


class SlipKnots(NamedTuple):
    """Knots of a slip as a `CagePath` takes them: their `step` (s), the time of the first (s), and their values (1)."""

    step: float
    start: float
    values: tuple[float, ...]


def draw_slip_knots(
    generator: np.random.Generator, deviation: float, correlation_time: float, duration: float, lead_in: float = 0.0
) -> SlipKnots:
    """Knots of a stationary slip with the stated standard `deviation` (1) and `correlation_time` (s).

    They cover −`lead_in` to `duration` (s). The knots are a first-order autoregressive (sampled Ornstein-Uhlenbeck)
    sequence, four per correlation time, scaled so that the spline through them has the stated deviation on average;
    they are rounded to 1e-12 so that their decimal text is exact. InvalidParameter unless correlation time and
    duration are above 0, neither deviation nor lead-in below it, and the knots fewer than MOST_KNOTS.
    """
    require_not_negative("deviation", deviation)
    require_positive("correlation_time", correlation_time, "s")
    require_positive("duration", duration, "s")
    require_not_negative("lead_in", lead_in, "s")
    step = correlation_time / KNOTS_PER_CORRELATION_TIME
    start = -2.0 * step - lead_in
    needed = (duration - start) / step
    require(
        needed < MOST_KNOTS,
        f"the slip needs {needed:.3g} knots, {KNOTS_PER_CORRELATION_TIME} for each correlation time of "
        f"{correlation_time:.3g} s over {duration - start:.3g} s; allowed: up to {MOST_KNOTS:.3g}",
        "correlation_time",
    )
    count = math.ceil(needed) + 3
    correlation = math.exp(-1.0 / KNOTS_PER_CORRELATION_TIME)
    noise = generator.standard_normal(count)
    values = np.empty(count)
    values[0] = noise[0]
    innovation = math.sqrt(1.0 - correlation**2)
    for k in range(1, count):
        values[k] = correlation * values[k - 1] + innovation * noise[k]
    values *= deviation * slip_knot_scale(correlation)
    return SlipKnots(step, start, tuple(float(v) for v in np.round(values, 12)))
