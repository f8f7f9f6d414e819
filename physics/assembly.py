"""The one place where a Scene becomes the plain arrays that the kernels read."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from physics.cage import CagePath
from physics.contact.forces import BALL_ROWS, COSINE, FRAME_COLUMNS, GAP, LANES, PLACE, SINE, Contacts, Law
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
    WAVE_COLUMNS,
    Track,
)
from physics.paths.depth_path import DepthPath, paths_of
from physics.paths.profile import build_path
from physics.scene import Scene

Array = NDArray[np.float64]
Index = NDArray[np.int64]

PADDING_GAP = 1.0
TABLES_KEPT = 8


def assemble(scene: Scene) -> Contacts:
    """The contacts of `scene`; radial stiffness and damping include the contact angle [P14 Eq. 6, 9, 26]."""
    bearing, rig = scene.rig.bearing, scene.rig
    cos_alpha = math.cos(bearing.contact_angle)
    law = Law(
        stiffness=bearing.load_deflection * cos_alpha ** (bearing.exponent + 1.0),
        exponent=bearing.exponent,
        damping=rig.film_damping * cos_alpha**2,
        no_tension=scene.contact_law == "no_tension",
    )
    return Contacts(_balls(scene), np.zeros((len(scene.cages), FRAME_COLUMNS)), law, _track(scene))


def ball_numbers(scene: Scene) -> tuple[Index, Index]:
    """Row and ball (G · M,), from 0, in every column of the balls of G cages; −1 for padding."""
    bearing, cages = scene.rig.bearing, len(scene.cages)
    size = bearing.balls * (bearing.rows if cages == 1 else 1)
    row, ball = np.full((2, cages, size + -size % LANES), -1)
    for r in range(bearing.rows):
        cage, place = (0, r) if cages == 1 else (r, 0)
        here = slice(place * bearing.balls, (place + 1) * bearing.balls)
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
def _track(scene: Scene) -> Track:
    """What the balls of `scene` run on; the same scene gives the same arrays, which are for reading only."""
    bearing = scene.rig.bearing
    paths = [build_path(spall, bearing) for spall in scene.spalls]
    cage, clock = _cage_arrays(scene.cages)
    waves, turns = _wave_tables(scene)
    return Track(
        cage=cage,
        clock=clock,
        spalls=_spall_table(scene, paths, len(scene.cages)),
        paths=paths_of(paths),
        waves=waves,
        turns=turns,
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


def _wave_tables(scene: Scene) -> tuple[Array, Array]:
    """`waves` (W, 4) and `turns` (W, 2, B) as `Track` keeps them."""
    bearing, waviness = scene.rig.bearing, scene.imperfections.waviness
    waves = np.array([[scene.race_speed(wave.race), wave.order, wave.amplitude, wave.phase] for wave in waviness])
    order = np.array([wave.order for wave in waviness], dtype=np.float64)
    turned = order[:, None] * (bearing.spacing * np.arange(bearing.balls))
    turns = np.stack([np.cos(turned), np.sin(turned)], axis=-2)
    return waves.reshape(-1, WAVE_COLUMNS), turns.reshape(-1, 2, bearing.balls)
