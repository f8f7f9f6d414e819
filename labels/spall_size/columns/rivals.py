"""Columns that compare the score of a leading pair with those of the others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.events.leading import LeadingView
from labels.spall_size.events.pairs import Pairs
from physics.arrays import Array

# Logarithm of the ratio of two lags up to which they count as equal.
SAME = 0.03
# Logarithm of the ratio of two lags up to which they may mean the same events.
NEAR = 0.3
# How many pairs of other lags have columns.
RIVALS = 3
NAMES = (
    "own_score",
    *(f"rival_{k + 1}_{what}" for k in range(RIVALS) for what in ("score", "apart")),
    "near_apart",
    "behind_first",
    "place",
)


def measure(view: LeadingView) -> dict[str, Array]:
    """Columns (L,) by NAMES: the pair's own score; scores of the best pairs of other lags and how far these lags lie
    from its own, logarithms, zeros where there are none; how far those lie that may mean the same events, on average;
    how far its score lies from that of the first, 0 or below; and its place among the leading, from 0."""
    best = np.argsort(-view.score, kind="stable")  # else equal ones come in an order that processors differ in
    against = [_against(view.evidence.pairs, view.score, best, int(pair)) for pair in view.order]
    return {name: np.array([values[name] for values in against]) for name in against[0]} | {
        "behind_first": view.score[view.order] - view.score[view.order[0]],
        "place": np.arange(view.order.size, dtype=np.float64),
    }


def _against(pairs: Pairs, score: Array, best: NDArray[np.int64], pair: int) -> dict[str, float]:
    """Values by NAMES of a `pair` against all others, which are in `best` (P,) in the order of their `score`."""
    apart = np.log(pairs.lag / pairs.lag[pair])
    rivals = best[np.abs(apart[best]) > SAME][:RIVALS]
    found = {"own_score": float(score[pair])}
    for k in range(RIVALS):
        there = k < rivals.size
        found[f"rival_{k + 1}_score"] = float(score[rivals[k]]) if there else 0.0
        found[f"rival_{k + 1}_apart"] = float(apart[rivals[k]]) if there else 0.0
    weight = np.maximum(score, 0.0) ** 2 * (np.abs(apart) < NEAR)
    return found | {"near_apart": float((weight * apart).sum() / max(weight.sum(), 1e-12))}
