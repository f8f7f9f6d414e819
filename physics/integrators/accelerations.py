"""Accelerations of the six displacements, for methods that treat every coordinate alike [P14 Eq. 11-16]."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline
from physics.motion import MotionModel, outer_load, resonator_acceleration

Array = NDArray[np.float64]


@njit_inline
def accelerations(motion: MotionModel, time: float, state: Array, force: tuple[float, float], result: Array) -> None:
    """Fill `result` (6,), m/s², for inner ring, outer ring and resonator under the net contact `force` (N)."""
    load = outer_load(motion, time)
    for axis in range(2):
        resonator = resonator_acceleration(motion, state, axis)
        support = motion.support_stiffness[axis] * state[2 + axis] + motion.support_damping[axis] * state[8 + axis]
        result[axis] = (load[axis] - force[axis]) / motion.inner_mass
        result[2 + axis] = (force[axis] - support - motion.resonator_mass * resonator) / motion.outer_mass
        result[4 + axis] = resonator
