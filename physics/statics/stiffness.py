"""The stiffness of the contacts, the parametric excitation behind the vibration [P14 Eq. 26]."""

from __future__ import annotations

import numpy as np

from physics._jit import njit
from physics.arrays import Array
from physics.assembly import assemble
from physics.contact.forces import Contacts, set_time
from physics.scene import Scene
from physics.statics.rest import elastic


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
