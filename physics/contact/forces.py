"""Contact forces of all balls at once, branch-free in the frame of the cage [P14 Eq. 4-10].

Ball j sits at a fixed angle in the cage, so one sine and cosine a call turn the displacement into the cage's frame and
the compression of every ball becomes p cos θj + q sin θj − floor. Sums run over precomputed θj in loops with no branch
and in a fixed order, so they use vector instructions and give the same bits on every processor; only balls inside a
spall need the depth of their path.

Kernels take few arrays: each array handed to a compiled function costs reference counting, which would cost more than
the mechanics. What belongs to one ball is therefore one column of `balls` (G, 11, M), G cages of M balls each, padded
to whole vectors; what belongs to one cage is one row of `frames`. Loops run from zero because only then does the
compiler know that no index is negative, and vectorises. Where one number names a ball, it is cage · M + place.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics._jit import njit_inline, njit_inner, njit_pasted
from physics.arrays import Array
from physics.contact.power import power
from physics.contact.track import (
    CAGE,
    FIRST_BALL,
    SIGN,
    SPEED,
    Track,
    cage_at,
    hindmost,
    place_of,
    spall_under,
    wave_cell,
    wave_cells_per_radian,
    waviness_at,
)
from physics.contact.turning import cosine_sine
from physics.contact.waves import SHORT_ROW_COLUMNS, WAVE_COEFFICIENTS, add_waves, powers, rates_of
from physics.paths.depth_path import path_at

# Second index of `balls`, what is known of each ball.
BALL_ROWS = 11
(
    COSINE,  # of its angle in the cage
    SINE,
    GAP,  # clearance minus diameter deviation, m
    FLOOR,  # gap plus depth of spalls and waves under it, m
    FALL,  # rate of the floor, m/s
    ACTIVE,  # 1 in the contact set, 0 outside
    COMPRESSION,  # m
    LAW,  # what the contact law gives, whether or not the ball touches, N
    FORCE,  # the same in the contact set, 0 outside, N
    CLOSING,  # rate of compression, m/s
    PLACE,  # its angle in the cage, rad
) = range(BALL_ROWS)
# The balls of a cage are padded to a multiple of the widest vector of today's processors: what is left behind whole
# vectors goes one by one, and four single balls take longer than eight at once.
WHOLE_VECTOR = 8
# The sums of `_sum_lanes`; a divisor of the above.
LANES = 4
# Columns of `frames`, one row a cage: cosine and sine of its angle, its speed (rad/s).
FRAME_COLUMNS = 3
FRAME_COSINE, FRAME_SINE, FRAME_SPEED = range(FRAME_COLUMNS)


class Law(NamedTuple):
    """The contact law in radial direction: K (N/mⁿ), n, c_d (N s/m) and whether the force may not pull."""

    stiffness: float
    exponent: float
    damping: float
    no_tension: bool


class Contacts(NamedTuple):
    """Everything the kernels need of a scene's contacts: `balls` (G, 11, M) and `frames` (G, 3) as above, the contact
    law, and what the balls run on."""

    balls: Array
    frames: Array
    law: Law
    track: Track


@njit_inner
def set_time(contacts: Contacts, time: float) -> None:
    """`move_to` as a called function, for places where an inlined copy would only cost compile time."""
    move_to(contacts, time)


@njit_inline
def move_to(contacts: Contacts, time: float) -> None:
    """Bring what depends on time alone to `time` (s): the cages' frames, the floor under each ball and its rate."""
    _move_to(contacts, time, True)


@njit_inline
def stand_at(contacts: Contacts, time: float) -> None:
    """`move_to` for what rests: waves add nothing to the rates of the floors."""
    _move_to(contacts, time, False)


@njit_inline
def _move_to(contacts: Contacts, time: float, rates: bool) -> None:
    balls, frames, track = contacts.balls, contacts.frames, contacts.track
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            balls[cage, FLOOR, j] = balls[cage, GAP, j]
            balls[cage, FALL, j] = 0.0
        angle, speed = cage_at(track, cage, time)
        frames[cage, FRAME_COSINE], frames[cage, FRAME_SINE] = cosine_sine(angle)
        frames[cage, FRAME_SPEED] = speed
        if track.waviness.shape[1] > 0:
            _add_waviness(contacts, cage, angle, speed, time, rates)
        for spall in range(track.spalls.shape[0]):
            if track.spalls[spall, CAGE] == cage:
                _add_spall(contacts, cage, spall, angle, speed, time)


@njit_pasted
def _add_spall(contacts: Contacts, cage: int, spall: int, angle: float, speed: float, time: float) -> None:
    balls, track = contacts.balls, contacts.track
    sign, race_speed = track.spalls[spall, SIGN], track.spalls[spall, SPEED]
    arc, turns, leave = hindmost(track, spall, angle, time, 0.0)
    while arc <= leave:
        place = place_of(track, spall, turns)
        depth, slope = path_at(track.paths, spall, arc)
        balls[cage, FLOOR, place] += depth
        balls[cage, FALL, place] += slope * sign * (speed - race_speed)
        arc += track.spacing
        turns += 1.0


@njit_inner
def _add_waviness(contacts: Contacts, cage: int, angle: float, speed: float, time: float, rates: bool) -> None:
    """Both races' waves under every ball, with their `rates` or without: the balls of a row are whole spacings apart,
    at the same place within theirs."""
    balls, track, waves = contacts.balls, contacts.track, contacts.track.waviness
    row, columns = track.row_size, np.uint64(waves.shape[2] // WAVE_COEFFICIENTS)
    pace = speed * wave_cells_per_radian(track)
    inner_pace = pace - track.shaft_speed * wave_cells_per_radian(track)
    for first in range(0, balls.shape[2] - row + 1, row):
        outer, outer_spacing, x = wave_cell(track, angle + balls[cage, PLACE, first])
        inner, inner_spacing, z = wave_cell(track, angle + balls[cage, PLACE, first] - track.shaft_speed * time)
        # Unsigned places need no look at their sign, and a number of columns known to the compiler no look at whether
        # what is read is what was written: only so does the loop over the few balls of a row take vectors.
        here = np.uint64(cage), np.uint64(first), np.uint64(row)
        a, b = (outer, np.uint64(outer_spacing)), (inner, np.uint64(inner_spacing))
        p, q = powers(x), powers(z)
        if columns == SHORT_ROW_COLUMNS:
            add_waves(balls, FLOOR, here, waves, a, b, p, q, SHORT_ROW_COLUMNS)
            if rates:
                add_waves(balls, FALL, here, waves, a, b, rates_of(p, pace), rates_of(q, inner_pace), SHORT_ROW_COLUMNS)
        else:
            add_waves(balls, FLOOR, here, waves, a, b, p, q, columns)
            if rates:
                add_waves(balls, FALL, here, waves, a, b, rates_of(p, pace), rates_of(q, inner_pace), columns)


@njit_inline
def compression_of(
    contacts: Contacts, ball: int, time: float, x: float, y: float, u: float, v: float
) -> tuple[float, float]:
    """Compression (m) and its rate (m/s) of one ball at `time`: what `move_to` and `press` do for all of them."""
    balls, track, size = contacts.balls, contacts.track, contacts.balls.shape[2]
    cage, place = ball // size, ball % size
    angle, speed = cage_at(track, cage, time)
    c0, s0 = cosine_sine(angle)
    c = c0 * balls[cage, COSINE, place] - s0 * balls[cage, SINE, place]
    s = s0 * balls[cage, COSINE, place] + c0 * balls[cage, SINE, place]
    floor, fall = balls[cage, GAP, place], 0.0
    if track.waviness.shape[1] > 0:
        depth, rate = waviness_at(track, angle + balls[cage, PLACE, place], speed, time)
        floor += depth
        fall += rate
    for spall in range(track.spalls.shape[0]):
        number = place - int(track.spalls[spall, FIRST_BALL])
        if track.spalls[spall, CAGE] == cage and 0 <= number < track.row_size:
            depth, rate = spall_under(track, spall, number, angle, speed, time)
            floor += depth
            fall += rate
    compression = x * c + y * s - floor
    return compression, u * c + v * s + speed * (y * c - x * s) - fall


@njit_inline
def law_power(law: Law, compression: float) -> float:
    """A compression (m) to the power of the law's exponent less one, its secant stiffness over K; 0 out of contact."""
    if compression <= 0.0:
        return 0.0
    return math.sqrt(compression) if law.exponent == 1.5 else power(compression, law.exponent - 1.0)


@njit_inline
def law_force(law: Law, compression: float, rate: float) -> float:
    """What the contact law gives, N, for a compression (m) and its rate (m/s), touching or not; it may pull."""
    return law.stiffness * max(compression, 0.0) * law_power(law, compression) + law.damping * rate


@njit_inline
def press(contacts: Contacts, dx: float, dy: float, vx: float, vy: float) -> tuple[float, float]:
    """Net force (N) of the contact set along x and y, pushing the outer ring [P14 Eq. 8, 10].

    `dx`, `dy` (m) and `vx`, `vy` (m/s) are displacement and velocity of the inner relative to the outer ring;
    `set_time` must have been called. Leaves compression, law and force of every ball in `contacts.balls`.
    """
    balls, frames, law = contacts.balls, contacts.frames, contacts.law
    force_x, force_y = 0.0, 0.0
    for cage in range(balls.shape[0]):
        cosine, sine, speed = frames[cage, FRAME_COSINE], frames[cage, FRAME_SINE], frames[cage, FRAME_SPEED]
        p = dx * cosine + dy * sine
        q = dy * cosine - dx * sine
        a = vx * cosine + vy * sine + speed * q
        b = vy * cosine - vx * sine - speed * p
        # Two loops that differ in the power alone, so that vector instructions do not hang on the compiler's taking the
        # choice out of one.
        if law.exponent == 1.5:
            for j in range(balls.shape[2]):
                compression = p * balls[cage, COSINE, j] + q * balls[cage, SINE, j] - balls[cage, FLOOR, j]
                rate = a * balls[cage, COSINE, j] + b * balls[cage, SINE, j] - balls[cage, FALL, j]
                pressed = max(compression, 0.0)
                balls[cage, COMPRESSION, j] = compression
                balls[cage, CLOSING, j] = rate
                balls[cage, LAW, j] = law.stiffness * pressed * math.sqrt(pressed) + law.damping * rate
                balls[cage, FORCE, j] = balls[cage, ACTIVE, j] * balls[cage, LAW, j]
        else:
            for j in range(balls.shape[2]):
                compression = p * balls[cage, COSINE, j] + q * balls[cage, SINE, j] - balls[cage, FLOOR, j]
                rate = a * balls[cage, COSINE, j] + b * balls[cage, SINE, j] - balls[cage, FALL, j]
                pressed = max(compression, 0.0)
                balls[cage, COMPRESSION, j] = compression
                balls[cage, CLOSING, j] = rate
                balls[cage, LAW, j] = law.stiffness * pressed * power(pressed, law.exponent - 1.0) + law.damping * rate
                balls[cage, FORCE, j] = balls[cage, ACTIVE, j] * balls[cage, LAW, j]
        along, across = _sum_lanes(balls, cage)
        force_x += along * cosine - across * sine
        force_y += along * sine + across * cosine
    return force_x, force_y


@njit_inline
def _sum_lanes(balls: Array, cage: int) -> tuple[float, float]:
    """Sums of force times cosine and sine over the balls of one cage, in four lanes added in a fixed order."""
    p0, p1, p2, p3 = 0.0, 0.0, 0.0, 0.0
    q0, q1, q2, q3 = 0.0, 0.0, 0.0, 0.0
    for j in range(0, balls.shape[2], LANES):
        p0 += balls[cage, FORCE, j] * balls[cage, COSINE, j]
        p1 += balls[cage, FORCE, j + 1] * balls[cage, COSINE, j + 1]
        p2 += balls[cage, FORCE, j + 2] * balls[cage, COSINE, j + 2]
        p3 += balls[cage, FORCE, j + 3] * balls[cage, COSINE, j + 3]
        q0 += balls[cage, FORCE, j] * balls[cage, SINE, j]
        q1 += balls[cage, FORCE, j + 1] * balls[cage, SINE, j + 1]
        q2 += balls[cage, FORCE, j + 2] * balls[cage, SINE, j + 2]
        q3 += balls[cage, FORCE, j + 3] * balls[cage, SINE, j + 3]
    return (p0 + p1) + (p2 + p3), (q0 + q1) + (q2 + q3)


@njit_inline
def of_ball(balls: Array, row: int, ball: int) -> float:
    """One entry of `balls` for the ball numbered cage · M + place."""
    size = balls.shape[2]
    return balls[ball // size, row, ball % size]


@njit_inner
def direction(contacts: Contacts, cage: int, place: int) -> tuple[float, float]:
    """Cosine and sine of the angle φ of a ball; `set_time` must have been called."""
    balls, frames = contacts.balls, contacts.frames
    cosine, sine = frames[cage, FRAME_COSINE], frames[cage, FRAME_SINE]
    return (
        balls[cage, COSINE, place] * cosine - balls[cage, SINE, place] * sine,
        balls[cage, SINE, place] * cosine + balls[cage, COSINE, place] * sine,
    )
