"""The linear part of the motion in modal form: outer ring, resonator, and inner ring on a spring in the balls' place.

Each direction is z' = A z + b r + e w with z = (xi, vi, xo, vo, xr, vr). The spring k and damper c that stand for the
mean contact belong to A; r is what the true contact force differs from them, w the outer load. In the eigenvectors of A
every mode is one complex amplitude that turns by itself, so a step of any length costs a few numbers. What is left to
integrate numerically is only the small and slow r. The static deflection and the response to loads that turn with
the shaft are exact and taken off beforehand.
"""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_lean
from physics.arrays import Array, ComplexArray
from physics.contact.turning import cosine_sine
from physics.motion import MotionModel, axis_matrix

# Displacement along x and y (m) and velocity along x and y (m/s) of the inner relative to the outer ring.
Motion = tuple[float, float, float, float]

# A direction has three pairs of amplitudes: real and imaginary part of a swinging mode, or two modes that only decay.
PAIRS, PER_AXIS, AMPLITUDES = 3, 6, 12
# What is read from the amplitudes, and what the loads alone add to it: displacement, velocity and acceleration of the
# inner relative to the outer ring but for the contact force, acceleration of the resonator, the direction's six states
# (among them the outer ring's displacement and velocity), the outer ring's acceleration but for the force on it.
DISPLACEMENT, VELOCITY, ACCELERATION, OUTPUT, SHAPE = range(5)
OUTER, OUTER_SPEED, OUTER_ACCELERATION = SHAPE + 2, SHAPE + 3, SHAPE + 6
READINGS = 11
STATES = slice(SHAPE, OUTER_ACCELERATION)
# Two eigenvalues nearer to each other than this share of their size lose the digits that their modes stand for.
NEAREST = 1e-8
DEFECT_SHIFT = 1e-6


class LinearFlow(NamedTuple):
    """Modes of both directions, as the kernels read them; amplitudes are numbered direction, pair, part.

    `rate` (12,) 1/s: real and imaginary part of a swinging pair's eigenvalue, or the eigenvalues of two decaying modes.
    `twist` (6,): 1 for a swinging pair, 0 for a decaying one. `kick` (12,): amplitudes per N s of contact force.
    `read` (11, 12): the amplitudes' shares in the readings. `stiffness`, `damping`: the spring (N/m) and damper (N s/m)
    along x and y that stand for the contacts. `jump` (1/kg): relative acceleration per unit of contact force. `rest`,
    `cosine`, `sine` (2, 11): what the loads alone do, constant and turning at `shaft_speed`. `fastest` (1/s): the
    largest size of an eigenvalue.
    """

    rate: Array
    twist: Array
    kick: Array
    read: Array
    stiffness: tuple[float, float]
    damping: tuple[float, float]
    jump: float
    rest: Array
    cosine: Array
    sine: Array
    turning: bool
    shaft_speed: float
    outer_mass: float
    fastest: float


def linear_flow(motion: MotionModel, stiffness: tuple[float, float], damping: tuple[float, float]) -> LinearFlow:
    """The modes of `motion` with springs `stiffness` (N/m, above zero) and dampers (N s/m) in place of the contacts."""
    table, twist = np.zeros((2 + READINGS, AMPLITUDES)), np.zeros(2 * PAIRS)
    rest, cosine, sine = np.zeros((3, 2, READINGS))
    matrices = np.array([axis_matrix(motion, axis, stiffness[axis], damping[axis]) for axis in range(2)])
    fastest = 0.0
    for axis, modes in enumerate(_modes(motion, matrices, stiffness)):
        column = axis * PER_AXIS
        for value, shape in modes:
            fastest = max(fastest, abs(value))
            read = _read(motion, shape)
            read[ACCELERATION], read[OUTER_ACCELERATION] = read[VELOCITY] * value, shape[3] * value
            parts = np.array([value, _push(motion, axis, damping[axis], value, shape), *read])
            if value.imag > 0.0:
                # Readings are real parts: of twice the share's conjugate and the amplitude.
                table[:, column], table[:, column + 1] = parts.real, parts.imag
                table[2:, column] *= 2.0
                table[2:, column + 1] *= -2.0
                twist[column // 2] = 1.0
                column += 2
            else:
                table[:, column] = parts.real
                column += 1
        rest[axis], cosine[axis], sine[axis] = _loaded(motion, axis, matrices[axis], stiffness[axis])
    return LinearFlow(
        rate=table[0],
        twist=twist,
        kick=table[1],
        read=table[2:],
        stiffness=stiffness,
        damping=damping,
        jump=-(1.0 / motion.inner_mass + 1.0 / motion.outer_mass),
        rest=rest,
        cosine=cosine,
        sine=sine,
        turning=bool(cosine.any() or sine.any()),
        shaft_speed=motion.shaft_speed,
        outer_mass=motion.outer_mass,
        fastest=fastest,
    )


def _read(motion: MotionModel, state: Sequence[complex]) -> list[complex]:
    """Readings (11) of a state (6); the two that need a rate of change are left zero."""
    xi, vi, xo, vo, xr, vr = state
    pull = motion.resonator_stiffness * (xo - xr) + motion.resonator_damping * (vo - vr)
    return [xi - xo, vi - vo, 0.0, pull / motion.resonator_mass, *state, 0.0]


def _modes(
    motion: MotionModel, matrices: Array, stiffness: tuple[float, float]
) -> list[list[tuple[complex, list[complex]]]]:
    """Eigenvalue and eigenvector (6) of every mode along x and y, swinging ones first, of each pair the upper one."""
    # Velocities are scaled by a frequency so that displacements and velocities are of one size.
    fast = np.sqrt(np.array(stiffness) / motion.inner_mass + 1.0)
    scale = np.ones((2, PER_AXIS))
    scale[:, 1::2] = fast[:, None]
    scaled = matrices / scale[:, :, None] * scale[:, None, :]
    values, vectors = np.linalg.eig(scaled)
    if _nearest(values) < NEAREST:
        # Two modes coincide (critical damping): the least shift that parts them stays far below any accuracy asked.
        scaled[:, 1::2, 1::2] *= 1.0 + DEFECT_SHIFT
        values, vectors = np.linalg.eig(scaled)
    vectors = vectors * scale[:, :, None]
    found = []
    for axis in range(2):
        every = zip(values[axis].tolist(), vectors[axis].T.tolist(), strict=True)
        upper = [(complex(value), shape) for value, shape in every if value.imag >= 0.0]
        found.append(sorted(upper, key=lambda mode: mode[0].imag <= 0.0))
    return found


def _nearest(values: NDArray[Any]) -> float:
    """Least distance of two eigenvalues of a direction (2, 6), over their size."""
    apart = np.abs(values[:, :, None] - values[:, None, :]) + np.abs(values).max() * np.eye(PER_AXIS)
    return float((apart / np.abs(values[:, :, None])).min())


def _push(motion: MotionModel, axis: int, damping: float, value: complex, shape: Sequence[complex]) -> complex:
    """Amplitude per N s of contact force: a shape φ of symmetric M, C, K takes φᵀf / φᵀ(2λM + C)φ of a force f."""
    xi, _, xo, _, xr, _ = shape
    mass = motion.inner_mass * xi**2 + motion.outer_mass * xo**2 + motion.resonator_mass * xr**2
    film = damping * (xi - xo) ** 2 + motion.resonator_damping * (xo - xr) ** 2
    return (xo - xi) / (2.0 * value * mass + film + float(motion.support_damping[axis]) * xo**2)


def _loaded(motion: MotionModel, axis: int, matrix: Array, stiffness: float) -> tuple[Array, Array, Array]:
    """Constant, cosine and sine parts (11,) of what the outer loads alone do along one axis."""
    load = motion.load if axis == 1 else 0.0
    outer = -load / float(motion.support_stiffness[axis])
    still = _read(motion, [outer - load / stiffness, 0.0, outer, 0.0, outer, 0.0])
    turning = motion.unbalance_force * cmath.exp(1j * motion.unbalance_phase) * (1.0 if axis == 0 else -1j)
    turning -= load * motion.load_fluctuation * cmath.exp(1j * motion.fluctuation_phase)
    if turning == 0.0:
        return np.real(still), np.zeros(READINGS), np.zeros(READINGS)
    speed = motion.shaft_speed
    push = np.array([0.0, turning / motion.inner_mass, 0.0, 0.0, 0.0, 0.0])
    state = np.linalg.solve(1j * speed * np.eye(PER_AXIS) - matrix, push).tolist()
    swing = _read(motion, state)
    swing[ACCELERATION], swing[OUTER_ACCELERATION] = 1j * speed * swing[VELOCITY], 1j * speed * state[3]
    return np.real(still), np.real(swing), -np.imag(swing)


@njit_inline
def weigh(shares: Array, first: int, amplitudes: Array, axis: int) -> float:
    """Sum of six `shares` from the place `first` on times the `amplitudes` (12,) of one direction."""
    total = 0.0
    for k in range(PER_AXIS):
        total += shares[first + k] * amplitudes[axis * PER_AXIS + k]
    return total


@njit_inline
def reading(flow: LinearFlow, row: int, amplitudes: Array, axis: int) -> float:
    """What the amplitudes (12,) of one direction add to a reading."""
    return weigh(flow.read[row], axis * PER_AXIS, amplitudes, axis)


@njit_inline
def relative(flow: LinearFlow, amplitudes: Array, rest: Array) -> Motion:
    """Motion of the inner relative to the outer ring."""
    return (
        rest[0, DISPLACEMENT] + reading(flow, DISPLACEMENT, amplitudes, 0),
        rest[1, DISPLACEMENT] + reading(flow, DISPLACEMENT, amplitudes, 1),
        rest[0, VELOCITY] + reading(flow, VELOCITY, amplitudes, 0),
        rest[1, VELOCITY] + reading(flow, VELOCITY, amplitudes, 1),
    )


@njit_inline
def set_rest(flow: LinearFlow, time: float, rest: Array) -> None:
    """Bring `rest` (2, 11), what the loads alone do, to `time` (s)."""
    if flow.turning:
        cosine, sine = cosine_sine(flow.shaft_speed * time)
        for axis in range(2):
            for column in range(READINGS):
                rest[axis, column] = (
                    flow.rest[axis, column] + cosine * flow.cosine[axis, column] + sine * flow.sine[axis, column]
                )


def amplitudes_of(flow: LinearFlow, state: Array) -> Array:
    """Amplitudes (12,) of the physical state (12,) at t = 0."""
    found = np.zeros(AMPLITUDES)
    for axis in range(2):
        here = slice(axis * PER_AXIS, (axis + 1) * PER_AXIS)
        away = state[[axis, 6 + axis, 2 + axis, 8 + axis, 4 + axis, 10 + axis]]
        away = away - flow.rest[axis, STATES] - flow.cosine[axis, STATES]
        found[here] = np.linalg.solve(flow.read[STATES, here], away)
    return found


@njit_lean
def physical_state(flow: LinearFlow, time: float, amplitudes: Array, state: Array) -> None:
    """Fill `state` (12,), displacements (m) then velocities (m/s), from the `amplitudes` (12,) at `time`."""
    cosine, sine = cosine_sine(flow.shaft_speed * time)
    for axis in range(2):
        for part in range(6):
            row = SHAPE + part
            value = flow.rest[axis, row] + cosine * flow.cosine[axis, row] + sine * flow.sine[axis, row]
            state[part // 2 * 2 + part % 2 * 6 + axis] = value + reading(flow, row, amplitudes, axis)


def slowest_decay(flow: LinearFlow) -> float:
    """Rate (1/s) at which the amplitude of the mode falls that falls slowest; 0 if one does not."""
    return min(float(np.abs(complex_modes(flow, (flow.rate,), axis).real).min()) for axis in range(2))


def complex_modes(flow: LinearFlow, values: tuple[Array, ...], axis: int) -> ComplexArray:
    """Of the real numbers `values` (N times 12) those of one direction as complex ones (N, modes)."""
    pairs = np.array(values)[:, axis * PER_AXIS : (axis + 1) * PER_AXIS].reshape(-1, PAIRS, 2)
    swinging = flow.twist[axis * PAIRS : (axis + 1) * PAIRS] > 0.0
    upper, decaying = pairs[:, swinging], pairs[:, ~swinging]
    return np.concatenate([upper[:, :, 0] + 1j * upper[:, :, 1], decaying.reshape(len(values), -1)], axis=1)
