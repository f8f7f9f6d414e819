"""The quasi-static stiffness of the bearing over time, the parametric excitation behind the vibration [P14 Eq. 26]."""

from __future__ import annotations

import numpy as np

from physics._jit import njit, njit_lean
from physics.arrays import Array
from physics.assembly import assemble
from physics.contact.forces import Contacts, set_time
from physics.motion import MotionModel, motion_model
from physics.scene import Scene
from physics.statics.load_distribution import require_carried
from physics.statics.rest import EXACT, elastic
from physics.statics.successive_rest import expected, rest_at


def stiffness_trace(scene: Scene, time: Array, tolerance: float = EXACT) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, each at its instant's load and angles.

    Zero where there is no load and no ball is pressed. The `stiffness` of `equilibrium`, in half the time where many
    instants follow closely. `tolerance` is the share of the load that may be left unbalanced. Raises SimulationFailed
    where no position carries the load.
    """
    time = np.ascontiguousarray(time, dtype=np.float64)
    stiffness, position = np.zeros((time.size, 3)), np.zeros((time.size, 2))
    require_carried(scene, time, _follow(assemble(scene), motion_model(scene), time, tolerance, position, stiffness))
    return stiffness


@njit_lean
def _follow(
    contacts: Contacts, motion: MotionModel, time: Array, tolerance: float, position: Array, stiffness: Array
) -> int:
    """Fill `stiffness` (T, 3), N/m, along the way of the shaft, `position` (T, 2), m; the first instant at which no
    position carries the load, or T."""
    lost = time.size
    for k in range(time.size):
        x, y = expected(position, k, 1)
        position[k, 0], position[k, 1], sums, carried = rest_at(contacts, motion, time[k], x, y, tolerance)
        stiffness[k, 0], stiffness[k, 1], stiffness[k, 2] = sums.xx, sums.yy, sums.xy
        lost = lost if carried else min(lost, k)
    return lost


def stiffness_at(scene: Scene, time: Array, displacement: Array) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, where the inner ring has the `displacement` (T, 2),
    m, from the outer ring: that of the contacts in motion [P14 Eq. 26]."""
    return _stiffness_at(assemble(scene), time, np.ascontiguousarray(displacement))


@njit
def _stiffness_at(contacts: Contacts, time: Array, displacement: Array) -> Array:
    stiffness = np.zeros((time.size, 3))
    for k in range(time.size):
        set_time(contacts, time[k])
        sums = elastic(contacts, displacement[k, 0], displacement[k, 1])
        stiffness[k] = sums.xx, sums.yy, sums.xy
    return stiffness


def symmetric_matrices(components: Array) -> Array:
    """Symmetric matrices (…, 2, 2) from components (…, 3) in the order xx, yy, xy."""
    xx, yy, xy = np.moveaxis(np.asarray(components), -1, 0)
    return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
