"""How far probabilities can be relied on: what was predicted against what was there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array

BINS = 10


def equal_priors(positive: NDArray[np.bool_]) -> Array:
    """Weights (N,) that give the `positive` (N,) records the same total weight as the others; they sum to N if there
    are both."""
    positive = np.asarray(positive, dtype=bool)
    count = max(int(positive.sum()), 1), max(int((~positive).sum()), 1)
    return np.asarray(0.5 * positive.size / np.where(positive, *count))


def reliability(positive: NDArray[np.bool_], probability: Array) -> dict[str, list[float]]:
    """The reliability diagram of probabilities (N,) predicted under equal priors, in ten equal bins, a list with a
    value per bin.

    `predicted` is the mean probability of the bin's records, `observed` the share of them that are `positive` (N,),
    both with the weights of `equal_priors`; `records` is their number and `weight` their total weight. Empty bins are
    left out.
    """
    positive, probability, weights = np.asarray(positive, dtype=bool), np.asarray(probability), equal_priors(positive)
    place = np.minimum((probability * BINS).astype(np.int64), BINS - 1)
    used = [place == bin_ for bin_ in range(BINS) if (place == bin_).any()]
    return {
        "predicted": [float(np.average(probability[rows], weights=weights[rows])) for rows in used],
        "observed": [float(np.average(positive[rows], weights=weights[rows])) for rows in used],
        "records": [float(rows.sum()) for rows in used],
        "weight": [float(weights[rows].sum()) for rows in used],
    }


def calibration_error(positive: NDArray[np.bool_], probability: Array) -> float:
    """Expected calibration error: the weighted mean, over the bins of `reliability`, of how far the predicted
    probability is from the observed share of `positive` (N,) records; NaN without records."""
    curve = reliability(positive, probability)
    weight = np.array(curve["weight"])
    if weight.size == 0:
        return float("nan")
    gaps = np.abs(np.array(curve["predicted"]) - np.array(curve["observed"]))
    return float((gaps * weight).sum() / weight.sum())
