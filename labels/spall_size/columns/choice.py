"""Columns that compare the pair taken for the events with the other leading pairs."""

from __future__ import annotations

import math

import numpy as np

from labels.spall_size.columns.rivals import NEAR, SAME
from labels.spall_size.events.leading import LEADING
from physics.arrays import Array

# Smallest rank that is used as a weight of lags.
LEAST_RANK = 1e-6
# Entered as rank of a rival where all leading pairs agree.
NO_RIVAL = -1.0
NAMES = (
    "rank",
    "rival_rank",
    "rival_apart",
    "ranked_near_apart",
    "ranked_near_spread",
    *(f"rank_{k + 1}" for k in range(LEADING)),
    *(f"apart_{k + 1}" for k in range(LEADING)),
)


def measure(lag: Array, rank: Array) -> dict[str, float]:
    """Values by NAMES of the pair of the best `rank` (L,) among those of the `lag` (L,).

    Its rank; rank and lag of the best one that says something else; mean and spread of the lags that may mean the same
    events, by rank; ranks and lags from the best rank down to the last, then zeros. Lags are logarithms over its own.
    """
    best = int(np.argmax(rank))
    apart = np.log(lag / lag[best])
    weight = np.maximum(rank, LEAST_RANK) ** 2 * (np.abs(apart) < NEAR)
    middle = float((weight * apart).sum() / weight.sum())
    others = np.where(np.abs(apart) > SAME, rank, NO_RIVAL)
    rival = int(np.argmax(others))
    found = {
        "rank": float(rank[best]),
        "rival_rank": float(others[rival]),
        "rival_apart": float(apart[rival]),
        "ranked_near_apart": middle,
        "ranked_near_spread": math.sqrt(float((weight * (apart - middle) ** 2).sum() / weight.sum())),
    }
    order = np.argsort(-rank, kind="stable")
    for name, values in (("rank", rank), ("apart", apart)):
        padded = np.pad(values[order], (0, LEADING - order.size))
        found |= {f"{name}_{k + 1}": float(value) for k, value in enumerate(padded)}
    return found
