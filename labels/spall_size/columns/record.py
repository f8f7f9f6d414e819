"""Columns that place a pair in its record: its lag, and what all pairs of the record share."""

from __future__ import annotations

import math

import numpy as np

from labels.spall_size.events.pairs import PairView
from physics.arrays import Array

NAMES = (
    "period",
    "lag",
    "lag_share",
    "passes",
    "score",
    "inner",
    "peakedness",
    "predictability",
    "noise",
    "candidates",
)


def measure(view: PairView) -> dict[str, Array]:
    """Columns (P,) by NAMES: log period and lag (samples), the lag in periods, log effective number of passes, the
    RecordFacts (`inner` 0 or 1), and how many candidates there are."""
    ones = np.ones(view.lag.size)
    shared = {
        "period": math.log(view.mean.period),
        "passes": math.log(max(view.mean.passes, 1.0)),
        "score": view.facts.score,
        "inner": float(view.facts.inner),
        "peakedness": view.facts.peakedness,
        "predictability": view.facts.predictability,
        "noise": view.facts.noise,
        "candidates": view.places.size,
    }
    of_pair = {"lag": np.log(view.lag), "lag_share": view.lag / view.mean.period}
    return of_pair | {name: value * ones for name, value in shared.items()}
