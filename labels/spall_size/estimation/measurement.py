"""The leading pairs of events of a record, described by all that is known, and the one that is taken for the events."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labels.spall_size.columns.table import chosen_row, leading_rows
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.leading import LeadingView, leading_order
from labels.spall_size.situation import Situation
from physics.arrays import Array


@dataclass(frozen=True)
class LeadingPairs:
    """The pairs of the best scores, best first: `entry`, `exit` (L,) in samples from the anchor, `lag` (L,) in samples,
    its arc `lag_arc` (L,) in rad, and a row of numbers for each, `rows` (L, F), as `table.leading_rows` gives them."""

    entry: Array
    exit: Array
    lag: Array
    lag_arc: Array
    rows: Array


@dataclass(frozen=True)
class Measurement:
    """One pair taken for the events: as in LeadingPairs, and `row` (F,) with how it stands among the others, as
    `table.chosen_row` gives it."""

    entry: float
    exit: float
    lag: float
    lag_arc: float
    row: Array


def leading_pairs(evidence: Evidence, score: Array, situation: Situation) -> LeadingPairs:
    """At most LEADING pairs of `evidence` by `score` (P,); rows are longer if load and Hertz factor are known."""
    view = LeadingView(evidence, score, situation, leading_order(evidence.pairs, score))
    return LeadingPairs(view.entry, view.exit, view.lag, view.lag_arc, leading_rows(view))


def measure(leading: LeadingPairs, rank: Array) -> Measurement:
    """The pair of the best `rank` (L,) among `leading`."""
    best = int(np.argmax(rank))
    return Measurement(
        entry=float(leading.entry[best]),
        exit=float(leading.exit[best]),
        lag=float(leading.lag[best]),
        lag_arc=float(leading.lag_arc[best]),
        row=chosen_row(leading.rows, leading.lag, rank),
    )
