"""Equations of motion of inner ring, outer ring and resonator around the contact forces [P14 Eq. 11-16].

State (12,): displacements xi, yi, xo, yo, xr, yr (m), then their velocities (m/s).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from physics._jit import njit_lean
from physics.arrays import Array
from physics.contact.turning import cosine_sine
from physics.scene import Scene


class MotionModel(NamedTuple):
    """Masses (kg), springs (N/m), dampers (N s/m), loads (N) and shaft speed (rad/s) as the kernels read them.

    `support_stiffness`, `support_damping`: along x and along y.
    """

    inner_mass: float
    outer_mass: float
    resonator_mass: float
    support_stiffness: tuple[float, float]
    support_damping: tuple[float, float]
    resonator_stiffness: float
    resonator_damping: float
    load: float
    load_fluctuation: float
    fluctuation_phase: float
    unbalance_force: float
    unbalance_phase: float
    shaft_speed: float


def motion_model(scene: Scene) -> MotionModel:
    """The numbers of the equations of motion of `scene`, as floats: kernels are compiled again for every other type."""
    rig, run = scene.rig, scene.operation
    return MotionModel(
        inner_mass=float(rig.inner_mass),
        outer_mass=float(rig.outer_mass),
        resonator_mass=float(rig.resonator_mass),
        support_stiffness=(float(rig.support_stiffness_x), float(rig.support_stiffness_y)),
        support_damping=(float(rig.support_damping_x), float(rig.support_damping_y)),
        resonator_stiffness=float(rig.resonator_stiffness),
        resonator_damping=float(rig.resonator_damping),
        load=float(run.load),
        load_fluctuation=float(run.load_fluctuation),
        fluctuation_phase=float(run.fluctuation_phase),
        unbalance_force=float(run.unbalance_force),
        unbalance_phase=float(run.unbalance_phase),
        shaft_speed=float(run.shaft_speed),
    )


@njit_lean
def outer_load(motion: MotionModel, time: float) -> tuple[float, float]:
    """Load on the shaft along x and y at `time`, N: unbalance, and the static load with its fluctuation."""
    if motion.unbalance_force == 0.0 and motion.load_fluctuation == 0.0:
        return 0.0, -motion.load
    turn = motion.shaft_speed * time
    swing, _ = cosine_sine(turn + motion.fluctuation_phase)
    cosine, sine = cosine_sine(turn + motion.unbalance_phase)
    load = motion.load * (1.0 + motion.load_fluctuation * swing)
    return motion.unbalance_force * cosine, motion.unbalance_force * sine - load


@njit_lean
def resonator_acceleration(motion: MotionModel, state: Array, axis: int) -> float:
    """Acceleration of the resonator's mass along x (0) or y (1), m/s²."""
    stretch = state[2 + axis] - state[4 + axis]
    rate = state[8 + axis] - state[10 + axis]
    return (motion.resonator_stiffness * stretch + motion.resonator_damping * rate) / motion.resonator_mass


@njit_lean
def outer_ring_acceleration(motion: MotionModel, state: Array, axis: int, force: float) -> float:
    """Acceleration of the outer ring along one axis, m/s², under the contact force (N) on it [P14 Eq. 11, 13-15]."""
    outer = force - motion.support_stiffness[axis] * state[2 + axis] - motion.support_damping[axis] * state[8 + axis]
    outer -= motion.resonator_mass * resonator_acceleration(motion, state, axis)
    return outer / motion.outer_mass


@njit_lean
def relative_acceleration(motion: MotionModel, state: Array, axis: int, load: float, force: float) -> float:
    """Acceleration of the inner relative to the outer ring along one axis, m/s², under load and contact force (N)."""
    return (load - force) / motion.inner_mass - outer_ring_acceleration(motion, state, axis, force)


def axis_matrix(motion: MotionModel, axis: int, k: float, c: float) -> list[list[float]]:
    """A (6, 6) of (xi, vi, xo, vo, xr, vr) along one axis, contacts replaced by spring and damper [P14 Eq. 11-16]."""
    mi, mo, mr = motion.inner_mass, motion.outer_mass, motion.resonator_mass
    kr, cr = motion.resonator_stiffness, motion.resonator_damping
    ko, co = float(motion.support_stiffness[axis]), float(motion.support_damping[axis])
    return [
        [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
        [-k / mi, -c / mi, k / mi, c / mi, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
        [k / mo, c / mo, -(k + ko + kr) / mo, -(c + co + cr) / mo, kr / mo, cr / mo],
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, kr / mr, cr / mr, -kr / mr, -cr / mr],
    ]


def starting_state(motion: MotionModel, displacement: Array) -> Array:
    """State (12,) at rest in quasi-static equilibrium, for inner relative to outer displacement (2,) m at t = 0."""
    state = np.zeros(12)
    for axis, load in enumerate(outer_load(motion, 0.0)):
        outer = load / motion.support_stiffness[axis]
        state[axis] = outer + displacement[axis]
        state[2 + axis] = state[4 + axis] = outer
    return state
