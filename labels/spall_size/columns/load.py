"""Columns of what load and Hertz factor lead one to expect of a leading pair."""

from __future__ import annotations

import math

import numpy as np

from labels.spall_size.events.leading import LeadingView
from labels.spall_size.signal.mean_pass import Channel
from labels.spall_size.static_release import release_arc, static_compression
from physics.arrays import Array

# Smallest values with which the columns are computed, so that every logarithm is finite: compression over the ball's
# radius.
LEAST_PRESSED = 1e-9
# Compression, m.
LEAST_COMPRESSION = 1e-9
# Release arc, rad.
LEAST_ARC = 1e-9
# Acceleration, in the unit of the signal.
LEAST_VIBRATION = 1e-12
# Displacement, in the unit of the signal times s².
LEAST_GIVE = 1e-15
NAMES = (
    "pressed",
    "release",
    "released",
    "deviation_over_load",
    "sway_over_load",
    "entry_jump_over_load",
    "exit_jump_over_load",
    "largest_jump_over_load",
    "give_over_pressed",
)


def measure(view: LeadingView, features: dict[str, Array]) -> dict[str, Array]:
    """Columns (L,) by NAMES, for a situation whose load is known, with the columns `features` of all pairs by name.

    Static compression over the ball's radius; twice the static release arc over the lag's; the same as log(1 + …);
    vibration, sway and the jumps at entry, at exit and at their largest over the load; displacement over compression;
    all logarithms.
    """
    evidence, mean = view.evidence, view.evidence.mean
    bearing, load = view.situation.bearing(), view.situation.load or 0.0
    pressed = static_compression(bearing, load) / bearing.ball_radius
    arc = 2.0 * release_arc(bearing, evidence.race, load)
    give = mean.give_unit / evidence.rate**2
    largest = math.log(float(mean.energy[Channel.ALL].max()))
    shared = {
        "pressed": math.log(max(pressed, LEAST_PRESSED)),
        "deviation_over_load": _over_load(evidence.deviation, load),
        "sway_over_load": _over_load(mean.sway_unit, load),
        "largest_jump_over_load": _over_load(evidence.unit * math.exp(0.5 * largest), load),
        "give_over_pressed": math.log(max(give, LEAST_GIVE) / max(pressed * bearing.ball_radius, LEAST_COMPRESSION)),
    }
    jumps = {
        f"{event}_jump_over_load": [
            _over_load(evidence.unit * math.exp(0.5 * float(level)), load) for level in features[f"{event}_core_all"]
        ]
        for event in ("entry", "exit")
    }
    lag_arcs = view.lag_arc.tolist()
    releases = {
        "release": [math.log(max(arc, LEAST_ARC) / lag_arc) for lag_arc in lag_arcs],
        "released": [math.log1p(arc / lag_arc) for lag_arc in lag_arcs],
    }
    found = {name: np.full(view.order.size, value) for name, value in shared.items()}
    return found | {name: np.array(values) for name, values in (releases | jumps).items()}


def _over_load(size: float, load: float) -> float:
    return math.log(max(size, LEAST_VIBRATION) / load)
