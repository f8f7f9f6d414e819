"""What a contestant gives back: as much of a response as it knows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from physics.arrays import Array
from physics.integrators.reference.equations import contact_set, write_equations
from physics.ladder.contact_sets import changes_between_samples
from physics.motion import motion_model, resonator_acceleration
from physics.scene import Scene
from physics.trace import ContactChanges, Trace


@dataclass(frozen=True)
class Response:
    """`acceleration` (T, 2) of the resonator, m/s²; `displacement` (T, 2) of the inner from the outer ring, m, or None;
    contact `changes`, or None."""

    acceleration: Array
    displacement: Array | None
    changes: ContactChanges | None


def of_trace(trace: Trace) -> Response:
    """The response of one of this package's methods or models."""
    displacement = None if trace.state is None else trace.state[:, 0:2] - trace.state[:, 2:4]
    return Response(trace.acceleration, displacement, trace.changes)


def of_states(scene: Scene, rate: float, states: Array) -> Response:
    """The response of a solver that gives states (T, 12) at the samples and knows nothing of contact."""
    motion, equations = motion_model(scene), write_equations(scene)
    bearing = scene.rig.bearing
    acceleration = np.array([[resonator_acceleration(motion, state, axis) for axis in (0, 1)] for state in states])
    touching = np.array([contact_set(equations, k / rate, state) for k, state in enumerate(states)])
    touching = touching.reshape(-1, bearing.rows, bearing.balls)
    changes = changes_between_samples(touching, np.arange(len(states)), rate)
    return Response(acceleration, states[:, 0:2] - states[:, 2:4], changes)
