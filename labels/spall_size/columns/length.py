"""Columns of how long the spall of a leading pair would be without any shortening."""

from __future__ import annotations

import math

import numpy as np

from labels.spall_size.events.leading import LeadingView
from physics.arrays import Array

NAMES = ("length_in_balls", "lag_arc")


def measure(view: LeadingView) -> dict[str, Array]:
    """Columns (L,) by NAMES: length of the lag's arc over the ball's diameter, and the arc itself (rad), logarithms."""
    bearing = view.situation.bearing()
    radius = bearing.raceway_radius(view.evidence.race)
    arcs = [float(arc) for arc in view.lag_arc]
    # Logarithms one by one: those of a whole array may differ in the last digit, and the trees have seen these.
    return {
        "length_in_balls": np.array([math.log(arc * radius / bearing.ball_diameter) for arc in arcs]),
        "lag_arc": np.array([math.log(arc) for arc in arcs]),
    }
