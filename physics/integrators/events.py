"""Locating, inside a step, the instant at which a ball starts or stops touching.

Within a step the contact set is frozen, so the trial solution is smooth. Between its ends the relative displacement is
the quintic through displacement, velocity and acceleration at both; cage angle and depth are known exactly. The
earliest zero of the contact condition is bracketed and found by Newton's method or, where the condition has no slope to
go by, by the Illinois variant of false position.
"""

from __future__ import annotations

from typing import NamedTuple

from physics._jit import njit_inline, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import contradicts
from physics.contact.forces import ACTIVE, Contacts, compression_of, law_force, of_ball, press, set_time

SMALLEST_SHARE = 1e-9
# Newton's method squares the error of a share this small away with its next correction.
SURE_SHARE = 1e-5
MOST_ITERATIONS, GUESS_ITERATIONS = 60, 3
# A condition is zero to round-off below this share of what it is where it is contradicted; how far behind one looks.
AT_ZERO, BEHIND = 1e-6, 1e-4


class Way(NamedTuple):
    """How inner and outer ring move relative to each other in a step that begins at `time` (s) and takes `step` (s).

    `begin`, `end` (3, 2): displacement, step · velocity and step² · acceleration along x and y.
    """

    time: float
    step: float
    begin: Array
    end: Array


@njit_inline
def quintic(way: Way, axis: int, x: float) -> tuple[float, float]:
    """Value, and derivative to the share x, of the quintic through both ends at the share `x` (0 to 1) of the step."""
    begin, end = way.begin, way.end
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
def contact_condition(contacts: Contacts, way: Way, ball: int, share: float) -> tuple[float, float, float]:
    """A number above zero while `ball` touches, its slope over the share of the step or 0 if it is not known, and the
    rate of compression, m/s, at the `share` of the step."""
    x, u = quintic(way, 0, share)
    y, v = quintic(way, 1, share)
    step, law = way.step, contacts.law
    compression, rate = compression_of(contacts, ball, way.time + share * step, x, y, u / step, v / step)
    if law.no_tension:
        # Compression (m) is brought to the scale of a force, by the secant of a ball's law at 1 µm, so that one number
        # carries both conditions.
        return min(law.stiffness * 1e-3 * compression, law_force(law, compression, rate)), 0.0, rate
    return compression, rate * step, rate


@njit_inline
def _mark_suspects(contacts: Contacts, share: float, suspects: Array) -> None:
    """Note `share` for every ball that contradicts the contact set now and was not noted for an earlier one."""
    for cage in range(suspects.shape[0]):
        for j in range(suspects.shape[1]):
            if contradicts(contacts, cage, j) and (suspects[cage, j] == 0.0 or share < suspects[cage, j]):
                suspects[cage, j] = share


@njit_inline
def earliest_change(contacts: Contacts, way: Way, halfway: bool, suspects: Array) -> tuple[float, int, float]:
    """Share of the step, number and rate of compression (m/s) of the ball that first contradicts the contact set.

    Suspects are the balls that contradict it at the end of the step, where `press` has left them, and if `halfway` also
    those that do there. So are those for which `suspects` (G, M) holds the share of the step, above 0, at which they
    were seen to.
    Returns (2.0, −1, 0.0) if no suspect is confirmed. Leaves `contacts` somewhere inside the step.
    """
    _mark_suspects(contacts, 1.0, suspects)
    if halfway:
        set_time(contacts, way.time + 0.5 * way.step)
        x, u = quintic(way, 0, 0.5)
        y, v = quintic(way, 1, 0.5)
        press(contacts, x, y, u / way.step, v / way.step)
        _mark_suspects(contacts, 0.5, suspects)
    first_share, first_ball, first_rate = 2.0, -1, 0.0
    for cage in range(suspects.shape[0]):
        for j in range(suspects.shape[1]):
            if suspects[cage, j] > 0.0:
                ball, upper = cage * suspects.shape[1] + j, min(suspects[cage, j], first_share)
                share, rate, beyond, looking = 2.0, 0.0, min(1.0, first_share), True
                while looking:
                    share, rate = _root(contacts, way, ball, upper)
                    looking = share > 1.0 and upper < beyond
                    # Where it does not contradict where it was seen to, it may halfway or at the end.
                    upper = min(0.5 if upper < 0.5 else 1.0, beyond)
                if share < first_share:
                    first_share, first_ball, first_rate = share, ball, rate
    return first_share, first_ball, first_rate


@njit_pasted
def _root(contacts: Contacts, way: Way, ball: int, upper: float) -> tuple[float, float]:
    """Earliest share at which `ball` leaves the contact set's state, and the rate there; 2.0 if not by `upper`."""
    sign = 1.0 if of_ball(contacts.balls, ACTIVE, ball) > 0.5 else -1.0
    high, low = upper, 0.0
    value, slope_high, rate = contact_condition(contacts, way, ball, high)
    at_high = sign * value
    if at_high > 0.0:
        return 2.0, 0.0
    value, slope_low, _ = contact_condition(contacts, way, ball, low)
    at_low = sign * value
    if at_low <= AT_ZERO * -at_high:
        # A ball toggled at the start of the step sits at zero to round-off, on either side: look just behind it.
        value, slope, rate_behind = contact_condition(contacts, way, ball, BEHIND * upper)
        if sign * value > 0.0:
            low, at_low, slope_low = BEHIND * upper, sign * value, slope
        elif at_low <= 0.0:
            return 0.0, rate_behind
    guess, side = hermite_root(low, high, at_low, at_high, sign * slope_low, sign * slope_high), 0
    for _ in range(MOST_ITERATIONS):
        if not low < guess < high:
            guess = 0.5 * (low + high)
        value, slope, rate = contact_condition(contacts, way, ball, guess)
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
