"""One vote a record: the probabilities of its windows and axes, joined."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array

SMALLEST = 1e-6


def joined(probability: Array, owner: NDArray[np.int64], records: NDArray[np.int64]) -> Array:
    """Probabilities (R, C) of `records` (R,): the geometric mean of those (N, C) of the rows each owns (N,), sum 1.

    NaN for a record without rows.
    """
    level = np.exp(averaged(np.log(np.maximum(probability, SMALLEST)), owner, records))
    return np.asarray(level / level.sum(axis=1, keepdims=True))


def averaged(values: Array, owner: NDArray[np.int64], records: NDArray[np.int64]) -> Array:
    """Means (R, …) of the values (N, …) of the rows that each of `records` (R,) owns (N,); NaN without rows.

    A record may be asked for more than once; rows of others are left out.
    """
    own, place = np.unique(records, return_inverse=True)
    nearest = np.minimum(np.searchsorted(own, owner), max(own.size - 1, 0))
    asked = own[nearest] == owner if own.size else np.zeros(owner.size, dtype=bool)
    total = np.zeros((own.size, *values.shape[1:]))
    np.add.at(total, nearest[asked], values[asked])
    count = np.bincount(nearest[asked], minlength=own.size).astype(np.float64)
    count[count == 0.0] = np.nan
    return np.asarray((total.T / count).T[place])
