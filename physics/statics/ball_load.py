"""The quasi-static load of chosen balls at chosen instants, where that of all balls at all of them would be a waste."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_lean
from physics.arrays import Array, Index
from physics.assembly import assemble, ball_numbers
from physics.checks import require_count
from physics.contact.forces import FORCE, Contacts, of_ball
from physics.motion import MotionModel, motion_model
from physics.scene import Scene
from physics.statics.load_distribution import require_carried
from physics.statics.successive_rest import expected, rest_at

# Share of the load on the shaft that may be left unbalanced.
TOLERANCE = 1e-9


def ball_load(scene: Scene, time: Array, row: int, ball: NDArray[np.integer]) -> Array:
    """Normal load (K,), N, of `ball` (K,), from 1, of `row` at each of the increasing times (K,), s.

    Raises InvalidParameter for a row or ball that there is not, SimulationFailed where no position carries the load on
    the shaft.
    """
    bearing, (rows, balls) = scene.rig.bearing, ball_numbers(scene)
    require_count("row", row, 1, bearing.rows)
    for number in (ball.min(initial=1), ball.max(initial=1)):
        require_count("ball", int(number), 1, bearing.balls)
    column = np.zeros((bearing.rows, bearing.balls), dtype=np.int64)
    real = np.flatnonzero(balls >= 0)
    column[rows[real], balls[real]] = real
    load, position = np.zeros(time.size), np.zeros((time.size, 2))
    columns = column[row - 1, ball - 1]
    lost = _follow(assemble(scene), motion_model(scene), np.ascontiguousarray(time), columns, position, load)
    require_carried(scene, time, lost)
    return load / math.cos(bearing.contact_angle)


@njit_lean
def _follow(contacts: Contacts, motion: MotionModel, time: Array, ball: Index, position: Array, load: Array) -> int:
    """Fill `load` (K,), N in radial direction, along the way of the shaft, `position` (K, 2), m; the first instant at
    which no position carries the load, or K."""
    lost = time.size
    for k in range(time.size):
        x, y = expected(position, k, 1)
        position[k, 0], position[k, 1], _, carried = rest_at(contacts, motion, time[k], x, y, TOLERANCE)
        load[k] = of_ball(contacts.balls, FORCE, ball[k])
        lost = lost if carried else min(lost, k)
    return lost
