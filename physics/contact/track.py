"""What the balls run on: the cages that carry them, the spalls and the waves under them, as functions of time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline
from physics.paths.depth_path import RELIEF_LEVELS, path_at

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# Columns of `spalls`: place of the first ball of its row, its cage, direction of travel, angle to ball 1 of its row at
# zero cage angle and time (rad), speed of its race (rad/s), first piece, number of pieces, first break, first cubic;
# mean width of its cells (rad), and how far the path strays from a chord over 1, 2, 4 … cells (m), see `DepthPath`.
FIRST_BALL, CAGE, SIGN, ANGLE, SPEED, FIRST_PIECE, PIECES, FIRST_BREAK, FIRST_CUBIC, CELL, RELIEF = range(11)
SPALL_COLUMNS = RELIEF + RELIEF_LEVELS

TURNS_PER_RADIAN = 1.0 / (2.0 * math.pi)


class Track(NamedTuple):
    """What the balls run on, as a function of time.

    Cage angles: quartics `cage` (G, I, 5) over equal intervals, `clock` (G, 3) first knot (s), knots per second and
    seconds per knot.
    Spalls (D, 18) with their paths in `breaks`, `cells`, `cubics` (see physics.paths.depth_path.DepthPath). `waviness`
    (2, N, 4): cubics of the outer and inner race over N equal arcs of the circle, N a multiple of the balls of a
    row, 0 for smooth races.
    """

    cage: Array
    clock: Array
    spalls: Array
    breaks: Array
    cells: Index
    cubics: Array
    waviness: Array
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
    """Depth (m) of both races' waves under a ball at the angle `place`, and its rate (m/s)."""
    outer, outer_slope = wave_at(track, 0, place)
    inner, inner_slope = wave_at(track, 1, place - track.shaft_speed * time)
    return outer + inner, outer_slope * speed + inner_slope * (speed - track.shaft_speed)


@njit_inline
def wave_at(track: Track, race: int, angle: float) -> tuple[float, float]:
    """Depth (m) and slope (m/rad) of one race's waves at an `angle` (rad) fixed to it."""
    cells = track.waviness.shape[1]
    cell, x = wave_cell(cells, angle)
    c3, c2 = track.waviness[race, cell, 0], track.waviness[race, cell, 1]
    c1, c0 = track.waviness[race, cell, 2], track.waviness[race, cell, 3]
    return ((c3 * x + c2) * x + c1) * x + c0, ((3.0 * c3 * x + 2.0 * c2) * x + c1) * (cells * TURNS_PER_RADIAN)


@njit_inline
def wave_cell(cells: int, angle: float) -> tuple[int, float]:
    """The cell of the circle in which an angle (rad) lies, and its place there, 0 to 1."""
    turns = angle * TURNS_PER_RADIAN
    position = (turns - math.floor(turns)) * cells
    cell = min(int(position), cells - 1)
    return cell, position - cell


@njit_inline
def hindmost(track: Track, spall: int, angle: float, time: float, travel: float) -> tuple[float, float, float]:
    """Of the balls that meet a spall while they cover `travel` (rad) from the cage `angle` (rad) at `time` (s) on: the
    arc (rad) of the hindmost and how many spacings it is ahead of ball 1 of its row; and the arc that none is beyond.

    The others follow a spacing apart.
    """
    row = track.spalls[spall]
    first = int(row[FIRST_BREAK])
    entry, leave = track.breaks[first], track.breaks[first + int(row[PIECES])]
    ahead = row[SIGN] * (angle - row[ANGLE] - row[SPEED] * time)
    turns = math.ceil((entry - max(travel, 0.0) - ahead) / track.spacing)
    return ahead + turns * track.spacing, turns, leave - min(travel, 0.0)


@njit_inline
def place_of(track: Track, spall: int, turns: float) -> int:
    """The column in `balls` of the ball that is `turns` spacings ahead of ball 1 of the spall's row."""
    row = track.spalls[spall]
    return int(row[FIRST_BALL]) + int(row[SIGN] * turns) % track.row_size


@njit_inline
def spall_under(track: Track, spall: int, number: int, angle: float, speed: float, time: float) -> tuple[float, float]:
    """Depth (m) under ball `number` of the spall's row and its rate (m/s)."""
    sign, race_speed = track.spalls[spall, SIGN], track.spalls[spall, SPEED]
    entry = track.breaks[int(track.spalls[spall, FIRST_BREAK])]
    arc = sign * (angle - track.spalls[spall, ANGLE] - race_speed * time + number * track.spacing)
    circle = track.row_size * track.spacing
    arc += math.ceil((entry - arc) / circle) * circle
    depth, slope = path_under(track, spall, arc)
    return depth, slope * sign * (speed - race_speed)


@njit_inline
def path_under(track: Track, spall: int, arc: float) -> tuple[float, float]:
    """Drop (m) and slope (m/rad) of a spall's path at `arc` (rad); zero outside."""
    row = track.spalls[spall]
    first_break, pieces = int(row[FIRST_BREAK]), int(row[PIECES])
    if arc < track.breaks[first_break] or arc > track.breaks[first_break + pieces]:
        return 0.0, 0.0
    return path_at(
        track.breaks, track.cells, track.cubics, first_break, int(row[FIRST_PIECE]), pieces, int(row[FIRST_CUBIC]), arc
    )
