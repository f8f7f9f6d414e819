"""How large a response has to be to be more than what rounding makes of the contact forces.

Balls that a preload presses all round hold the rings so evenly that a healthy bearing hardly moves. What is left of
forces of kilonewtons then cancels to the last digit, and no method tells the rest from rounding.
"""

from __future__ import annotations

import math

from physics.scene import Scene

# Share of the sum of all forces that no method vouches for: rounding of each, with room for the resonances' gain.
UNSURE = 1e-12


def largest_forces(scene: Scene) -> float:
    """Sum (N) of the outer load at its largest and of what all balls bear at most where clearance and imperfections
    press them between rings that do not give way [P14 Eq. 6]."""
    bearing, imperfect = scene.rig.bearing, scene.imperfections
    proud = sum(wave.amplitude for wave in imperfect.waviness)
    proud_ball = max((deviation for row in imperfect.ball_deviation for deviation in row), default=0.0)
    proud += proud_ball / math.cos(bearing.contact_angle)
    pressed = bearing.radial_load_deflection * max(0.0, proud - bearing.clearance) ** bearing.exponent
    return scene.operation.load_bound + bearing.rows * bearing.balls * pressed


def silence(scene: Scene) -> float:
    """The acceleration (m/s², RMS) below which a response may be rounding alone."""
    return UNSURE * largest_forces(scene) / scene.rig.outer_mass
