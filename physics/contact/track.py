"""What the balls run on: the cages that carry them, the spalls and the waves under them, as functions of time."""

from __future__ import annotations

import math
from typing import NamedTuple

from physics._jit import njit_inline
from physics.arrays import Array
from physics.contact.waves import WAVE_COEFFICIENTS
from physics.paths.depth_path import RELIEF_LEVELS, Paths, path_at

# Columns of `spalls`.
(
    FIRST_BALL,  # column in `balls` of the first ball of its row
    CAGE,  # of its row
    SIGN,  # direction of travel, 1 or −1
    ANGLE,  # to ball 1 of its row at zero cage angle and time, rad
    SPEED,  # of its race, rad/s
    ENTRY,  # where its path begins, rad
    LEAVE,  # and ends, rad
    CELL,  # mean width of the cells of its path, rad
    ROUGH,  # 1 if its path is rough
    RELIEF,  # first of RELIEF_LEVELS: how far its path strays from a chord over 1, 2, 4 … cells, m, see `DepthPath`
) = range(10)
SPALL_COLUMNS = RELIEF + RELIEF_LEVELS
TURNS_PER_RADIAN = 1.0 / (2.0 * math.pi)


class Track(NamedTuple):
    """What the balls run on, as a function of time.

    Cage angles: quartics `cage` (G, I, 5) over equal intervals, `clock` (G, 3) first knot (s), knots per second and
    seconds per knot.
    `spalls` (D, 17): the columns above; as many `paths`.
    `waviness` (2, C, 6 S): polynomials of degree five of the outer and inner race over C equal cells of each of the B
    spacings of a row; of every cell the fifth powers of the spacings, twice round so that B of them follow any one, in
    the first of S = `wave_columns` columns, then the fourth ones and so on. C is 0 for smooth races.
    """

    cage: Array
    clock: Array
    spalls: Array
    paths: Paths
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
def waviness_at(track: Track, angle: float, speed: float, time: float) -> tuple[float, float]:
    """Depth (m) of both races' waves under a ball at the `angle` (rad), and its rate (m/s)."""
    outer, outer_slope = wave_at(track, 0, angle)
    inner, inner_slope = wave_at(track, 1, angle - track.shaft_speed * time)
    return outer + inner, outer_slope * speed + inner_slope * (speed - track.shaft_speed)


@njit_inline
def wave_at(track: Track, race: int, angle: float) -> tuple[float, float]:
    """Depth (m) and slope (m/rad) of one race's waves at an `angle` (rad) fixed to it."""
    cell, spacing, x = wave_cell(track, angle)
    depth, slope, columns = 0.0, 0.0, track.waviness.shape[2] // WAVE_COEFFICIENTS
    for power in range(WAVE_COEFFICIENTS):
        slope = slope * x + depth
        depth = depth * x + track.waviness[race, cell, spacing + power * columns]
    return depth, slope * wave_cells_per_radian(track)


@njit_inline
def wave_cells_per_radian(track: Track) -> float:
    """Cells of the waviness a radian."""
    return track.row_size * track.waviness.shape[1] * TURNS_PER_RADIAN


@njit_inline
def wave_cell(track: Track, angle: float) -> tuple[int, int, float]:
    """Where an angle (rad) lies on the circle: in which cell of its spacing, in which spacing, and where in that cell,
    0 to 1."""
    cells, turns = track.waviness.shape[1], angle * TURNS_PER_RADIAN
    spacings = (turns - math.floor(turns)) * track.row_size
    spacing = min(int(spacings), track.row_size - 1)
    passed = (spacings - spacing) * cells
    cell = min(int(passed), cells - 1)
    return cell, spacing, passed - cell


@njit_inline
def hindmost(track: Track, spall: int, angle: float, time: float, travel: float) -> tuple[float, float, float]:
    """The hindmost ball over a spall while balls cover `travel` (rad) from the cage `angle` (rad) at `time` (s).

    Its arc (rad), how many spacings it is ahead of ball 1 of its row, and the largest arc (rad) that any ball may have;
    the others are ahead of it by whole spacings.
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
