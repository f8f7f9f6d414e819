"""The one place where a Scene becomes the plain arrays that the kernels read."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from physics.arrays import Array, Index
from physics.cage import CagePath
from physics.contact.forces import BALL_ROWS, COSINE, FRAME_COLUMNS, GAP, PLACE, SINE, WHOLE_VECTOR, Contacts, Law
from physics.contact.track import (
    ANGLE,
    CAGE,
    CELL,
    ENTRY,
    FIRST_BALL,
    LEAVE,
    RELIEF,
    ROUGH,
    SIGN,
    SPALL_COLUMNS,
    SPEED,
    Track,
)
from physics.contact.waves import WAVE_COEFFICIENTS, wave_columns
from physics.imperfections import Waviness
from physics.paths.depth_path import DepthPath, paths_of
from physics.paths.profile import build_path
from physics.scene import Scene

# Gap (m) of the columns that fill up a cage's whole vectors: such a ball never touches.
PADDING_GAP = 1.0
# So waves are met to 1.1e-10 of their amplitude: h^6 / 46 080 with h = 2π / 48.
WAVINESS_CELLS_PER_WAVE = 48
TABLES_KEPT = 8


def assemble(scene: Scene, fineness: int = 1) -> Contacts:
    """The contacts of `scene`; radial stiffness and damping include the contact angle [P14 Eq. 6, 9, 26].

    Paths over spalls have a `fineness` times as many cells as usual.
    """
    bearing, rig = scene.rig.bearing, scene.rig
    law = Law(
        stiffness=float(bearing.radial_load_deflection),
        exponent=float(bearing.exponent),
        damping=float(rig.radial_film_damping),
        no_tension=scene.no_tension,
    )
    return Contacts(_balls(scene), np.zeros((len(scene.cages), FRAME_COLUMNS)), law, _track(scene, fineness))


def ball_numbers(scene: Scene) -> tuple[Index, Index]:
    """Row and ball (G · M,), from 0, in every column of the balls of G cages; −1 for padding."""
    bearing, cages = scene.rig.bearing, len(scene.cages)
    size = bearing.balls * (bearing.rows if cages == 1 else 1)
    row, ball = np.full((2, cages, size + -size % WHOLE_VECTOR), -1)
    for r in range(bearing.rows):
        cage, part = (0, r) if cages == 1 else (r, 0)
        here = slice(part * bearing.balls, (part + 1) * bearing.balls)
        row[cage, here], ball[cage, here] = r, np.arange(bearing.balls)
    return row.ravel(), ball.ravel()


def _balls(scene: Scene) -> Array:
    """Ball table (G, 11, M) with angles and gaps filled in."""
    bearing, cages = scene.rig.bearing, len(scene.cages)
    row, ball = (numbers.reshape(cages, -1) for numbers in ball_numbers(scene))
    balls, real = np.zeros((cages, BALL_ROWS, row.shape[1])), row >= 0
    balls[:, COSINE], balls[:, GAP] = 1.0, PADDING_GAP
    row, ball = row[real], ball[real]
    angle = bearing.stagger * row + bearing.spacing * ball
    deviation = np.array(scene.imperfections.ball_deviation or np.zeros((bearing.rows, bearing.balls)))[row, ball]
    balls[:, COSINE][real], balls[:, SINE][real] = np.cos(angle), np.sin(angle)
    balls[:, PLACE][real] = angle
    balls[:, GAP][real] = bearing.clearance - deviation / math.cos(bearing.contact_angle)
    return balls


@lru_cache(maxsize=TABLES_KEPT)
def _track(scene: Scene, fineness: int) -> Track:
    """What the balls of `scene` run on; the same scene gives the same arrays, which are for reading only."""
    bearing = scene.rig.bearing
    paths = [build_path(spall, bearing, fineness) for spall in scene.spalls]
    cage, clock = _cage_arrays(scene.cages)
    return Track(
        cage=cage,
        clock=clock,
        spalls=_spall_table(scene, paths, len(scene.cages)),
        paths=paths_of(paths),
        waviness=_wave_cells(scene.imperfections.waviness, bearing.balls),
        row_size=bearing.balls,
        spacing=bearing.spacing,
        shaft_speed=scene.operation.shaft_speed,
    )


def _spall_table(scene: Scene, paths: list[DepthPath], cages: int) -> Array:
    table = np.zeros((len(paths), SPALL_COLUMNS))
    for index, (spall, path) in enumerate(zip(scene.spalls, paths, strict=True)):
        row = spall.row - 1
        table[index, FIRST_BALL] = row * scene.rig.bearing.balls if cages == 1 else 0
        table[index, CAGE] = row if cages > 1 else 0
        table[index, SIGN] = spall.travel_sign
        table[index, ANGLE] = spall.angle - row * scene.rig.bearing.stagger
        table[index, SPEED] = scene.race_speed(spall.race)
        table[index, ENTRY], table[index, LEAVE] = path.breaks[[0, -1]]
        table[index, CELL], table[index, ROUGH], table[index, RELIEF:] = path.cell, path.rough, path.relief
    return table


def _cage_arrays(cages: tuple[CagePath, ...]) -> tuple[Array, Array]:
    intervals = max(cage.polynomial.c.shape[1] for cage in cages)
    quartics = np.zeros((len(cages), intervals, 5))
    clock = np.zeros((len(cages), 3))
    for g, cage in enumerate(cages):
        coefficients = cage.polynomial.c
        pieces = coefficients.shape[1]
        quartics[g, :pieces, 5 - coefficients.shape[0] :] = coefficients.T
        # A cage with fewer pieces than the other goes on along its last one, as its polynomial does.
        late = cage.polynomial.x[0] + cage.knot_step * np.arange(pieces, intervals)
        for power in range(5):
            quartics[g, pieces:, 4 - power] = cage.polynomial(late, nu=power) / math.factorial(power)
        clock[g, 0] = cage.polynomial.x[0]
        if cage.knot_values:
            clock[g, 1:] = 1.0 / cage.knot_step, cage.knot_step
    return quartics, clock


@lru_cache(maxsize=TABLES_KEPT)
def _wave_cells(waves: tuple[Waviness, ...], balls: int) -> Array:
    """Polynomials (2, C, 6 S) of the waves over C cells a spacing of the `balls`, as `Track` keeps them; read only.

    They have the waves' values, slopes and curvatures at both ends of their cells, so that nothing jumps there that
    could ring a mode.
    """
    if not waves:
        return np.zeros((2, 0, WAVE_COEFFICIENTS * wave_columns(balls)))
    count = balls * -(-WAVINESS_CELLS_PER_WAVE * max(8, *(wave.order for wave in waves)) // balls)
    nodes = 2.0 * np.pi * np.arange(count + 1) / count
    value, slope, bend = np.zeros((3, 2, count + 1))
    for wave in waves:
        race = 0 if wave.race == "outer" else 1
        turn, phase = 2.0 * np.pi * wave.order / count, wave.order * nodes + wave.phase
        value[race] += wave.amplitude * np.cos(phase)
        slope[race] -= wave.amplitude * turn * np.sin(phase)
        bend[race] -= wave.amplitude * turn**2 * np.cos(phase)
    rise, d0, d1, s0, s1 = np.diff(value), slope[:, :-1], slope[:, 1:], bend[:, :-1], bend[:, 1:]
    cells = np.stack(
        [
            6.0 * rise - 3.0 * (d0 + d1) - 0.5 * (s0 - s1),
            -15.0 * rise + 8.0 * d0 + 7.0 * d1 + 1.5 * s0 - s1,
            10.0 * rise - 6.0 * d0 - 4.0 * d1 - 1.5 * s0 + 0.5 * s1,
            0.5 * s0,
            d0,
            value[:, :-1],
        ],
        axis=2,
    )
    of_cell = cells.reshape(2, balls, -1, WAVE_COEFFICIENTS).transpose(0, 2, 3, 1)
    room = np.zeros((2, of_cell.shape[1], WAVE_COEFFICIENTS, wave_columns(balls) - 2 * balls))
    return np.concatenate([of_cell, of_cell, room], axis=3).reshape(2, of_cell.shape[1], -1)
