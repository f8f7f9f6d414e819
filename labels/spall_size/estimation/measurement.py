"""Of the leading pairs of a record, the one that is taken for the events."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from labels.spall_size.columns.table import chosen_row
from labels.spall_size.events.leading import LeadingView
from physics.arrays import Array


@dataclass(frozen=True)
class Measurement:
    """One pair taken for the events: `entry` and `exit` in samples from the anchor, its `lag` in samples, the arc of
    that, `lag_arc`, in rad, and a `row` (F,) of all that is known of it, as `table.chosen_row` gives it."""

    entry: float
    exit: float
    lag: float
    lag_arc: float
    row: Array


def measure(leading: LeadingView, rows: Array, rank: Array) -> Measurement:
    """The pair of the best `rank` (L,) among the `leading` ones, described by `rows` (L, F), as `table.leading_rows`
    gives them."""
    best = int(np.argmax(rank))
    return Measurement(
        entry=float(leading.entry[best]),
        exit=float(leading.exit[best]),
        lag=float(leading.lag[best]),
        lag_arc=float(leading.lag_arc[best]),
        row=chosen_row(rows, leading.lag, rank),
    )
