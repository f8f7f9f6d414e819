"""90 % intervals of what is measured on several records per bearing, by a bootstrap over bearings, not records."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from datagen.scenarios.streams import stream
from datagen.sizing.scored_record import ScoredRecord
from labels.interval import Interval
from physics.arrays import Array

RESAMPLES = 2000
TAIL = 0.05


def bearing_numbers(records: list[ScoredRecord]) -> NDArray[np.int64]:
    """A number (N,) of the bearing of each record; a record of an unknown bearing has one of its own."""
    groups = [record.bearing_group for record in records]
    number = {group: place for place, group in enumerate(sorted(set(groups)))}
    return np.array([number[group] for group in groups], dtype=np.int64)


def interval_over_bearings(
    values: Array, bearing: NDArray[np.int64], weights: Array | None = None, *, is_share: bool
) -> tuple[float, float]:
    """Ends of the 90 % interval of the mean of `values` (N,), by drawing bearings anew, each with all its records.

    `bearing` (N,) is the number of the bearing of each value. With `weights` (N,) it is the interval of the sum of the
    values over the sum of the weights. Where that `is_share`, and 0, or 1, for every bearing, the other end is that of
    the exact binomial interval of as many bearings [Clopper & Pearson 1934]. NaN for fewer than two bearings, and if
    all weights are 0.
    """
    _, group = np.unique(bearing, return_inverse=True)
    total, count = np.bincount(group, values), np.bincount(group, weights)
    if count.size < 2:
        return math.nan, math.nan
    drawn = stream(0, "part", 0, "bootstrap").integers(count.size, size=(RESAMPLES, count.size))
    above, below = total[drawn].sum(axis=1), count[drawn].sum(axis=1)
    if not below.any():
        return math.nan, math.nan
    low, high = np.quantile(above[below > 0.0] / below[below > 0.0], [TAIL, 1.0 - TAIL])
    if is_share and low == high and low in (0.0, 1.0):
        unseen = 1.0 - TAIL ** (1.0 / np.count_nonzero(count))
        return max(float(low) - unseen, 0.0), min(float(high) + unseen, 1.0)
    return float(low), float(high)


def mean_with_interval(values: list[float], records: list[ScoredRecord], *, is_share: bool = False) -> Interval:
    """The mean of the `values` of these records and its interval, those left out that are no finite number, as where an
    estimator left a field out; NaN if none is left. It `is_share` if each value is 0 or 1 for no or yes."""
    every = np.array(values, dtype=np.float64)
    known = np.isfinite(every)
    if not known.any():
        return Interval(math.nan, math.nan, math.nan)
    ends = interval_over_bearings(every[known], bearing_numbers(records)[known], is_share=is_share)
    return Interval(float(every[known].mean()), *ends)
