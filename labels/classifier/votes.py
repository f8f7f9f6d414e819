"""One vote a record: what its windows and axes say, joined. Of several axes the one that says most counts twice.

Sensors beside a spall may hear it or not, and a healthy machine shakes most of them alike. So one clear axis shall not
be outvoted by a quiet one, nor shall the loudest of many healthy ones decide alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array, Flags

SMALLEST = 1e-6
# Times that the axis which says most counts, where another counts once.
LOUDEST_COUNTS = 2.0
# Highest records, as a share of all, from which it is taken how much higher records lie because their loudest axis
# counts more: alarms are decided there, and the few above one alarm alone would be chance.
HIGHEST = 0.2


def joined(
    probability: Array, owner: NDArray[np.int64], records: NDArray[np.int64], shares: Array | None = None
) -> Array:
    """Probabilities (R, C) of `records` (R,): the geometric mean of those (N, C) of the rows each owns (N,), sum 1.

    The `shares` (N,) of rows in it are even if None. NaN for a record without rows.
    """
    level = np.exp(averaged(np.log(np.maximum(probability, SMALLEST)), owner, records, shares))
    return np.asarray(level / level.sum(axis=1, keepdims=True))


def averaged(values: Array, owner: NDArray[np.int64], records: NDArray[np.int64], shares: Array | None = None) -> Array:
    """Means (R, …) of the values (N, …) of the rows that each of `records` (R,) owns (N,); NaN without rows.

    The `shares` (N,) of rows in them are even if None. A record may be asked for more than once; rows of others are
    left out.
    """
    distinct, place = np.unique(records, return_inverse=True)
    nearest = np.minimum(np.searchsorted(distinct, owner), max(distinct.size - 1, 0))
    asked = distinct[nearest] == owner if distinct.size else np.zeros(owner.size, dtype=bool)
    weight = np.ones(owner.size) if shares is None else shares
    total = np.zeros((distinct.size, *values.shape[1:]))
    np.add.at(total, nearest[asked], (values.T * weight).T[asked])
    count = np.bincount(nearest[asked], weight[asked], minlength=distinct.size).astype(np.float64)
    count[count == 0.0] = np.nan
    return np.asarray((total.T / count).T[place])


def vote_shares(level: Array, owner: NDArray[np.int64], axis: NDArray[np.int64]) -> Array:
    """Shares (N,) of rows in the vote of their record, 1 in sum: of its axes, the one of highest mean `level` (N,)
    counts twice; rows of one `axis` (N,) of one `owner` (N,), which are its windows, share alike."""
    axes, place = np.unique(np.stack([owner, axis]), axis=1, return_inverse=True)
    _, record = np.unique(axes[0], return_inverse=True)
    rows = np.bincount(place)
    loudest = np.lexsort((np.bincount(place, level) / rows, record))[np.cumsum(np.bincount(record)) - 1]
    voices = np.ones(rows.size)
    voices[loudest] = LOUDEST_COUNTS
    return np.asarray((voices / np.bincount(record, voices)[record] / rows)[place])


def of_several_axes(owner: NDArray[np.int64], axis: NDArray[np.int64], records: NDArray[np.int64]) -> Flags:
    """Which (R,) of `records` (R,) own rows of more than one axis; `owner` and `axis` (N,) are those of each row."""
    axes = np.unique(np.stack([owner, axis]), axis=1)[0]
    return np.isin(records, axes[1:][axes[1:] == axes[:-1]])


def raised(level: Array, owner: NDArray[np.int64], axis: NDArray[np.int64]) -> float:
    """How much higher healthy records of several axes lie because their loudest axis counts more, on average over the
    highest fifth of them, by votes and by the plain means of their rows; 0 without such records.

    `level` (N, C) are logarithms of the rows, of whose columns the highest counts, `owner` (N,) their records and
    `axis` (N,) their axes. Of n axes it is about the same for any n: the largest of more normal numbers lies farther
    from their mean, and counts for less of it.
    """
    records = np.unique(owner)
    several = records[of_several_axes(owner, axis, records)]
    if several.size == 0:
        return 0.0
    count = int(np.ceil(HIGHEST * several.size))
    votes, means = (
        np.sort(averaged(level, owner, several, shares).max(axis=1))[-count:].mean()
        for shares in (vote_shares(level.max(axis=1), owner, axis), None)
    )
    return float(votes - means)
