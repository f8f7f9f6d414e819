"""What the balls run on: the cages that carry them, the spalls and the waves under them, as functions of time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline
from physics.contact.turning import cosine_sine
from physics.paths.depth_path import RELIEF_LEVELS, Paths, path_at

Array = NDArray[np.float64]

# Columns of `spalls`: place of the first ball of its row, its cage, direction of travel, angle to ball 1 of its row at
# zero cage angle and time (rad), speed of its race (rad/s); where its path begins and ends and the mean width of its
# cells (rad), 1 if it is rough, and how far it strays from a chord over 1, 2, 4 … cells (m), see `DepthPath`.
FIRST_BALL, CAGE, SIGN, ANGLE, SPEED, ENTRY, LEAVE, CELL, ROUGH, RELIEF = range(10)
SPALL_COLUMNS = RELIEF + RELIEF_LEVELS
# Columns of `waves`: speed of the race (rad/s), waves around it, amplitude (m), phase (rad).
RACE_SPEED, ORDER, AMPLITUDE, PHASE = range(4)
WAVE_COLUMNS = 4

TURNS_PER_RADIAN = 1.0 / (2.0 * math.pi)


class Track(NamedTuple):
    """What the balls run on, as a function of time.

    Cage angles: quartics `cage` (G, I, 5) over equal intervals, `clock` (G, 3) first knot (s), knots per second and
    seconds per knot.
    Spalls (D, 18) with as many `paths`.
    `waves` (W, 4) of both races, and the cosine and sine of their `turns` (W, 2, B) from the first ball of a row to
    each of its B balls.
    """

    cage: Array
    clock: Array
    spalls: Array
    paths: Paths
    waves: Array
    turns: Array
    row_size: int
    spacing: float
    shaft_speed: float


@njit_inline
def cage_at(track: Track, cage: int, time: float) -> tuple[float, float]:
    """Cage angle (rad) and speed (rad/s) of one cage at `time` (s)."""
    since = time - track.clock[cage, 0]
    interval = min(max(int(since * track.clock[cage, 1]), 0), track.cage.shape[1] - 1)
    since -= interval * track.clock[cage, 2]
    c4 = track.cage[cage, interval, 0]
    c3 = track.cage[cage, interval, 1]
    c2 = track.cage[cage, interval, 2]
    c1 = track.cage[cage, interval, 3]
    # In pairs, so that fewer operations wait for each other than in a chain.
    square = since * since
    angle = (c1 * since + track.cage[cage, interval, 4]) + square * ((c3 * since + c2) + square * c4)
    return angle, (2.0 * c2 * since + c1) + square * (4.0 * c4 * since + 3.0 * c3)


@njit_inline
def waviness_at(track: Track, place: float, speed: float, time: float) -> tuple[float, float]:
    """Depth (m) of all waves under a ball at the angle `place`, and its rate (m/s)."""
    depth, rate = 0.0, 0.0
    for wave in range(track.waves.shape[0]):
        cosine, sine, pace = wave_at(track, wave, place, speed, time)
        depth += cosine
        rate += pace * sine
    return depth, rate


@njit_inline
def wave_at(track: Track, wave: int, place: float, speed: float, time: float) -> tuple[float, float, float]:
    """Depth (m) of one wave at the angle `place` (rad), the same a quarter of its length before, and the factor (1/s)
    with which that is the rate of the depth under a ball there at a cage `speed` (rad/s)."""
    race_speed, order = track.waves[wave, RACE_SPEED], track.waves[wave, ORDER]
    cosine, sine = cosine_sine(order * (place - race_speed * time) + track.waves[wave, PHASE])
    amplitude = track.waves[wave, AMPLITUDE]
    return amplitude * cosine, amplitude * sine, -order * (speed - race_speed)


@njit_inline
def hindmost(track: Track, spall: int, angle: float, time: float, travel: float) -> tuple[float, float, float]:
    """Of the balls that meet a spall while they cover `travel` (rad) from the cage `angle` (rad) at `time` (s) on: the
    arc (rad) of the hindmost and how many spacings it is ahead of ball 1 of its row; and the arc that none is beyond.

    The others follow a spacing apart.
    """
    row = track.spalls[spall]
    ahead = row[SIGN] * (angle - row[ANGLE] - row[SPEED] * time)
    turns = math.ceil((row[ENTRY] - max(travel, 0.0) - ahead) * (track.row_size * TURNS_PER_RADIAN))
    return ahead + turns * track.spacing, turns, row[LEAVE] - min(travel, 0.0)


@njit_inline
def passage(track: Track, spall: int, time: float, step: float) -> tuple[float, float, float, float]:
    """How far (rad) balls travel over a spall in a `step` (s) from `time` (s) on, and what `hindmost` tells of those
    that meet it."""
    cage = int(track.spalls[spall, CAGE])
    start, _ = cage_at(track, cage, time)
    end, _ = cage_at(track, cage, time + step)
    travel = track.spalls[spall, SIGN] * (end - start - track.spalls[spall, SPEED] * step)
    return travel, *hindmost(track, spall, start, time, travel)


@njit_inline
def place_of(track: Track, spall: int, turns: float) -> int:
    """The column in `balls` of the ball that is `turns` spacings ahead of ball 1 of the spall's row."""
    row, number = track.spalls[spall], track.spalls[spall, SIGN] * turns
    # Without the remainder of whole numbers, which takes longer than all of this.
    number -= math.floor((number + 0.5) * (1.0 / track.row_size)) * track.row_size
    return int(row[FIRST_BALL] + number)


@njit_inline
def spall_under(track: Track, spall: int, number: int, angle: float, speed: float, time: float) -> tuple[float, float]:
    """Depth (m) under ball `number` of the spall's row and its rate (m/s)."""
    sign, race_speed = track.spalls[spall, SIGN], track.spalls[spall, SPEED]
    entry = track.spalls[spall, ENTRY]
    arc = sign * (angle - track.spalls[spall, ANGLE] - race_speed * time + number * track.spacing)
    circle = track.row_size * track.spacing
    arc += math.ceil((entry - arc) / circle) * circle
    depth, slope = path_under(track, spall, arc)
    return depth, slope * sign * (speed - race_speed)


@njit_inline
def path_under(track: Track, spall: int, arc: float) -> tuple[float, float]:
    """Drop (m) and slope (m/rad) of a spall's path at `arc` (rad); zero outside."""
    if arc < track.spalls[spall, ENTRY] or arc > track.spalls[spall, LEAVE]:
        return 0.0, 0.0
    return path_at(track.paths, spall, arc)
