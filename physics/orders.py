"""How often balls pass and parts turn where nothing slips, in orders of the shaft: the kinematics of pure rolling.

`diameter_ratio` is Db cos α / Dp, `balls` those of one row.
"""

from __future__ import annotations

import math


def diameter_ratio_of(pitch_diameter: float, ball_diameter: float, contact_angle: float) -> float:
    """Db cos α / Dp of the diameters (m) and the angle (rad)."""
    return ball_diameter * math.cos(contact_angle) / pitch_diameter


def cage_order(diameter_ratio: float) -> float:
    """Turns of the cage (FTF) [P14 Eq. 1]."""
    return 0.5 * (1.0 - diameter_ratio)


def outer_pass_order(balls: int, diameter_ratio: float) -> float:
    """Balls that pass a point of the outer race (BPFO)."""
    return balls * cage_order(diameter_ratio)


def inner_pass_order(balls: int, diameter_ratio: float) -> float:
    """Balls that pass a point of the inner race (BPFI)."""
    return balls * (1.0 - cage_order(diameter_ratio))


def ball_spin_order(pitch_over_ball: float, diameter_ratio: float) -> float:
    """Turns of a ball about itself (BSF); `pitch_over_ball` is Dp / Db."""
    return 0.5 * pitch_over_ball * (1.0 - diameter_ratio**2)
