"""What the tests of a bearing at rest share: an instant, a short and a long spall at the bottom, where balls are."""

import math

import numpy as np

from physics.spall import Spall

BOTTOM = math.radians(270.0)
START = np.zeros(1)
LINE = Spall("outer", 1, BOTTOM, math.radians(2.0), 12e-6, math.radians(0.3), math.radians(0.3))
EXTENDED = Spall("outer", 1, BOTTOM, math.radians(40.0), 4e-6, math.radians(1.0), math.radians(1.0))
SOLVED = 1e-9  # the solver stops at 1e-11 of the load, or where rounding of micrometres stops it


def angles(scene, time):
    """φ of every ball, (T, rows, balls)."""
    bearing = scene.rig.bearing
    within = np.arange(bearing.rows)[:, None] * bearing.stagger + np.arange(bearing.balls) * bearing.spacing
    return scene.cage.angle(time)[:, None, None] + within
