"""The linear part of the motion in modal form: outer ring, resonator, and inner ring on a spring in the balls' place.

Each direction is z' = A z + b r + e w with z = (xi, vi, xo, vo, xr, vr): the spring k and damper c that stand for the
mean contact belong to A, r is what the true contact force differs from them, w the outer load. In the eigenvectors of A
every mode is one complex amplitude that turns by itself, so a step of any length costs a few numbers, and what is left
to integrate numerically is only the small and slow r. The static deflection and the response to loads that turn with
the shaft are exact and taken off beforehand.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_lean
from physics.motion import MotionModel

Array = NDArray[np.float64]

# A direction has three pairs of amplitudes: real and imaginary part of a swinging mode, or two modes that only decay.
PAIRS, AXIS, AMPLITUDES = 3, 6, 12
# What is read from the amplitudes, and what the loads alone add to it: displacement, velocity and acceleration of the
# inner relative to the outer ring but for the contact force, acceleration of the resonator, the direction's six states
# (among them the outer ring's displacement and velocity), the outer ring's acceleration but for the force on it.
DISPLACEMENT, VELOCITY, ACCELERATION, OUTPUT, SHAPE = range(5)
OUTER, OUTER_SPEED, OUTER_ACCELERATION = SHAPE + 2, SHAPE + 3, SHAPE + 6
READINGS = 11
STATES = slice(SHAPE, OUTER_ACCELERATION)
# An eigenvector basis worse conditioned than this loses the digits that its modes stand for.
WORST_CONDITION = 1e9
DEFECT_SHIFT = 1e-6


class LinearFlow(NamedTuple):
    """Modes of both directions, as the kernels read them; amplitudes are numbered direction, pair, part.

    `rate` (12,) 1/s: real and imaginary part of a swinging pair's eigenvalue, or the eigenvalues of two decaying modes.
    `twist` (6,): 1 for a swinging pair, 0 for a decaying one. `kick` (12,): amplitudes per unit of contact force.
    `read` (11, 12): the amplitudes' shares in the readings. `stiffness`, `damping`: the spring (N/m) and damper (N s/m)
    along x and y that stand for the contacts. `jump` (1/kg): relative acceleration per unit of contact force. `rest`,
    `cosine`, `sine` (2, 11): what the loads alone do, constant and turning at `shaft_speed`.
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


def linear_flow(motion: MotionModel, stiffness: tuple[float, float], damping: tuple[float, float]) -> LinearFlow:
    """The modes of `motion` with springs `stiffness` (N/m, above zero) and dampers (N s/m) in place of the contacts."""
    rate, kick, twist = np.zeros(AMPLITUDES), np.zeros(AMPLITUDES), np.zeros(2 * PAIRS)
    read = np.zeros((READINGS, AMPLITUDES))
    rest, cosine, sine = np.zeros((3, 2, READINGS))
    for axis in range(2):
        matrix = _matrix(motion, axis, stiffness[axis], damping[axis])
        values, shape, push = _modes(motion, matrix, stiffness[axis])
        shares = _readings(motion, shape)
        shares[ACCELERATION] = shares[VELOCITY] * values
        shares[OUTER_ACCELERATION] = shape[3] * values
        swinging, here = values.imag > 0.0, slice(axis * AXIS, (axis + 1) * AXIS)
        rate[here], kick[here] = _parts(values, swinging), _parts(push, swinging)
        read[:, here] = _parts(shares.conj(), swinging)
        twist[axis * PAIRS : axis * PAIRS + swinging.sum()] = 1.0
        loaded = _loaded(motion, axis, matrix, np.array([0.0, 1.0 / motion.inner_mass, 0.0, 0.0, 0.0, 0.0]))
        rest[axis], cosine[axis], sine[axis] = loaded
    return LinearFlow(
        rate=rate,
        twist=twist,
        kick=kick,
        read=read,
        stiffness=stiffness,
        damping=damping,
        jump=-(1.0 / motion.inner_mass + 1.0 / motion.outer_mass),
        rest=rest,
        cosine=cosine,
        sine=sine,
        turning=bool(np.any(cosine) or np.any(sine)),
        shaft_speed=motion.shaft_speed,
        outer_mass=motion.outer_mass,
    )


def _parts(values: NDArray[np.complex128], swinging: NDArray[np.bool_]) -> Array:
    """Values (..., M) of the modes as real numbers (..., 6): both parts of the swinging, then the decaying ones."""
    both = np.stack([values[..., swinging].real, values[..., swinging].imag], axis=-1)
    return np.concatenate([both.reshape(*values.shape[:-1], -1), values[..., ~swinging].real], axis=-1)


def _readings(motion: MotionModel, states: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Readings (11, M) of states (6, M); the two that need a rate of change are left zero."""
    read = np.zeros((READINGS, states.shape[1]), dtype=np.complex128)
    xi, vi, xo, vo, xr, vr = states
    read[DISPLACEMENT], read[VELOCITY] = xi - xo, vi - vo
    read[OUTPUT] = (
        motion.resonator_stiffness * (xo - xr) + motion.resonator_damping * (vo - vr)
    ) / motion.resonator_mass
    read[STATES] = states
    return read


def _matrix(motion: MotionModel, axis: int, k: float, c: float) -> Array:
    """A (6, 6) of (xi, vi, xo, vo, xr, vr) along one axis, contacts replaced by spring and damper [P14 Eq. 11-16]."""
    mi, mo, mr = motion.inner_mass, motion.outer_mass, motion.resonator_mass
    kr, cr = motion.resonator_stiffness, motion.resonator_damping
    ko, co = float(motion.support_stiffness[axis]), float(motion.support_damping[axis])
    return np.array(
        [
            [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [-k / mi, -c / mi, k / mi, c / mi, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
            [k / mo, c / mo, -(k + ko + kr) / mo, -(c + co + cr) / mo, kr / mo, cr / mo],
            [0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, kr / mr, cr / mr, -kr / mr, -cr / mr],
        ]
    )


def _modes(
    motion: MotionModel, matrix: Array, stiffness: float
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    """Eigenvalues (M,), right eigenvectors (6, M) and amplitudes per unit of contact force (M,), swinging modes first.

    Of a pair only the one with positive frequency is kept, its vectors doubled: readings are real parts.
    """
    # Velocities are scaled by a frequency so that displacements and velocities are of one size.
    scale = np.array([1.0, math.sqrt(stiffness / motion.inner_mass + 1.0)] * 3)
    scaled = matrix / scale[:, None] * scale[None, :]
    values, vectors = np.linalg.eig(scaled)
    if np.linalg.cond(vectors) > WORST_CONDITION:
        # Two modes coincide (critical damping): the least shift that parts them stays far below any accuracy asked.
        scaled[1::2, 1::2] *= 1.0 + DEFECT_SHIFT
        values, vectors = np.linalg.eig(scaled)
    force = np.array([0.0, -1.0 / motion.inner_mass, 0.0, 1.0 / motion.outer_mass, 0.0, 0.0]) / scale
    kick = np.linalg.solve(vectors, force.astype(np.complex128))
    values = values.astype(np.complex128)
    kept = np.concatenate([np.flatnonzero(values.imag > 0.0), np.flatnonzero(values.imag == 0.0)])
    twice = np.where(values[kept].imag > 0.0, 2.0, 1.0)
    return values[kept], vectors[:, kept] * scale[:, None] * twice, kick[kept]


def _loaded(motion: MotionModel, axis: int, matrix: Array, push: Array) -> tuple[Array, Array, Array]:
    """Constant, cosine and sine parts (11,) of what the outer loads alone do along one axis."""
    steady = -motion.load if axis == 1 else 0.0
    turning = motion.unbalance_force * np.exp(1j * motion.unbalance_phase) * (1.0 if axis == 0 else -1j)
    if axis == 1:
        turning -= motion.load * motion.load_fluctuation * np.exp(1j * motion.fluctuation_phase)
    speed = motion.shaft_speed
    still = np.linalg.solve(-matrix, push) * steady
    swing = np.linalg.solve(1j * speed * np.eye(6) - matrix, push) * turning
    read = _readings(motion, np.column_stack([still.astype(np.complex128), swing]))
    read[ACCELERATION, 1] = 1j * speed * read[VELOCITY, 1]
    read[OUTER_ACCELERATION, 1] = 1j * speed * swing[3]
    return read[:, 0].real, read[:, 1].real, -read[:, 1].imag


@njit_inline
def weigh(shares: Array, first: int, amplitudes: Array, axis: int) -> float:
    """Sum of six `shares` from the place `first` on times the `amplitudes` (12,) of one direction."""
    total = 0.0
    for k in range(AXIS):
        total += shares[first + k] * amplitudes[axis * AXIS + k]
    return total


@njit_inline
def reading(flow: LinearFlow, row: int, amplitudes: Array, axis: int) -> float:
    """What the amplitudes (12,) of one direction add to a reading."""
    return weigh(flow.read[row], axis * AXIS, amplitudes, axis)


@njit_inline
def relative(flow: LinearFlow, amplitudes: Array, rest: Array) -> tuple[float, float, float, float]:
    """Displacement x, y (m) and velocity x, y (m/s) of the inner relative to the outer ring."""
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
        cosine, sine = math.cos(flow.shaft_speed * time), math.sin(flow.shaft_speed * time)
        for axis in range(2):
            for column in range(READINGS):
                rest[axis, column] = (
                    flow.rest[axis, column] + cosine * flow.cosine[axis, column] + sine * flow.sine[axis, column]
                )


def amplitudes_of(flow: LinearFlow, state: Array) -> Array:
    """Amplitudes (12,) of the physical state (12,) at t = 0."""
    found = np.zeros(AMPLITUDES)
    for axis in range(2):
        here = slice(axis * AXIS, (axis + 1) * AXIS)
        away = state[[axis, 6 + axis, 2 + axis, 8 + axis, 4 + axis, 10 + axis]]
        away = away - flow.rest[axis, STATES] - flow.cosine[axis, STATES]
        found[here] = np.linalg.solve(flow.read[STATES, here], away)
    return found


@njit_lean
def physical_state(flow: LinearFlow, time: float, amplitudes: Array, state: Array) -> None:
    """Fill `state` (12,), displacements (m) then velocities (m/s), from the `amplitudes` (12,) at `time`."""
    cosine, sine = math.cos(flow.shaft_speed * time), math.sin(flow.shaft_speed * time)
    for axis in range(2):
        for part in range(6):
            row = SHAPE + part
            value = flow.rest[axis, row] + cosine * flow.cosine[axis, row] + sine * flow.sine[axis, row]
            state[part // 2 * 2 + part % 2 * 6 + axis] = value + reading(flow, row, amplitudes, axis)


def ringing(flow: LinearFlow, duration: float) -> float:
    """What a push of 1 N s between the rings leaves in the resonator's acceleration: ∫ a² dt, m²/s³ per (N s)².

    The larger of both directions. A mode that rings on for longer than `duration` (s) counts as if it did not.
    """
    sums = []
    for axis in range(2):
        rate, kick, read = (_complex_modes(flow, values, axis) for values in (flow.rate, flow.kick, flow.read[OUTPUT]))
        rate, share = np.minimum(rate.real, -0.5 / duration) + 1j * rate.imag, read.conj() * kick
        # Re(s e^λt) Re(s' e^λ't), integrated from 0 to ∞, for all pairs of modes.
        same = share[:, None] * share / (rate[:, None] + rate)
        mixed = share[:, None] * share.conj() / (rate[:, None] + rate.conj())
        sums.append(-0.5 * float((same + mixed).sum().real))
    return max(sums)


def _complex_modes(flow: LinearFlow, values: Array, axis: int) -> NDArray[np.complex128]:
    """Of the real numbers `values` (12,) those of one direction as complex ones, one a mode."""
    pairs = values[axis * AXIS : (axis + 1) * AXIS].reshape(PAIRS, 2)
    swinging = flow.twist[axis * PAIRS : (axis + 1) * PAIRS] > 0.0
    return np.concatenate([pairs[swinging] @ np.array([1.0, 1j]), pairs[~swinging].ravel()])
