"""Quasi-static load distribution: where the shaft rests at each instant and which ball carries what [P14 Eq. 18-23]."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inner, njit_lean
from physics.assembly import assemble
from physics.contact import COMPRESSION, FORCE, Law, of_ball, set_time
from physics.outcome import Outcome, SimulationFailed, StaticOutcome
from physics.rest import LOADED, NO_EQUILIBRIUM, NOT_LOADED, NOT_UNIQUE, direction, solve_at
from physics.scene import Scene
from physics.track import Track

Array = NDArray[np.float64]

OUTCOMES = {
    LOADED: StaticOutcome.LOADED,
    NOT_UNIQUE: StaticOutcome.NOT_UNIQUE,
    NOT_LOADED: StaticOutcome.NOT_LOADED,
    NO_EQUILIBRIUM: StaticOutcome.NO_EQUILIBRIUM,
}


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
    load = np.zeros((turn.size, 2))
    if run.unbalance_force:
        load[:, 0] = run.unbalance_force * np.cos(turn + run.unbalance_phase)
        load[:, 1] = run.unbalance_force * np.sin(turn + run.unbalance_phase)
    share = 1.0 + run.load_fluctuation * np.cos(turn + run.fluctuation_phase) if run.load_fluctuation else 1.0
    load[:, 1] -= run.load * share
    return load


def carried(scene: Scene, time: Array) -> Equilibrium:
    """The `equilibrium` at the times (T,), s; raises SimulationFailed where no position carries the load."""
    rest = equilibrium(scene, time)
    lost = np.flatnonzero(rest.status == NO_EQUILIBRIUM)
    if lost.size:
        refuse(scene, float(time[lost[0]]))
    return rest


def refuse(scene: Scene, time: float) -> NoReturn:
    """Raise SimulationFailed: no position carries the load at `time` (s)."""
    load = math.hypot(*load_vector(scene, np.array([time]))[0])
    problem = f"at t = {time:g} s {StaticOutcome.NO_EQUILIBRIUM.value} of {load:.6g} N"
    raise SimulationFailed(Outcome.NO_START, problem)


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


@njit_inner
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
