"""The quasi-static model: at each instant the shaft rests where the load is carried [P14 Eq. 18-26]."""

from __future__ import annotations

import math

import numpy as np

from physics._jit import njit_lean
from physics.arrays import Array
from physics.assembly import assemble, ball_numbers
from physics.contact.forces import FORCE, Contacts, of_ball, set_time
from physics.ladder.contact_sets import changes_between_samples
from physics.ladder.model import Model
from physics.scene import Scene
from physics.statics.load_distribution import load_vector
from physics.statics.rest import EXACT, elastic
from physics.statics.rest_series import MARK, PLACE_X, PLACE_Y, TOLERANCE, coarsest_stride, rest_series
from physics.trace import Kept, Trace


def quasi_static_response(scene: Scene, rate: float, keep: Kept) -> Trace:
    """Positions, ball loads and contact of `scene` at the instants k / rate (Hz) without any inertia.

    Contacts carry exactly the load, so the support moves with the load alone: the acceleration is that of a load which
    turns with the shaft over the support's stiffness, and zero under a constant load. Contact changes are known to half
    a sample. For them alone the shaft's place need not be solved at every instant. Raises SimulationFailed where no
    position carries the load.
    """
    samples, step = scene.samples(rate), 1.0 / rate
    time = np.arange(samples) / rate
    everywhere = keep.state or keep.force
    stride, tolerance = (1, EXACT) if everywhere else (coarsest_stride(scene, step), TOLERANCE)
    rows = rest_series(scene, step, samples, stride, tolerance).rows[:samples]
    # A mark that is no number equals none, so such instants are all looked at.
    changed = np.concatenate([[0], 1 + np.flatnonzero(rows[1:, MARK] != rows[:-1, MARK])])
    looked_at = np.arange(samples) if keep.force else changed
    load = _ball_loads(scene, time[looked_at], rows[looked_at, PLACE_X : PLACE_Y + 1])
    touching = load[changed] > 0.0 if keep.force else load > 0.0
    rig, turn = scene.rig, scene.operation.shaft_speed
    support = np.array([rig.support_stiffness_x, rig.support_stiffness_y])
    steady = np.array([0.0, -scene.operation.load])
    outer = load_vector(scene, time) / support
    return Trace(
        rate=rate,
        time=time,
        acceleration=-(turn**2) * (outer - steady / support),
        changes=changes_between_samples(touching, changed, rate),
        model=QUASI_STATIC.name,
        method="Newton",
        step=math.nan,
        error_estimate=math.nan,
        tension_share=0.0,
        state=_state(outer, rows[:, PLACE_X : PLACE_Y + 1], rate) if keep.state else None,
        contact_force=load if keep.force else None,
    )


def _ball_loads(scene: Scene, time: Array, position: Array) -> Array:
    """Normal load (T, rows, balls), N, of every ball at the times (T,), s, the shaft being at each `position`
    (T, 2), m."""
    bearing, (_, ball) = scene.rig.bearing, ball_numbers(scene)
    radial = np.zeros((time.size, ball.size))
    _read_loads(assemble(scene), time, position, radial)
    return radial[:, ball >= 0].reshape(time.size, bearing.rows, bearing.balls) / math.cos(bearing.contact_angle)


@njit_lean
def _read_loads(contacts: Contacts, time: Array, position: Array, load: Array) -> None:
    """Fill the radial `load` (T, M), N, of M balls."""
    for k in range(time.size):
        set_time(contacts, time[k])
        elastic(contacts, position[k, 0], position[k, 1])
        for ball in range(load.shape[1]):
            load[k, ball] = of_ball(contacts.balls, FORCE, ball)


def _state(outer: Array, shaft: Array, rate: float) -> Array:
    """State (T, 12) of an `outer` ring (T, 2), m, which carries the resonator along, and the `shaft` as far from there
    (T, 2), m."""
    position = np.hstack([outer + shaft, outer, outer])
    velocity = np.gradient(position, 1.0 / rate, axis=0) if position.shape[0] > 1 else np.zeros_like(position)
    return np.hstack([position, velocity])


QUASI_STATIC = Model(
    name="quasi-static",
    computes="ball loads, positions and stiffness without inertia; acceleration only of a load that turns",
    holds_where="stiffness and ball loads of slow, shallow or extended spalls, where contact forces stay near them",
    leaves_out="every vibration that contacts excite, so its acceleration is no stand-in for a sensor's",
    rings=False,
    keeps=("state", "force"),
    respond=quasi_static_response,
)
