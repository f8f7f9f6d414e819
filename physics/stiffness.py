"""The quasi-static stiffness of the bearing over time, the parametric excitation behind the vibration [P14 Eq. 26]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit
from physics.assembly import assemble
from physics.contact import Law, Track, set_time
from physics.rest import elastic
from physics.scene import Scene
from physics.statics import quasi_static_stiffness

Array = NDArray[np.float64]

COMPONENTS = ("xx", "yy", "xy")


def stiffness_trace(scene: Scene, time: Array) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, each at its instant's load and angles.

    Zero where no ball is loaded.
    """
    return quasi_static_stiffness(scene, time)


def stiffness_at(scene: Scene, time: Array, displacement: Array) -> Array:
    """Stiffness (T, 3): kxx, kyy, kxy in N/m at the times (T,), s, where the inner ring has the `displacement` (T, 2),
    m, from the outer ring: that of the contacts in motion [P14 Eq. 26]."""
    model = assemble(scene)
    return _stiffness_at(model.balls, model.frames, model.law, model.track, time, np.ascontiguousarray(displacement))


@njit
def _stiffness_at(balls: Array, frames: Array, law: Law, track: Track, time: Array, displacement: Array) -> Array:
    stiffness = np.zeros((time.size, 3))
    for k in range(time.size):
        set_time(balls, frames, track, time[k])
        hold = elastic(balls, frames, law, displacement[k, 0], displacement[k, 1])
        stiffness[k] = hold.xx, hold.yy, hold.xy
    return stiffness


def matrix(components: Array) -> Array:
    """Symmetric matrices (…, 2, 2) from components (…, 3) in the order xx, yy, xy."""
    xx, yy, xy = np.moveaxis(np.asarray(components), -1, 0)
    return np.stack([np.stack([xx, xy], axis=-1), np.stack([xy, yy], axis=-1)], axis=-2)
