"""Quasi-static load distribution: where the shaft rests at each instant and which ball carries what [P14 Eq. 18-23]."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple, NoReturn

import numpy as np

from physics._jit import njit_inner, njit_lean
from physics.arrays import Array, Index
from physics.assembly import assemble, ball_numbers
from physics.contact.forces import COMPRESSION, FORCE, Contacts, direction, of_ball, set_time
from physics.motion import MotionModel, motion_model, outer_load
from physics.outcome import Outcome, SimulationFailed, StaticOutcome
from physics.scene import Scene
from physics.statics.rest import LOADED, NO_EQUILIBRIUM, NOT_LOADED, NOT_UNIQUE, solve_at

OUTCOMES = {
    LOADED: StaticOutcome.LOADED,
    NOT_UNIQUE: StaticOutcome.NOT_UNIQUE,
    NOT_LOADED: StaticOutcome.NOT_LOADED,
    NO_EQUILIBRIUM: StaticOutcome.NO_EQUILIBRIUM,
}
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
# Instants that tell the mean stiffness and damping of the contacts over a record.
INSTANTS_OF_MEAN = 64


@dataclass(frozen=True)
class Equilibrium:
    """Quasi-static positions of a scene at T instants.

    `displacement` (T, 2) of the inner relative to the outer ring, m; `ball_load` (T, rows, balls) normal load, N;
    `stiffness` (T, 3): kxx, kyy, kxy, N/m [P14 Eq. 26]; `damping` (T, 3): cxx, cyy, cxy, N s/m [P14 Eq. 27];
    `status` (T,): keys of `OUTCOMES`. Where there is no equilibrium, or no load and no ball pressed, the
    displacement is zero.
    """

    displacement: Array
    ball_load: Array
    stiffness: Array
    damping: Array
    status: Index

    def outcome(self, index: int) -> StaticOutcome:
        """How the search ended at one instant."""
        return OUTCOMES[int(self.status[index])]


class _Found(NamedTuple):
    """The arrays of an Equilibrium to fill, with the radial `force` (T, G · M) of the contact model's columns, N."""

    displacement: Array
    stiffness: Array
    damping: Array
    force: Array
    status: Index


def instants_without_period(duration: float, count: int = INSTANTS_OF_MEAN) -> Array:
    """`count` instants (count,), s, rising, spread over `duration` (s) by the golden section.

    Means over evenly spaced instants see no swing at all where these meet the same phase of every ball pass.
    """
    return duration * np.sort(np.arange(count) * GOLDEN % 1.0)


def equilibrium(scene: Scene, time: Array) -> Equilibrium:
    """Quasi-static equilibrium of `scene` at the times (T,), s, under the load vector and angles of each instant."""
    bearing, (_, ball) = scene.rig.bearing, ball_numbers(scene)
    time = np.ascontiguousarray(time, dtype=np.float64)
    found = _Found(
        displacement=np.zeros((time.size, 2)),
        stiffness=np.zeros((time.size, 3)),
        damping=np.zeros((time.size, 3)),
        force=np.zeros((time.size, ball.size)),
        status=np.zeros(time.size, dtype=np.int64),
    )
    _solve_all(assemble(scene), time, load_vector(scene, time), found)
    radial = found.force[:, ball >= 0].reshape(time.size, bearing.rows, bearing.balls)
    ball_load = radial / math.cos(bearing.contact_angle)
    return Equilibrium(found.displacement, ball_load, found.stiffness, found.damping, found.status)


def load_vector(scene: Scene, time: Array) -> Array:
    """Outer load on the shaft (T, 2), N: the static load with its fluctuation along −y, and the unbalance."""
    load = np.zeros((np.size(time), 2))
    _fill_loads(motion_model(scene), np.ascontiguousarray(time, dtype=np.float64), load)
    return load


def load_range(scene: Scene) -> tuple[float, float]:
    """Smallest and largest magnitude of the load on the shaft over a turn of it, N.

    The magnitude squared is a trigonometric polynomial of second order in the shaft's angle, so eight instants tell it
    and its extremes are among the angles of the four roots of its derivative.
    """
    turn = math.tau / scene.operation.shaft_speed
    instants = np.arange(8) / 8.0 * turn
    order = np.array([2, 1, 0, -1, -2])
    squared = np.fft.fft((load_vector(scene, instants) ** 2).sum(axis=1))
    extremes = np.angle(np.roots(order * squared[order])) / scene.operation.shaft_speed
    load = np.hypot(*load_vector(scene, np.concatenate([instants, extremes])).T)
    return float(load.min()), float(load.max())


@njit_lean
def _fill_loads(motion: MotionModel, time: Array, load: Array) -> None:
    for k in range(time.size):
        load[k, 0], load[k, 1] = outer_load(motion, time[k])


def resting(scene: Scene) -> Equilibrium:
    """Quasi-static positions of `scene` from t = 0 to its end; raises SimulationFailed if none carries the load at
    t = 0."""
    rest = equilibrium(scene, instants_without_period(scene.duration))
    if rest.outcome(0) is StaticOutcome.NO_EQUILIBRIUM:
        refuse(scene, 0.0)
    return rest


def require_equilibrium(scene: Scene, time: Array) -> Equilibrium:
    """The `equilibrium` at the times (T,), s; raises SimulationFailed where no position carries the load."""
    rest = equilibrium(scene, time)
    lost = np.flatnonzero(rest.status == NO_EQUILIBRIUM)
    if lost.size:
        refuse(scene, float(time[lost[0]]))
    return rest


def require_carried(scene: Scene, time: Array, lost: int) -> None:
    """Raise SimulationFailed if at one of the times (T,), s, the one with the index `lost`, no position carries the
    load; T and more stand for none."""
    if lost < time.size:
        refuse(scene, float(time[lost]))


def refuse(scene: Scene, time: float) -> NoReturn:
    """Raise SimulationFailed: no position carries the load at `time` (s)."""
    load = math.hypot(*load_vector(scene, np.array([time]))[0])
    problem = f"at t = {time:g} s {StaticOutcome.NO_EQUILIBRIUM.value} of {load:.6g} N"
    raise SimulationFailed(Outcome.NO_START, problem)


@njit_lean
def _solve_all(contacts: Contacts, time: Array, loads: Array, found: _Found) -> None:
    """Fill `found` for the `loads` (T, 2), N, at the times (T,), s."""
    dx, dy = 0.0, 0.0
    for k in range(time.size):
        set_time(contacts, time[k])
        dx, dy, sums, found.status[k] = solve_at(contacts, loads[k, 0], loads[k, 1], dx, dy)
        found.displacement[k, 0], found.displacement[k, 1] = dx, dy
        found.stiffness[k, 0], found.stiffness[k, 1], found.stiffness[k, 2] = sums.xx, sums.yy, sums.xy
        found.damping[k, 0], found.damping[k, 1], found.damping[k, 2] = _film_damping(contacts)
        for ball in range(found.force.shape[1]):
            found.force[k, ball] = of_ball(contacts.balls, FORCE, ball)


@njit_inner
def _film_damping(contacts: Contacts) -> tuple[float, float, float]:
    """Damping xx, yy, xy (N s/m) of the balls that `elastic` found pressed [P14 Eq. 27]."""
    balls, law = contacts.balls, contacts.law
    xx, yy, xy = 0.0, 0.0, 0.0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            if balls[cage, COMPRESSION, j] > 0.0:
                c, s = direction(contacts, cage, j)
                xx += law.damping * c * c
                yy += law.damping * s * s
                xy += law.damping * c * s
    return xx, yy, xy
