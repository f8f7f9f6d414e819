"""The yardstick: a rule without learning, the larger of the two races' line families over a floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.classifier.votes import averaged, of_several_axes, raised, vote_shares
from labels.features.table import FEATURE_NAMES
from physics.arrays import Array
from physics.bearing import RACES

QUANTILE = 0.95
STRENGTHS = tuple(f"{race}_strength" for race in RACES)


def strengths(table: Array) -> Array:
    """Heights (N, 2) of the outer and inner line family over the floor, from rows (N, F) of the feature table."""
    columns = [FEATURE_NAMES.index(name) for name in STRENGTHS]
    return np.exp(np.asarray(table)[:, columns])


def line_heights(
    table: Array,
    owner: NDArray[np.int64],
    records: NDArray[np.int64],
    axis: NDArray[np.int64],
    of_several: float = 1.0,
) -> Array:
    """Heights (R, 2) of the outer and inner line family of `records` (R,), by the vote of the rows (N, F) of the
    feature table that each owns (N,); NaN without rows.

    `axis` (N,) is the axis of each row. Heights of records of several axes are divided by `of_several`, so that they
    can be compared with those of one.
    """
    level = np.log(strengths(table))
    several = of_several_axes(owner, axis, records)
    heights = np.exp(averaged(level, owner, records, vote_shares(level.max(axis=1), owner, axis)))
    return np.asarray(heights / np.where(several, of_several, 1.0)[:, None])


@dataclass(frozen=True)
class Rule:
    """Says "none" unless a race's family stands higher over the floor than `threshold`; then the higher race.

    Heights of records of several axes are divided by `of_several` before they are compared.
    """

    threshold: float
    of_several: float = 1.0

    def score(self, heights: Array) -> Array:
        """Height (R,) of the higher of each record's families (R, 2), NaN of NaN: what is compared with the
        threshold."""
        return np.asarray(heights.max(axis=1))

    def races(self, heights: Array) -> NDArray[np.str_]:
        """The race (R,) of the higher family, whether it passes the threshold or not; of finite `heights` (R, 2)."""
        return np.asarray(RACES)[heights.argmax(axis=1)]

    def locations(self, heights: Array) -> NDArray[np.str_]:
        """Location (R,) by the `heights` (R, 2) of the families: none, outer or inner."""
        return np.where(self.score(heights) > self.threshold, self.races(heights), "none")


def fit_rule(healthy: Array, owner: NDArray[np.int64], axis: NDArray[np.int64]) -> Rule:
    """The rule with its one threshold at the 95 % quantile of healthy synthetic records, by the means of their axes.

    `healthy` (N, F) are rows of the feature table, `owner` (N,) their records and `axis` (N,) their axes. ValueError if
    there is none.
    """
    if len(healthy) == 0:
        raise ValueError("the rule needs healthy records to set its threshold")
    level = np.log(strengths(healthy))
    means = averaged(level, owner, np.unique(owner))
    threshold = np.exp(np.quantile(means.max(axis=1), QUANTILE))
    return Rule(float(threshold), float(np.exp(raised(level, owner, axis))))
