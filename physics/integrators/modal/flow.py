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

# Rows of `rows`, real and imaginary part each: eigenvalue (1/s), amplitude of the mode per unit of contact force, and
# the modes' shares in what is read from them: displacement, velocity and acceleration of the inner relative to the
# outer ring, acceleration of the resonator, from SHAPE on the six states of the direction (among them the outer ring's
# displacement and velocity), and the outer ring's acceleration but for the force on it.
RATE, KICK, DISPLACEMENT, VELOCITY, ACCELERATION, OUTPUT, SHAPE = 0, 2, 4, 6, 8, 10, 12
OUTER, OUTER_SPEED, OUTER_ACCELERATION = SHAPE + 4, SHAPE + 6, 24
FLOW_ROWS = 26
# Columns of `rest`: displacement, velocity and acceleration of inner relative to outer ring, resonator acceleration,
# from STATE on the six states (among them the outer ring's displacement and velocity), its acceleration.
REST_RELATIVE, REST_OUTPUT, REST_STATE = 0, 3, 4
REST_OUTER = REST_STATE + 2
REST_OUTER_ACCELERATION = 10
REST_COLUMNS = 11
STATES = slice(REST_STATE, REST_OUTER_ACCELERATION)
# Places of the first readings, in the order of the rows from DISPLACEMENT on.
DISPLACEMENT_READING, VELOCITY_READING, ACCELERATION_READING, OUTPUT_READING = range(4)
# An eigenvector basis worse conditioned than this loses the digits that its modes stand for.
WORST_CONDITION = 1e9
DEFECT_SHIFT = 1e-6


class LinearFlow(NamedTuple):
    """Modes of both directions, as the kernels read them.

    `rows` (26, 2, M): rows, then x or y, then mode. `stiffness`, `damping`: the spring (N/m)
    and damper (N s/m) along x and y that stand for the contacts. `jump` (1/kg): relative acceleration per unit of
    contact force. `rest`, `cosine`, `sine` (2, 11): what the loads alone do, constant and turning at `shaft_speed`.
    """

    rows: Array
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
    bases = [_modes(motion, axis, stiffness[axis], damping[axis]) for axis in range(2)]
    rows = np.zeros((FLOW_ROWS, 2, max(basis[0].size for basis in bases)))
    rest, cosine, sine = np.zeros((3, 2, REST_COLUMNS))
    for axis, (rate, shape, kick) in enumerate(bases):
        read = _readings(motion, axis, shape)
        read[ACCELERATION_READING] = read[VELOCITY_READING] * rate
        read[REST_OUTER_ACCELERATION] = shape[3] * rate
        reads = zip(range(4, FLOW_ROWS, 2), read, strict=True)
        for row, values in ((RATE, rate), (KICK, kick), *reads):
            rows[row, axis, : rate.size], rows[row + 1, axis, : rate.size] = values.real, values.imag
        matrix, push = _matrix(motion, axis, stiffness[axis], damping[axis]), _push(motion)
        for target, response in zip((rest, cosine, sine), _loaded(motion, axis, matrix, push), strict=True):
            target[axis] = response
    return LinearFlow(
        rows=rows,
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


def _readings(motion: MotionModel, axis: int, states: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Readings (11, M) of states (6, M); the two that need a rate of change are left zero."""
    read = np.zeros((REST_COLUMNS, states.shape[1]), dtype=np.complex128)
    xi, vi, xo, vo, xr, vr = states
    read[DISPLACEMENT_READING], read[VELOCITY_READING] = xi - xo, vi - vo
    read[OUTPUT_READING] = (
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


def _push(motion: MotionModel) -> Array:
    return np.array([0.0, 1.0 / motion.inner_mass, 0.0, 0.0, 0.0, 0.0])


def _modes(
    motion: MotionModel, axis: int, k: float, c: float
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    """Eigenvalues (M,), right eigenvectors (6, M) and amplitudes per unit of contact force (M,).

    Of a pair only the one with positive frequency is kept, its vectors doubled: readings are real parts.
    """
    matrix = _matrix(motion, axis, k, c)
    # Velocities are scaled by a frequency so that displacements and velocities are of one size.
    scale = np.array([1.0, math.sqrt(k / motion.inner_mass + 1.0)] * 3)
    scaled = matrix / scale[:, None] * scale[None, :]
    values, vectors = np.linalg.eig(scaled)
    if np.linalg.cond(vectors) > WORST_CONDITION:
        # Two modes coincide (critical damping): the least shift that parts them stays far below any accuracy asked.
        scaled[1::2, 1::2] *= 1.0 + DEFECT_SHIFT
        values, vectors = np.linalg.eig(scaled)
    force = np.array([0.0, -1.0 / motion.inner_mass, 0.0, 1.0 / motion.outer_mass, 0.0, 0.0]) / scale
    kick = np.linalg.solve(vectors, force)
    kept = values.imag >= 0.0
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
    read = _readings(motion, axis, np.column_stack([still.astype(np.complex128), swing]))
    read[ACCELERATION_READING, 1] = 1j * speed * read[VELOCITY_READING, 1]
    read[REST_OUTER_ACCELERATION, 1] = 1j * speed * swing[3]
    return read[:, 0].real, read[:, 1].real, -read[:, 1].imag


@njit_inline
def reading(rows: Array, row: int, state: Array, axis: int) -> float:
    """What the modes of one axis in `state` (2, 2, M) add up to in the reading that starts at `row`."""
    total = 0.0
    for mode in range(state.shape[2]):
        total += rows[row, axis, mode] * state[0, axis, mode] - rows[row + 1, axis, mode] * state[1, axis, mode]
    return total


@njit_inline
def relative(rows: Array, state: Array, rest: Array) -> tuple[float, float, float, float]:
    """Displacement x, y (m) and velocity x, y (m/s) of the inner relative to the outer ring."""
    x, y, u, v = rest[0, 0], rest[1, 0], rest[0, 1], rest[1, 1]
    for mode in range(state.shape[2]):
        x += rows[DISPLACEMENT, 0, mode] * state[0, 0, mode] - rows[DISPLACEMENT + 1, 0, mode] * state[1, 0, mode]
        y += rows[DISPLACEMENT, 1, mode] * state[0, 1, mode] - rows[DISPLACEMENT + 1, 1, mode] * state[1, 1, mode]
        u += rows[VELOCITY, 0, mode] * state[0, 0, mode] - rows[VELOCITY + 1, 0, mode] * state[1, 0, mode]
        v += rows[VELOCITY, 1, mode] * state[0, 1, mode] - rows[VELOCITY + 1, 1, mode] * state[1, 1, mode]
    return x, y, u, v


@njit_inline
def set_rest(flow: LinearFlow, time: float, rest: Array) -> None:
    """Bring `rest` (2, 11), what the loads alone do, to `time` (s)."""
    if flow.turning:
        cosine, sine = math.cos(flow.shaft_speed * time), math.sin(flow.shaft_speed * time)
        for axis in range(2):
            for column in range(REST_COLUMNS):
                rest[axis, column] = (
                    flow.rest[axis, column] + cosine * flow.cosine[axis, column] + sine * flow.sine[axis, column]
                )


def amplitudes(flow: LinearFlow, state: Array) -> Array:
    """Amplitudes (2, 2, M), real and imaginary first, of the physical state (12,) at t = 0."""
    found = np.zeros((2, 2, flow.rows.shape[2]))
    for axis in range(2):
        away = state[[axis, 6 + axis, 2 + axis, 8 + axis, 4 + axis, 10 + axis]]
        away = away - flow.rest[axis, STATES] - flow.cosine[axis, STATES]
        real, imaginary = (
            flow.rows[SHAPE:OUTER_ACCELERATION:2, axis],
            -flow.rows[SHAPE + 1 : OUTER_ACCELERATION : 2, axis],
        )
        used = np.any(real != 0.0, axis=0)
        swinging = flow.rows[RATE + 1, axis] != 0.0
        solved = np.linalg.solve(np.concatenate([real[:, used], imaginary[:, swinging]], axis=1), away)
        found[0, axis, used] = solved[: used.sum()]
        found[1, axis, swinging] = solved[used.sum() :]
    return found


@njit_lean
def physical_state(flow: LinearFlow, time: float, modal: Array, state: Array) -> None:
    """Fill `state` (12,), displacements (m) then velocities (m/s), from the amplitudes `modal` (2, 2, M) at `time`."""
    cosine, sine = math.cos(flow.shaft_speed * time), math.sin(flow.shaft_speed * time)
    for axis in range(2):
        for part in range(6):
            column = REST_STATE + part
            value = flow.rest[axis, column] + cosine * flow.cosine[axis, column] + sine * flow.sine[axis, column]
            value += reading(flow.rows, SHAPE + 2 * part, modal, axis)
            state[part // 2 * 2 + part % 2 * 6 + axis] = value


def ringing(flow: LinearFlow) -> float:
    """What a push of 1 N s between the rings leaves in the resonator's acceleration: ∫ a² dt, m²/s³ per (N s)².

    The larger of both directions.
    """
    sums = []
    for axis in range(2):
        rate = flow.rows[RATE, axis] + 1j * flow.rows[RATE + 1, axis]
        share = (flow.rows[OUTPUT, axis] + 1j * flow.rows[OUTPUT + 1, axis]) * (
            flow.rows[KICK, axis] + 1j * flow.rows[KICK + 1, axis]
        )
        used = rate.real < 0.0
        rate, share = rate[used], share[used]
        # Re(s e^λt) Re(s' e^λ't), integrated from 0 to ∞, for all pairs of modes.
        same = share[:, None] * share / (rate[:, None] + rate)
        mixed = share[:, None] * share.conj() / (rate[:, None] + rate.conj())
        sums.append(-0.5 * float((same + mixed).sum().real))
    return max(sums)
