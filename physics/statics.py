"""Quasi-static load distribution: where the shaft rests at each instant and which ball carries what [P14 Eq. 18-23]."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_lean
from physics.assembly import assemble
from physics.contact import COMPRESSION, FORCE, Law, Track, of_ball, set_time
from physics.outcome import StaticOutcome
from physics.rest import LOADED, NO_EQUILIBRIUM, NOT_LOADED, NOT_UNIQUE, direction, elastic, solve_at
from physics.scene import Scene

Array = NDArray[np.float64]

OUTCOMES = {
    LOADED: StaticOutcome.LOADED,
    NOT_UNIQUE: StaticOutcome.NOT_UNIQUE,
    NOT_LOADED: StaticOutcome.NOT_LOADED,
    NO_EQUILIBRIUM: StaticOutcome.NO_EQUILIBRIUM,
}

# A shaft that moved by less than this share of its displacement is expected to move on as far.
NEARBY = 0.05
# An unbalanced force below this share of the load is one step of Newton's method, which squares it, away.
CLOSE = 1e-6


@dataclass(frozen=True)
class Equilibrium:
    """Quasi-static positions of a scene at T instants.

    `displacement` (T, 2) of the inner relative to the outer ring, m; `ball_load` (T, rows, balls) normal load, N;
    `stiffness` (T, 3): kxx, kyy, kxy, N/m [P14 Eq. 26]; `damping` (T, 3): cxx, cyy, cxy, N s/m [P14 Eq. 27];
    `status` (T,): keys of `physics.statics.OUTCOMES`. Where there is no equilibrium, or no load and no ball
    pressed, the displacement is zero.
    """

    displacement: Array
    ball_load: Array
    stiffness: Array
    damping: Array
    status: NDArray[np.int64]

    def outcome(self, index: int) -> StaticOutcome:
        """How the search ended at one instant."""
        return OUTCOMES[int(self.status[index])]


def equilibrium(scene: Scene, time: Array) -> Equilibrium:
    """Quasi-static equilibrium of `scene` at the times (T,), s, under the load vector and angles of each instant."""
    model = assemble(scene)
    time = np.ascontiguousarray(time, dtype=np.float64)
    loads = load_vector(scene, time)
    displacement, stiffness, damping = np.zeros((time.size, 2)), np.zeros((time.size, 3)), np.zeros((time.size, 3))
    force = np.zeros((time.size, model.ball.size))
    status = np.zeros(time.size, dtype=np.int64)
    _solve_all(
        model.balls, model.frames, model.law, model.track, time, loads, displacement, stiffness, damping, force, status
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


def quasi_static_stiffness(scene: Scene, time: Array) -> Array:
    """The `stiffness` (T, 3) of `equilibrium` alone, in half the time where many instants follow closely."""
    model = assemble(scene)
    time = np.ascontiguousarray(time, dtype=np.float64)
    stiffness, place = np.zeros((time.size, 3)), np.zeros((time.size, 2))
    _follow(model.balls, model.frames, model.law, model.track, time, load_vector(scene, time), place, stiffness)
    return stiffness


@njit_lean
def _follow(
    balls: Array, frames: Array, law: Law, track: Track, time: Array, loads: Array, place: Array, stiffness: Array
) -> None:
    """Fill `stiffness` (T, 3) along the way of the shaft, `place` (T, 2), m.

    Where the shaft is nearly where it was expected, one step of Newton's method from there is its place.
    """
    for k in range(time.size):
        set_time(balls, frames, track, time[k])
        dx, dy = _expected(place, k)
        hold = elastic(balls, frames, law, dx, dy)
        gx, gy = loads[k, 0] - hold.force_x, loads[k, 1] - hold.force_y
        determinant = hold.xx * hold.yy - hold.xy * hold.xy
        near = math.hypot(gx, gy) <= CLOSE * math.hypot(loads[k, 0], loads[k, 1])
        if near and determinant > CLOSE * (hold.xx + hold.yy) ** 2:
            dx += (hold.yy * gx - hold.xy * gy) / determinant
            dy += (hold.xx * gy - hold.xy * gx) / determinant
            hold = elastic(balls, frames, law, dx, dy)
        else:
            dx, dy, hold, _ = solve_at(balls, frames, law, loads[k, 0], loads[k, 1], dx, dy)
        place[k, 0], place[k, 1] = dx, dy
        stiffness[k, 0], stiffness[k, 1], stiffness[k, 2] = hold.xx, hold.yy, hold.xy


@njit_lean
def _expected(place: Array, k: int) -> tuple[float, float]:
    """Where the shaft will be at instant `k`, going on as at the last three instants, unless it moved far."""
    if k == 0:
        return 0.0, 0.0
    x, y = place[k - 1, 0], place[k - 1, 1]
    if k > 1 and math.hypot(x - place[k - 2, 0], y - place[k - 2, 1]) < NEARBY * math.hypot(x, y):
        if k == 2:
            return 2.0 * x - place[0, 0], 2.0 * y - place[0, 1]
        return 3.0 * (x - place[k - 2, 0]) + place[k - 3, 0], 3.0 * (y - place[k - 2, 1]) + place[k - 3, 1]
    return x, y


@njit_lean
def _solve_all(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    time: Array,
    loads: Array,
    displacement: Array,
    stiffness: Array,
    damping: Array,
    force: Array,
    status: NDArray[np.int64],
) -> None:
    """Fill the arrays of an Equilibrium; `force` (T, M)."""
    dx, dy = 0.0, 0.0
    for k in range(time.size):
        set_time(balls, frames, track, time[k])
        dx, dy, hold, status[k] = solve_at(balls, frames, law, loads[k, 0], loads[k, 1], dx, dy)
        displacement[k, 0], displacement[k, 1] = dx, dy
        stiffness[k, 0], stiffness[k, 1], stiffness[k, 2] = hold.xx, hold.yy, hold.xy
        damping[k, 0], damping[k, 1], damping[k, 2] = _film_damping(balls, frames, law)
        for ball in range(force.shape[1]):
            force[k, ball] = of_ball(balls, FORCE, ball)


@njit_lean
def _film_damping(balls: Array, frames: Array, law: Law) -> tuple[float, float, float]:
    """Damping xx, yy, xy (N s/m) of the balls that `elastic` found pressed [P14 Eq. 27]."""
    xx, yy, xy = 0.0, 0.0, 0.0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            if balls[cage, COMPRESSION, j] > 0.0:
                c, s = direction(balls, frames, cage, j)
                xx += law.damping * c * c
                yy += law.damping * s * s
                xy += law.damping * c * s
    return xx, yy, xy
