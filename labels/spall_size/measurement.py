"""The chosen pair of events of a record and the numbers from which its lag, its arc and their doubt are told."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.event_profiles import profile_columns, rival_columns
from labels.spall_size.evidence import Evidence
from labels.spall_size.situation import Situation
from labels.spall_size.static_release import release_arc, static_compression

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Measurement:
    """Pair of events of the best score: `entry` and `exit` in samples from the anchor, raw `lag` in samples and its
    arc in rad; `row` (F,) describes record and pair, `load_row` the same with what load and Hertz factor tell."""

    entry: float
    exit: float
    lag: float
    lag_arc: float
    row: Array
    load_row: Array | None


def measure(evidence: Evidence, score: Array, situation: Situation) -> Measurement:
    """The best pair of `evidence` by `score` (P,)."""
    pairs, best = evidence.pairs, int(np.argmax(score))
    entry, leave, lag = (float(column[best]) for column in (pairs.entry, pairs.exit, pairs.lag))
    # The tracked period stands for one ball spacing, whatever the stated speed and the slip were.
    arc = lag / evidence.mean.period * situation.bearing().spacing
    row = [
        *(float(value) for value in pairs.features[best]),
        *profile_columns(evidence.mean, entry, leave, lag),
        *rival_columns(pairs, score, best),
        *_length_columns(arc, evidence.race, situation),
    ]
    loaded = np.array([*row, *_load_columns(arc, evidence, situation)]) if situation.load_known else None
    return Measurement(entry, leave, lag, arc, np.array(row), loaded)


def _length_columns(lag_arc: float, race: str, situation: Situation) -> list[float]:
    """Length of the lag's arc over the ball's diameter, and the arc itself, logarithms."""
    bearing = situation.bearing()
    length = lag_arc * bearing.raceway_radius(race)
    return [math.log(length / bearing.ball_diameter), math.log(lag_arc)]


def _load_columns(lag_arc: float, evidence: Evidence, situation: Situation) -> list[float]:
    """Static compression over the ball's radius, twice the static release arc over the lag's, vibration over load."""
    bearing, load = situation.bearing(), situation.load or 0.0
    pressed = static_compression(bearing, load) / bearing.ball_radius
    arc = 2.0 * release_arc(bearing, evidence.race, load)
    return [
        math.log(max(pressed, 1e-9)),
        math.log(max(arc, 1e-9) / lag_arc),
        math.log1p(arc / lag_arc),
        math.log(max(evidence.deviation, 1e-12) / load),
    ]
