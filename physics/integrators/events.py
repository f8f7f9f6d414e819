"""Locating, inside a step, the instant at which a ball starts or stops touching.

Within a step the contact set is frozen, so the trial solution is smooth; between its ends the relative displacement is
the quintic through displacement, velocity and acceleration at both, and cage angle and depth are known exactly. The
earliest zero of the contact condition is bracketed and found by Newton's method or, where the condition has no slope to
go by, by the Illinois variant of false position.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_inner, njit_pasted
from physics.contact import ACTIVE, Law, compression_of, law_power, of_ball
from physics.contact_set import touches
from physics.motion import MotionModel, outer_load, relative_acceleration
from physics.track import Track

Array = NDArray[np.float64]

SMALLEST_SHARE = 1e-9
# Newton's method squares the error of a share this small away with its next correction.
SURE_SHARE = 1e-5
MOST_ITERATIONS, GUESS_ITERATIONS = 60, 3


@njit_inner
def relative_motion(
    motion: MotionModel, time: float, step: float, state: Array, force: tuple[float, float], ends: Array
) -> None:
    """Fill `ends` (3, 2): displacement, step · velocity and step² · acceleration of inner relative to outer ring."""
    load = outer_load(motion, time)
    for axis in range(2):
        ends[0, axis] = state[axis] - state[2 + axis]
        ends[1, axis] = step * (state[6 + axis] - state[8 + axis])
        ends[2, axis] = step * step * relative_acceleration(motion, state, axis, load[axis], force[axis])


@njit_inline
def quintic(begin: Array, end: Array, axis: int, x: float) -> tuple[float, float]:
    """Value, and derivative to the share x, of the quintic through both ends at the share `x` (0 to 1) of the step."""
    rise = end[0, axis] - begin[0, axis] - begin[1, axis] - 0.5 * begin[2, axis]
    speed = end[1, axis] - begin[1, axis] - begin[2, axis]
    bend = end[2, axis] - begin[2, axis]
    c3 = 10.0 * rise - 4.0 * speed + 0.5 * bend
    c4 = -15.0 * rise + 7.0 * speed - bend
    c5 = 6.0 * rise - 3.0 * speed + 0.5 * bend
    value = begin[0, axis] + x * (begin[1, axis] + x * (0.5 * begin[2, axis] + x * (c3 + x * (c4 + x * c5))))
    slope = begin[1, axis] + x * (begin[2, axis] + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))
    return value, slope


@njit_inline
def contact_condition(
    balls: Array, law: Law, track: Track, ball: int, time: float, step: float, share: float, begin: Array, end: Array
) -> tuple[float, float, float]:
    """A number above zero while `ball` touches, its slope over the share of the step or 0 if it is not known, and the
    rate of compression, m/s, at the `share` of the step."""
    x, u = quintic(begin, end, 0, share)
    y, v = quintic(begin, end, 1, share)
    compression, rate = compression_of(balls, track, ball, time + share * step, x, y, u / step, v / step)
    if law.no_tension:
        # Compression (m) is brought to the scale of a force so that one number carries both conditions.
        force = law.stiffness * max(compression, 0.0) * law_power(law, compression) + law.damping * rate
        return min(law.stiffness * 1e-3 * compression, force), 0.0, rate
    return compression, rate * step, rate


@njit_inner
def earliest_change(
    balls: Array, law: Law, track: Track, time: float, step: float, begin: Array, end: Array, suspects: Array
) -> tuple[float, int, float]:
    """Share of the step, number and rate of compression (m/s) of the ball that first contradicts the contact set.

    `suspects` (G, M) holds, per ball, the share of the step at which it was seen to contradict the set, or 0.
    Returns (2.0, −1, 0.0) if no suspect is confirmed.
    """
    first_share, first_ball, first_rate = 2.0, -1, 0.0
    for cage in range(suspects.shape[0]):
        for j in range(suspects.shape[1]):
            if suspects[cage, j] > 0.0:
                ball, upper = cage * suspects.shape[1] + j, min(suspects[cage, j], first_share)
                share, rate = _root(balls, law, track, ball, time, step, begin, end, upper)
                if share < first_share:
                    first_share, first_ball, first_rate = share, ball, rate
    return first_share, first_ball, first_rate


@njit_pasted
def _root(
    balls: Array, law: Law, track: Track, ball: int, time: float, step: float, begin: Array, end: Array, upper: float
) -> tuple[float, float]:
    """Earliest share at which `ball` leaves the contact set's state, and the rate there; 2.0 if not by `upper`."""
    sign = 1.0 if of_ball(balls, ACTIVE, ball) > 0.5 else -1.0
    high, low = upper, 0.0
    value, slope_high, rate = contact_condition(balls, law, track, ball, time, step, high, begin, end)
    at_high = sign * value
    if at_high > 0.0:
        return 2.0, 0.0
    value, slope_low, rate_low = contact_condition(balls, law, track, ball, time, step, low, begin, end)
    at_low = sign * value
    if at_low <= 0.0:
        # A ball toggled at the start of the step sits at zero to round-off: look just behind it.
        low = 1e-4 * upper
        value, slope_low, rate_low = contact_condition(balls, law, track, ball, time, step, low, begin, end)
        at_low = sign * value
        if at_low <= 0.0:
            return 0.0, rate_low
    guess, side = hermite_root(low, high, at_low, at_high, sign * slope_low, sign * slope_high), 0
    for _ in range(MOST_ITERATIONS):
        if not low < guess < high:
            guess = 0.5 * (low + high)
        value, slope, rate = contact_condition(balls, law, track, ball, time, step, guess, begin, end)
        value, slope = sign * value, sign * slope
        if value > 0.0:
            low, at_low = guess, value
            at_high *= 0.5 if side == 1 else 1.0
            side = 1
        else:
            high, at_high = guess, value
            at_low *= 0.5 if side == -1 else 1.0
            side = -1
        if slope < 0.0:
            guess -= value / slope
            if abs(value) <= -SURE_SHARE * slope and low <= guess <= high:
                return guess, rate
        else:
            guess = (at_low * high - at_high * low) / (at_low - at_high)
        if high - low <= SMALLEST_SHARE:
            break
    return high, rate


@njit_pasted
def hermite_root(low: float, high: float, at_low: float, at_high: float, slope_low: float, slope_high: float) -> float:
    """A guess of where the cubic through value and slope at both ends is zero; by the chord if slopes are unknown."""
    length = high - low
    chord = (at_high - at_low) / length
    guess = -at_low / chord
    if slope_low == 0.0 or slope_high == 0.0:
        return low + guess
    bend = (3.0 * chord - 2.0 * slope_low - slope_high) / length
    twist = (slope_low + slope_high - 2.0 * chord) / (length * length)
    for _ in range(GUESS_ITERATIONS):
        value = at_low + guess * (slope_low + guess * (bend + guess * twist))
        slope = slope_low + guess * (2.0 * bend + 3.0 * guess * twist)
        if slope >= 0.0:
            break
        guess -= value / slope
    return low + guess


@njit_inline
def mark_suspects(balls: Array, law: Law, share: float, suspects: Array) -> None:
    """Note `share` for every ball that contradicts the contact set now and was not noted for an earlier one."""
    for cage in range(suspects.shape[0]):
        for j in range(suspects.shape[1]):
            contradicts = touches(balls, law, cage, j) != (balls[cage, ACTIVE, j] > 0.5)
            if contradicts and (suspects[cage, j] == 0.0 or share < suspects[cage, j]):
                suspects[cage, j] = share
