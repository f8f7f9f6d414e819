"""How much a bearing carries: the static load rating, a measure of size for choosing loads."""

from __future__ import annotations

import math

from physics.bearing import Bearing
from physics.hertz import is_roller, roller_length

# ISO 76 tabulates f0 for deep groove balls: 14.7 at Db cos(α) / Dp = 0 and 0.17, 12.8 to 16.5 between 0 and 0.25.
BALL_RATING = 14.7e6  # N/m²
ROLLER_RATING = 44e6  # N/m²


def static_load_rating(bearing: Bearing) -> float:
    """Radial static load rating C0 of a steel `bearing`, N (ISO 76, with one factor for all ball bearings).

    Balls: f0 i Z Db² cos α. Rollers: 44 N/mm² (1 − Db cos α / Dp) i Z l Db cos α, with the length l that K stands for.
    """
    elements = bearing.rows * bearing.balls * math.cos(bearing.contact_angle)
    if not is_roller(bearing):
        return BALL_RATING * elements * bearing.ball_diameter**2
    length = roller_length(bearing.load_deflection)
    return ROLLER_RATING * (1.0 - bearing.diameter_ratio) * elements * length * bearing.ball_diameter
