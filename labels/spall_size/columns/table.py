"""The columns by which pairs of events are judged: their names in a fixed order, and the rows of their values.

Trees know columns by their place alone. A column that is added, left out, renamed or moved asks for a new fit, and a
calibration that was fitted to others is refused.
"""

from __future__ import annotations

import numpy as np

from labels.spall_size.columns import (
    choice,
    event_profiles,
    event_shapes,
    length,
    levels,
    likeness,
    load,
    motion,
    record,
    rivals,
)
from labels.spall_size.events.leading import LeadingView
from labels.spall_size.events.pairs import PairView
from physics.arrays import Array

PAIR_GROUPS = (record, levels, likeness, motion, event_shapes)
LEADING_GROUPS = (event_profiles, rivals, length)
# Of every pair of candidates.
PAIR_COLUMNS: tuple[str, ...] = tuple(name for group in PAIR_GROUPS for name in group.NAMES)
# Of a leading pair of a record whose load or Hertz factor is not known.
LEADING_COLUMNS: tuple[str, ...] = (*PAIR_COLUMNS, *(name for group in LEADING_GROUPS for name in group.NAMES))
# Of a leading pair of a record whose load and Hertz factor are known.
LEADING_COLUMNS_WITH_LOAD: tuple[str, ...] = (*LEADING_COLUMNS, *load.NAMES)
# Of the pair that is taken for the events, load or Hertz factor not known.
ROW_COLUMNS: tuple[str, ...] = (*LEADING_COLUMNS, *choice.NAMES)
# Of the pair that is taken for the events, load and Hertz factor known.
ROW_COLUMNS_WITH_LOAD: tuple[str, ...] = (*LEADING_COLUMNS_WITH_LOAD, *choice.NAMES)


def pair_rows(view: PairView) -> Array:
    """Values (P, F) of PAIR_COLUMNS."""
    found: dict[str, Array] = {}
    for group in PAIR_GROUPS:
        found |= group.measure(view)
    return np.column_stack([found[name] for name in PAIR_COLUMNS])


def leading_rows(view: LeadingView) -> Array:
    """Values (L, F) of LEADING_COLUMNS, or of LEADING_COLUMNS_WITH_LOAD where load and Hertz factor are known."""
    found = dict(zip(PAIR_COLUMNS, view.features.T, strict=True))
    for group in LEADING_GROUPS:
        found |= group.measure(view)
    if not view.situation.load_known:
        return np.column_stack([found[name] for name in LEADING_COLUMNS])
    found |= load.measure(view, found)
    return np.column_stack([found[name] for name in LEADING_COLUMNS_WITH_LOAD])


def chosen_row(leading: Array, lag: Array, rank: Array) -> Array:
    """Values (F,) of ROW_COLUMNS, or of ROW_COLUMNS_WITH_LOAD, of the pair of the best `rank` (L,) among the `leading`
    rows (L, F) of pairs of the `lag` (L,)."""
    found = choice.measure(lag, rank)
    return np.concatenate([leading[int(np.argmax(rank))], [found[name] for name in choice.NAMES]])
