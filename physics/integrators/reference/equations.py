"""The equations of motion as the reference method reads them: ball by ball, no fast kernel [P14 Eq. 4-16]."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics._jit import njit
from physics.arrays import Array, Flags
from physics.cage import CagePath
from physics.paths.depth_path import DepthPath
from physics.paths.profile import build_path
from physics.scene import Scene

Cubics = tuple[Array, Array]
Turn = tuple[tuple[float, float], tuple[float, float]]


# Columns of `balls`: row from 0, angle ahead of the cage (rad), radial deviation (m).
BALL_ROW, AHEAD, DEVIATION = range(3)
# Columns of `spalls`: row from 0, angle (rad), travel sign, race speed (rad/s), its first entry in `path` and the first
# behind it.
SPALL_ROW, ANGLE, SIGN, SPALL_SPEED, FIRST, LAST = range(6)
# Columns of `waves`: order, amplitude (m), phase (rad), race speed (rad/s).
ORDER, AMPLITUDE, PHASE, WAVE_SPEED = range(4)


class ContactLaw(NamedTuple):
    """K (N/mⁿ), n, c_d (N s/m), cos α, radial clearance (m), and whether the force may not pull."""

    hertz_factor: float
    exponent: float
    film_damping: float
    cosine_of_contact_angle: float
    clearance: float
    no_tension: bool


class Loads(NamedTuple):
    """Static load (N), shaft speed (rad/s), and what turns with it: unbalance (N) and its phase (rad), and the static
    load's fluctuation (1) and its phase (rad)."""

    static: float
    shaft_speed: float
    unbalance: float
    unbalance_phase: float
    fluctuation: float
    fluctuation_phase: float


class Equations(NamedTuple):
    """A scene as numbers and arrays.

    `axes` (7, 2): columns x and y of inner, outer and resonator mass, support stiffness and damping, resonator
    stiffness and damping; `balls` (B, 3); `cages`: edges and polynomials of both rows' cage angles; `spalls` (S, 6);
    `path`: edges and polynomials of all drops; `waves` (W, 4).
    """

    axes: Array
    law: ContactLaw
    loads: Loads
    balls: Array
    cages: tuple[Cubics, Cubics]
    spalls: Array
    path: Cubics
    waves: Array


def write_equations(scene: Scene) -> Equations:
    """The equations of motion of `scene`."""
    rig, bearing, run = scene.rig, scene.rig.bearing, scene.operation
    deviation = np.array(scene.imperfections.ball_deviation or np.zeros((bearing.rows, bearing.balls)))
    radial_deviation = deviation / math.cos(bearing.contact_angle)
    row, ball = np.divmod(np.arange(bearing.rows * bearing.balls), bearing.balls)
    spalls, path = _spall_tables(scene)
    return Equations(
        axes=np.array(
            [
                [rig.inner_mass] * 2,
                [rig.outer_mass] * 2,
                [rig.resonator_mass] * 2,
                [rig.support_stiffness_x, rig.support_stiffness_y],
                [rig.support_damping_x, rig.support_damping_y],
                [rig.resonator_stiffness] * 2,
                [rig.resonator_damping] * 2,
            ]
        ),
        law=ContactLaw(
            hertz_factor=float(bearing.load_deflection),
            exponent=float(bearing.exponent),
            film_damping=float(rig.film_damping),
            cosine_of_contact_angle=math.cos(bearing.contact_angle),
            clearance=float(bearing.clearance),
            no_tension=scene.no_tension,
        ),
        loads=Loads(
            static=float(run.load),
            shaft_speed=float(run.shaft_speed),
            unbalance=float(run.unbalance_force),
            unbalance_phase=float(run.unbalance_phase),
            fluctuation=float(run.load_fluctuation),
            fluctuation_phase=float(run.fluctuation_phase),
        ),
        balls=np.column_stack([row, bearing.spacing * ball + bearing.stagger * row, radial_deviation.ravel()]),
        cages=(_cage_pieces(scene.cage), _cage_pieces(scene.second_cage or scene.cage)),
        spalls=spalls,
        path=path,
        waves=np.array(
            [
                [wave.order, wave.amplitude, wave.phase, scene.race_speed(wave.race)]
                for wave in scene.imperfections.waviness
            ]
        ).reshape(-1, 4),
    )


def _cage_pieces(cage: CagePath) -> Cubics:
    return np.ascontiguousarray(cage.polynomial.x), np.ascontiguousarray(cage.polynomial.c)


def _spall_tables(scene: Scene) -> tuple[Array, Cubics]:
    rows, edges, cubics, first = [], [np.zeros(0)], [np.zeros((4, 0))], 0
    for spall in scene.spalls:
        nodes, cubic = _unpacked(build_path(spall, scene.rig.bearing))
        speed = scene.race_speed(spall.race)
        rows.append([spall.row - 1, spall.angle, spall.travel_sign, speed, first, first + nodes.size])
        edges.append(nodes)
        # One empty cubic per spall keeps edges and cubics in step.
        cubics += [cubic, np.zeros((4, 1))]
        first += nodes.size
    return np.array(rows, dtype=np.float64).reshape(-1, 6), (np.concatenate(edges), np.concatenate(cubics, axis=1))


def _unpacked(path: DepthPath) -> Cubics:
    """Edges of all cells (N + 1,), rad, and cubics (4, N) in the arc from each cell's left edge, from the cube down."""
    pieces = list(zip(path.breaks[:-1], path.breaks[1:], path.cells, strict=True))
    left = np.concatenate([np.linspace(start, stop, count, endpoint=False) for start, stop, count in pieces])
    width = np.concatenate([np.full(count, (stop - start) / count) for start, stop, count in pieces])
    real = width > 0.0
    cubics = path.cubics[real].T / width[real] ** np.array([[3], [2], [1], [0]])
    return np.append(left[real], path.breaks[-1]), np.ascontiguousarray(cubics)


@njit
def polynomial_at(edges: Array, polynomials: Array, first: int, last: int, place: float) -> tuple[float, float]:
    """Value and slope at `place` of the piecewise polynomial whose edges are edges[first:last]."""
    piece, beyond = first, last - 1
    while beyond - piece > 1:
        middle = (piece + beyond) // 2
        if edges[middle] <= place:
            piece = middle
        else:
            beyond = middle
    x = place - edges[piece]
    value, slope = 0.0, 0.0
    for k in range(polynomials.shape[0]):
        slope = slope * x + value
        value = value * x + polynomials[k, piece]
    return value, slope


@njit
def _missing(equations: Equations, row: float, angle: float, speed: float, time: float) -> tuple[float, float]:
    """Radial depth (m) met by a ball of a row at `angle` (rad) moving at `speed` (rad/s), and its total rate (m/s)."""
    depth, rate = 0.0, 0.0
    edges, cubics = equations.path
    for spall in equations.spalls:
        if spall[SPALL_ROW] == row:
            first, last, sign = int(spall[FIRST]), int(spall[LAST]), spall[SIGN]
            arc = sign * (angle - spall[ANGLE] - spall[SPALL_SPEED] * time)
            arc -= 2.0 * math.pi * math.floor(arc / (2.0 * math.pi) + 0.5)
            if edges[first] <= arc <= edges[last - 1]:
                drop, slope = polynomial_at(edges, cubics, first, last, arc)
                depth += drop
                rate += slope * sign * (speed - spall[SPALL_SPEED])
    for wave in equations.waves:
        phase = wave[ORDER] * (angle - wave[WAVE_SPEED] * time) + wave[PHASE]
        depth += wave[AMPLITUDE] * math.cos(phase)
        rate -= wave[AMPLITUDE] * wave[ORDER] * math.sin(phase) * (speed - wave[WAVE_SPEED])
    return depth, rate


@njit
def _turn(equations: Equations, time: float) -> Turn:
    """Angles and speeds of both rows' cages at `time` (s)."""
    edges, quartics = equations.cages[0]
    first = polynomial_at(edges, quartics, 0, edges.size, time)
    edges, quartics = equations.cages[1]
    second = polynomial_at(edges, quartics, 0, edges.size, time)
    return first, second


@njit
def _closing(
    equations: Equations, turn: Turn, time: float, state: Array, ball: int
) -> tuple[float, float, float, float]:
    """Compression of one ball along its normal (m), its rate (m/s), and cosine and sine of the ball's angle."""
    law, row = equations.law, equations.balls[ball, BALL_ROW]
    angle, speed = turn[0] if row == 0.0 else turn[1]
    angle += equations.balls[ball, AHEAD]
    cosine, sine = math.cos(angle), math.sin(angle)
    dx, dy = state[0] - state[2], state[1] - state[3]
    vx, vy = state[6] - state[8], state[7] - state[9]
    depth, depth_rate = _missing(equations, row, angle, speed, time)
    tight = equations.balls[ball, DEVIATION] - law.clearance
    compression = dx * cosine + dy * sine - depth + tight
    rate = vx * cosine + vy * sine + speed * (dy * cosine - dx * sine) - depth_rate
    return law.cosine_of_contact_angle * compression, law.cosine_of_contact_angle * rate, cosine, sine


@njit
def _pressed(
    equations: Equations, turn: Turn, time: float, state: Array, ball: int
) -> tuple[float, float, float, float]:
    """Compression (m) of one ball, its force along the normal if it touches (N), and cosine and sine of its angle."""
    compression, rate, cosine, sine = _closing(equations, turn, time, state, ball)
    law = equations.law
    elastic = law.hertz_factor * max(compression, 0.0) ** law.exponent
    return compression, elastic + law.film_damping * rate, cosine, sine


@njit
def contact_set(equations: Equations, time: float, state: Array) -> Flags:
    """Which balls (B,) touch: those compressed, and under the no-tension law only while they also push."""
    touching = np.empty(equations.balls.shape[0], dtype=np.bool_)
    turn = _turn(equations, time)
    for ball in range(touching.size):
        compression, force, _, _ = _pressed(equations, turn, time, state, ball)
        touching[ball] = compression > 0.0 and (force > 0.0 or not equations.law.no_tension)
    return touching


@njit
def slopes(equations: Equations, touching: Flags, time: float, state: Array) -> Array:
    """Time derivative (12,) of the state while exactly the balls `touching` (B,) are in contact."""
    contact = np.zeros(2)
    loads, turn = equations.loads, _turn(equations, time)
    for ball in range(touching.size):
        if touching[ball]:
            _, force, cosine, sine = _pressed(equations, turn, time, state, ball)
            radial = force * equations.law.cosine_of_contact_angle
            contact[0] += radial * cosine
            contact[1] += radial * sine
    turned = loads.shaft_speed * time
    load = np.empty(2)
    load[0] = loads.unbalance * math.cos(turned + loads.unbalance_phase)
    load[1] = loads.unbalance * math.sin(turned + loads.unbalance_phase)
    load[1] -= loads.static * (1.0 + loads.fluctuation * math.cos(turned + loads.fluctuation_phase))
    result = np.empty(12)
    result[:6] = state[6:]
    for axis in range(2):
        mass_i, mass_o, mass_r, stiffness, damping, link_stiffness, link_damping = equations.axes[:, axis]
        link = link_stiffness * (state[2 + axis] - state[4 + axis])
        link += link_damping * (state[8 + axis] - state[10 + axis])
        support = stiffness * state[2 + axis] + damping * state[8 + axis]
        result[6 + axis] = (load[axis] - contact[axis]) / mass_i
        result[8 + axis] = (contact[axis] - support - link) / mass_o
        result[10 + axis] = link / mass_r
    return result
