"""The quasi-static model: at each instant the shaft rests where the load is carried [P14 Eq. 18-26]."""

from __future__ import annotations

import math

import numpy as np

from physics.ladder.contact_sets import changes_between_samples
from physics.ladder.model import Model
from physics.scene import Scene
from physics.statics.load_distribution import carried, load_vector
from physics.trace import Trace


def quasi_static_response(scene: Scene, rate: float) -> Trace:
    """Positions, ball loads and contact of `scene` at the instants k / rate (Hz) without any inertia.

    Contacts carry exactly the load, so the support moves with the load alone: the acceleration is that of a load which
    turns with the shaft over the support's stiffness, and zero under a constant load. Contact changes are known to half
    a sample. Raises SimulationFailed where no position carries the load.
    """
    time = np.arange(round(scene.duration * rate)) / rate
    rest = carried(scene, time)
    rig, turn = scene.rig, scene.operation.shaft_speed
    support = np.array([rig.support_stiffness_x, rig.support_stiffness_y])
    steady = np.array([0.0, -scene.operation.load])
    outer = load_vector(scene, time) / support
    position = np.hstack([outer + rest.displacement, outer, outer])
    return Trace(
        rate=rate,
        time=time,
        acceleration=-(turn**2) * (outer - steady / support),
        changes=changes_between_samples(rest.ball_load > 0.0, rate),
        model=QUASI_STATIC.name,
        method="Newton",
        step=math.nan,
        error_estimate=math.nan,
        tension_share=0.0,
        state=np.hstack([position, np.gradient(position, 1.0 / rate, axis=0)]) if time.size > 1 else None,
        contact_force=rest.ball_load,
    )


QUASI_STATIC = Model(
    name="quasi-static",
    computes="ball loads, positions and stiffness without inertia; acceleration only of a load that turns",
    holds_where="stiffness and ball loads of slow, shallow or extended spalls, where contact forces stay near them",
    leaves_out="every vibration that contacts excite, so its acceleration is no stand-in for a sensor's",
    rings=False,
    keeps=("state", "force"),
    respond=quasi_static_response,
)
