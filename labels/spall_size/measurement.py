"""The leading pairs of events of a record, described by all that is known, and the one that is taken for the events."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.event_profiles import NEAR, SAME, profile_columns, rival_columns
from labels.spall_size.evidence import Evidence
from labels.spall_size.pair_features import NAMES, Pairs
from labels.spall_size.situation import Situation
from labels.spall_size.static_release import release_arc, static_compression

Array = NDArray[np.float64]

LEADING = 16
# Leading pairs differ in lag by more than this (logarithm): of those that say nearly the same the best stands for all.
DISTINCT = 0.05
CORES = [NAMES.index(f"{event}_core_all") for event in ("entry", "exit")]


@dataclass(frozen=True)
class LeadingPairs:
    """The pairs of the best scores, best first: `entry`, `exit` (L,) in samples from the anchor, `lag` (L,) in samples,
    its arc `lag_arc` (L,) in rad, and a row of numbers for each, `rows` (L, F)."""

    entry: Array
    exit: Array
    lag: Array
    lag_arc: Array
    rows: Array


@dataclass(frozen=True)
class Measurement:
    """One pair taken for the events: as in LeadingPairs, and `row` (F,) with how it stands among the others."""

    entry: float
    exit: float
    lag: float
    lag_arc: float
    row: Array


def leading_pairs(evidence: Evidence, score: Array, situation: Situation) -> LeadingPairs:
    """At most LEADING pairs of `evidence` by `score` (P,); rows are longer if load and Hertz factor are known."""
    pairs = evidence.pairs
    order = leading_order(pairs, score)
    entry, leave, lag = pairs.entry[order], pairs.exit[order], pairs.lag[order]
    # The tracked period stands for one ball spacing, whatever the stated speed and the slip were.
    arc = lag / evidence.mean.period * situation.bearing().spacing
    profiles = profile_columns(evidence.mean, entry, leave, lag)
    rows = []
    for k, own in enumerate(order):
        row = [
            *(float(value) for value in pairs.features[own]),
            *(float(value) for value in profiles[k]),
            *rival_columns(pairs, score, int(own)),
            float(score[own] - score[order[0]]),
            float(k),
            *_length_columns(float(arc[k]), evidence.race, situation),
        ]
        rows.append(row + _load_columns(int(own), float(arc[k]), evidence, situation) if situation.load_known else row)
    return LeadingPairs(entry, leave, lag, arc, np.array(rows))


def leading_order(pairs: Pairs, score: Array) -> NDArray[np.int64]:
    """Which `pairs` of different lags lead by `score` (P,), the best first."""
    lag, chosen = np.log(pairs.lag), list[int]()
    for own in np.argsort(-score, kind="stable"):
        if np.all(np.abs(lag[own] - lag[chosen]) > DISTINCT):
            chosen.append(int(own))
        if len(chosen) == LEADING:
            break
    return np.array(chosen)


def measure(leading: LeadingPairs, rank: Array) -> Measurement:
    """The pair of the best `rank` (L,) among `leading`."""
    best = int(np.argmax(rank))
    apart = np.log(leading.lag / leading.lag[best])
    weight = np.maximum(rank, 1e-6) ** 2 * (np.abs(apart) < NEAR)
    middle = float((weight * apart).sum() / weight.sum())
    others = np.where(np.abs(apart) > SAME, rank, -1.0)
    rival = int(np.argmax(others))
    standing = [
        float(rank[best]),
        float(others[rival]),
        float(apart[rival]),
        middle,
        math.sqrt(float((weight * (apart - middle) ** 2).sum() / weight.sum())),
    ]
    row = np.concatenate([leading.rows[best], standing, _field(rank), _field(rank, apart)])
    entry, leave, lag, arc = (float(column[best]) for column in (leading.entry, leading.exit, leading.lag,
                                                                 leading.lag_arc))  # fmt: skip
    return Measurement(entry, leave, lag, arc, row)


def _field(rank: Array, told: Array | None = None) -> Array:
    """What is `told` (L,) of the leading pairs, or else their `rank` (L,), from the best rank down to the last."""
    values = (rank if told is None else told)[np.argsort(-rank, kind="stable")]
    return np.pad(values, (0, LEADING - values.size))


def _length_columns(lag_arc: float, race: str, situation: Situation) -> list[float]:
    """Length of the lag's arc over the ball's diameter, and the arc itself, logarithms."""
    bearing = situation.bearing()
    length = lag_arc * bearing.raceway_radius(race)
    return [math.log(length / bearing.ball_diameter), math.log(lag_arc)]


def _load_columns(own: int, lag_arc: float, evidence: Evidence, situation: Situation) -> list[float]:
    """What a load lets expect: static compression over the ball's radius, twice the static release arc over the lag's;
    vibration, sway and the jumps at entry, at exit and at their largest over the load; displacement over compression.
    """
    bearing, load = situation.bearing(), situation.load or 0.0
    pressed = static_compression(bearing, load) / bearing.ball_radius
    arc = 2.0 * release_arc(bearing, evidence.race, load)
    give = evidence.mean.give_unit / evidence.rate**2
    levels = [*evidence.pairs.features[own, CORES], math.log(float(evidence.mean.energy[0].max()))]
    jumps = [evidence.unit * math.exp(0.5 * float(level)) for level in levels]
    return [
        math.log(max(pressed, 1e-9)),
        math.log(max(arc, 1e-9) / lag_arc),
        math.log1p(arc / lag_arc),
        *(math.log(max(size, 1e-12) / load) for size in (evidence.deviation, evidence.mean.sway_unit, *jumps)),
        math.log(max(give, 1e-15) / max(pressed * bearing.ball_radius, 1e-9)),
    ]
