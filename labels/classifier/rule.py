"""The yardstick: a rule without learning, the larger of the two races' line families over a floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from labels.features.table import FEATURE_NAMES
from physics.arrays import Array
from physics.bearing import RACES

QUANTILE = 0.95
STRENGTHS = tuple(f"{race}_strength" for race in RACES)


def strengths(table: Array) -> Array:
    """Heights (N, 2) of the outer and inner line family over the floor, from rows (N, F) of the feature table."""
    columns = [FEATURE_NAMES.index(name) for name in STRENGTHS]
    return np.exp(np.asarray(table)[:, columns])


@dataclass(frozen=True)
class Rule:
    """Says "none" unless a race's family stands higher over the floor than `threshold`; then the higher race."""

    threshold: float

    def score(self, table: Array) -> Array:
        """Height (N,) of the higher family of each row, NaN for a row of NaN: what is compared with the threshold."""
        return np.asarray(strengths(table).max(axis=1))

    def races(self, table: Array) -> NDArray[np.str_]:
        """The race (N,) of the higher family, whether it passes the threshold or not; of finite rows only."""
        return np.asarray(RACES)[strengths(table).argmax(axis=1)]

    def locations(self, table: Array) -> NDArray[np.str_]:
        """Location (N,): none, outer or inner."""
        return np.where(self.score(table) > self.threshold, self.races(table), "none")


def fit_rule(healthy: Array) -> Rule:
    """The rule with its one threshold at the 95 % quantile of the rows (N, F) of healthy synthetic records.

    ValueError if there is none.
    """
    if len(healthy) == 0:
        raise ValueError("the rule needs healthy records to set its threshold")
    return Rule(float(np.quantile(strengths(healthy).max(axis=1), QUANTILE)))
