"""Angular speeds, rad/s, in the units that people say them in."""

from __future__ import annotations

import math
from typing import TypeVar

from physics.arrays import Array

Speed = TypeVar("Speed", float, Array)

RPM_PER_HZ = 60.0
# One revolution per minute, rad/s.
RPM = 2.0 * math.pi / RPM_PER_HZ


def in_rpm(speed: float) -> float:
    """Revolutions per minute of a `speed` in rad/s, to twelve digits: as they were stated, the last of which a speed in
    rad/s does not keep."""
    return float(f"{speed / RPM:.12g}")


def in_hertz(speed: Speed) -> Speed:
    """Turns, or swings, per second of a `speed` in rad/s, a number or an array."""
    return speed / (2.0 * math.pi)
