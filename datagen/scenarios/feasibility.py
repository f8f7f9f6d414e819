"""Whether the shaft of a drawn scene can rest anywhere under its load."""

from __future__ import annotations

import math

import numpy as np

from physics.checks import require
from physics.outcome import StaticOutcome
from physics.scene import Scene
from physics.statics.load_distribution import equilibrium

CERTAIN_REACH = 5e-3


def require_equilibrium(scene: Scene, start: float) -> None:
    """Raise InvalidParameter if there is no position of the shaft in which the bearing carries the load at the time
    `start` (s); the equilibrium is only solved if in doubt."""
    if farthest_rest(scene) < CERTAIN_REACH:
        return
    outcome = equilibrium(scene, np.array([start])).outcome(0)
    problem = f"{outcome.value} of {scene.operation.load:g} N"
    require(outcome is not StaticOutcome.NO_EQUILIBRIUM, problem, "equilibrium")


def farthest_rest(scene: Scene) -> float:
    """A distance (m) within which the shaft surely comes to rest.

    In whatever direction the shaft moves, a ball lies within half a spacing of it. Once that ball alone carries more
    than the whole load, even over the deepest floor, moving on costs more energy than the load gives.
    """
    bearing = scene.rig.bearing
    side = math.cos(bearing.spacing / 2.0)
    compression = (scene.operation.load_bound / (bearing.radial_load_deflection * side)) ** (1.0 / bearing.exponent)
    return (compression + _deepest_floor(scene)) / side


def _deepest_floor(scene: Scene) -> float:
    spalls = max((spall.floor_depth + 6.0 * spall.roughness for spall in scene.spalls), default=0.0)
    waviness = sum(wave.amplitude for wave in scene.imperfections.waviness)
    deviation = max((abs(value) for row in scene.imperfections.ball_deviation for value in row), default=0.0)
    return spalls + waviness + deviation + max(scene.rig.bearing.clearance, 0.0)
