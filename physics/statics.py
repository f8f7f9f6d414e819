"""Quasi-static load distribution: where the shaft rests at each instant and which ball carries what [P14 Eq. 18-23].

The elastic energy of the contacts minus the work of the load is a convex function of the shaft's position, so Newton's
method with a line search finds the equilibrium from anywhere; where the stiffness is singular the answer says so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit
from physics.assembly import assemble
from physics.contact import (
    COMPRESSION,
    COSINE,
    FLOOR,
    FORCE,
    FRAME_COSINE,
    FRAME_SINE,
    SINE,
    Law,
    Track,
    of_ball,
    set_time,
)
from physics.outcome import StaticOutcome
from physics.scene import Scene

Array = NDArray[np.float64]

LOADED, NOT_UNIQUE, NOT_LOADED, NO_EQUILIBRIUM = 0, 1, 2, 3
OUTCOMES = (
    StaticOutcome.LOADED,
    StaticOutcome.NOT_UNIQUE,
    StaticOutcome.NOT_LOADED,
    StaticOutcome.NO_EQUILIBRIUM,
)

TOLERANCE = 1e-11
SINGULAR = 1e-9
LARGEST_MOVE = 0.05
MOST_ITERATIONS = 200


@dataclass(frozen=True)
class Equilibrium:
    """Quasi-static positions of a scene at T instants.

    `displacement` (T, 2) of the inner relative to the outer ring, m; `ball_load` (T, rows, balls) normal load, N;
    `stiffness` (T, 3): kxx, kyy, kxy, N/m [P14 Eq. 26]; `damping` (T, 3): cxx, cyy, cxy, N s/m [P14 Eq. 27];
    `status` (T,): indices into `physics.statics.OUTCOMES`.
    """

    displacement: Array
    ball_load: Array
    stiffness: Array
    damping: Array
    status: NDArray[np.int64]

    def outcome(self, index: int) -> StaticOutcome:
        """How the search ended at one instant."""
        return OUTCOMES[self.status[index]]


def equilibrium(scene: Scene, time: Array) -> Equilibrium:
    """Quasi-static equilibrium of `scene` at the times (T,), s, under the load vector and angles of each instant."""
    model = assemble(scene)
    time = np.ascontiguousarray(time, dtype=np.float64)
    loads = load_vector(scene, time)
    displacement, force, stiffness, damping, status = _solve_all(
        model.balls, model.frames, model.law, model.track, time, loads
    )
    bearing = scene.rig.bearing
    real = model.ball >= 0
    ball_load = force[:, real].reshape(time.size, bearing.rows, bearing.balls) / math.cos(bearing.contact_angle)
    return Equilibrium(displacement, ball_load, stiffness, damping, status)


def load_vector(scene: Scene, time: Array) -> Array:
    """Outer load on the shaft (T, 2), N: the static load with its fluctuation along −y, and the unbalance."""
    run = scene.operation
    turn = run.shaft_speed * np.asarray(time)
    unbalance = run.unbalance_force * np.column_stack(
        [np.cos(turn + run.unbalance_phase), np.sin(turn + run.unbalance_phase)]
    )
    unbalance[:, 1] -= run.load * (1.0 + run.load_fluctuation * np.cos(turn + run.fluctuation_phase))
    return unbalance


@njit
def _solve_all(
    balls: Array, frames: Array, law: Law, track: Track, time: Array, loads: Array
) -> tuple[Array, Array, Array, Array, NDArray[np.int64]]:
    displacement = np.zeros((time.size, 2))
    count = balls.shape[0] * balls.shape[2]
    force = np.zeros((time.size, count))
    stiffness = np.zeros((time.size, 3))
    damping = np.zeros((time.size, 3))
    status = np.zeros(time.size, dtype=np.int64)
    dx, dy = 0.0, 0.0
    for k in range(time.size):
        set_time(balls, frames, track, time[k])
        dx, dy, status[k] = solve_at(balls, frames, law, loads[k, 0], loads[k, 1], dx, dy)
        displacement[k, 0], displacement[k, 1] = dx, dy
        _, _, _, kxx, kyy, kxy = elastic(balls, frames, law, dx, dy)
        stiffness[k, 0], stiffness[k, 1], stiffness[k, 2] = kxx, kyy, kxy
        for ball in range(count):
            force[k, ball] = of_ball(balls, FORCE, ball)
            if of_ball(balls, COMPRESSION, ball) > 0.0:
                c, s = _direction(balls, frames, ball // balls.shape[2], ball % balls.shape[2])
                damping[k, 0] += law.damping * c * c
                damping[k, 1] += law.damping * s * s
                damping[k, 2] += law.damping * c * s
    return displacement, force, stiffness, damping, status


@njit
def _direction(balls: Array, frames: Array, cage: int, place: int) -> tuple[float, float]:
    cosine, sine = frames[cage, FRAME_COSINE], frames[cage, FRAME_SINE]
    return (
        balls[cage, COSINE, place] * cosine - balls[cage, SINE, place] * sine,
        balls[cage, SINE, place] * cosine + balls[cage, COSINE, place] * sine,
    )


@njit
def elastic(
    balls: Array, frames: Array, law: Law, dx: float, dy: float
) -> tuple[float, float, float, float, float, float]:
    """Elastic energy (J), net elastic force x, y (N) and stiffness xx, yy, xy (N/m) [P14 Eq. 22, 26] at (dx, dy).

    `set_time` must have been called; leaves compression and elastic force of every ball in `balls`.
    """
    energy, force_x, force_y, kxx, kyy, kxy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    n = law.exponent
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            c, s = _direction(balls, frames, cage, j)
            compression = dx * c + dy * s - balls[cage, FLOOR, j]
            balls[cage, COMPRESSION, j] = compression
            balls[cage, FORCE, j] = 0.0
            if compression > 0.0:
                slope = law.stiffness * (math.sqrt(compression) if n == 1.5 else compression ** (n - 1.0))
                force = slope * compression
                balls[cage, FORCE, j] = force
                energy += force * compression / (n + 1.0)
                force_x += force * c
                force_y += force * s
                kxx += n * slope * c * c
                kyy += n * slope * s * s
                kxy += n * slope * c * s
    return energy, force_x, force_y, kxx, kyy, kxy


@njit
def solve_at(
    balls: Array, frames: Array, law: Law, load_x: float, load_y: float, dx: float, dy: float
) -> tuple[float, float, int]:
    """Equilibrium position (m, m) under the load (N, N) from the guess (dx, dy), and its status.

    Safeguarded Newton: a regularised step where the stiffness is singular, halved until the energy falls.
    """
    load = math.hypot(load_x, load_y)
    if load == 0.0:
        return 0.0, 0.0, NOT_LOADED
    typical = (load / law.stiffness) ** (1.0 / law.exponent)
    energy, force_x, force_y, kxx, kyy, kxy = elastic(balls, frames, law, dx, dy)
    for _ in range(MOST_ITERATIONS):
        gx, gy = load_x - force_x, load_y - force_y
        if kxx + kyy > 0.0 and math.hypot(gx, gy) <= TOLERANCE * load:
            return dx, dy, (NOT_UNIQUE if _singular(kxx, kyy, kxy) else LOADED)
        floor = max(1e-10 * (kxx + kyy), 1e-6 * load / typical)
        a, b = kxx + floor, kyy + floor
        determinant = a * b - kxy * kxy
        step_x, step_y = (b * gx - kxy * gy) / determinant, (a * gy - kxy * gx) / determinant
        if not _singular(kxx, kyy, kxy):
            determinant = kxx * kyy - kxy * kxy
            step_x, step_y = (kyy * gx - kxy * gy) / determinant, (kxx * gy - kxy * gx) / determinant
        longest = 20.0 * typical + 0.5 * math.hypot(dx, dy)
        length = math.hypot(step_x, step_y)
        if length > longest:
            step_x, step_y = step_x * longest / length, step_y * longest / length
        descent = gx * step_x + gy * step_y
        share = 1.0
        objective = energy - load_x * dx - load_y * dy
        while True:
            x, y = dx + share * step_x, dy + share * step_y
            energy, force_x, force_y, kxx, kyy, kxy = elastic(balls, frames, law, x, y)
            if energy - load_x * x - load_y * y <= objective - 1e-4 * share * descent + 1e-14 * abs(objective):
                break
            share *= 0.5
            if share < 1e-12:
                break
        dx, dy = x, y
        if abs(dx) + abs(dy) > LARGEST_MOVE:
            return 0.0, 0.0, NO_EQUILIBRIUM
        if math.hypot(share * step_x, share * step_y) <= 1e-15 * math.hypot(dx, dy):
            break
    residual = math.hypot(load_x - force_x, load_y - force_y)
    if residual <= 1e-7 * load:
        return dx, dy, (NOT_UNIQUE if _singular(kxx, kyy, kxy) else LOADED)
    return dx, dy, NO_EQUILIBRIUM


@njit
def _singular(kxx: float, kyy: float, kxy: float) -> bool:
    return kxx * kyy - kxy * kxy <= SINGULAR * (kxx + kyy) ** 2
