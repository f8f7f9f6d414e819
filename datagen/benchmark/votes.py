"""One vote a record: the probabilities of its windows and axes, joined."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from labels.features.conditioning import Array

SMALLEST = 1e-6


def joined(probability: Array, owner: NDArray[np.int64], records: NDArray[np.int64]) -> Array:
    """Probabilities (R, C) of `records` (R,): the geometric mean of those (N, C) of the rows each owns (N,), sum 1.

    NaN for a record without rows.
    """
    found = np.full((records.size, probability.shape[1]), np.nan)
    for place, record in enumerate(records.tolist()):
        own = probability[owner == record]
        if own.size:
            level = np.exp(np.log(np.maximum(own, SMALLEST)).mean(axis=0))
            found[place] = level / level.sum()
    return found


def averaged(values: Array, owner: NDArray[np.int64], records: NDArray[np.int64]) -> Array:
    """Means (R, …) of the values (N, …) of the rows that each of `records` (R,) owns (N,); NaN without rows."""
    means = [values[owner == record].mean(axis=0) if (owner == record).any() else None for record in records.tolist()]
    blank = np.full(values.shape[1:], np.nan)
    return np.array([blank if mean is None else mean for mean in means])
