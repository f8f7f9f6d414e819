"""Accelerations of the six displacements, for methods that treat every coordinate alike [P14 Eq. 11-16]."""

from __future__ import annotations

from physics._jit import njit_inline
from physics.arrays import Array
from physics.motion import MotionModel, outer_load, outer_ring_acceleration, resonator_acceleration


@njit_inline
def accelerations(motion: MotionModel, time: float, state: Array, force: tuple[float, float], result: Array) -> None:
    """Fill `result` (6,), m/s², for inner ring, outer ring and resonator under the net contact `force` (N)."""
    load = outer_load(motion, time)
    for axis in range(2):
        result[axis] = (load[axis] - force[axis]) / motion.inner_mass
        result[2 + axis] = outer_ring_acceleration(motion, state, axis, force[axis])
        result[4 + axis] = resonator_acceleration(motion, state, axis)
