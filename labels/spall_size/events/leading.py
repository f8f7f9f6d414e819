"""The pairs that lead by their score, and what their columns are computed from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.pairs import Pairs
from labels.spall_size.situation import Situation
from physics.arrays import Array

# Largest number of leading pairs.
LEADING = 16
# Logarithm of the ratio of two lags above which both may lead: of those that say nearly the same the best stands for
# all.
DISTINCT = 0.05


@dataclass(frozen=True)
class LeadingView:
    """The `evidence` of a record, the `score` (P,) of all its pairs, what is known of its `situation`, and which pairs
    lead, `order` (L,), LEADING of them at most, the best first."""

    evidence: Evidence
    score: Array
    situation: Situation
    order: NDArray[np.int64]

    @cached_property
    def entry(self) -> Array:
        """Places (L,) of the first events, samples from the anchor."""
        return self.evidence.pairs.entry[self.order]

    @cached_property
    def exit(self) -> Array:
        """Places (L,) of the last events, samples from the anchor."""
        return self.evidence.pairs.exit[self.order]

    @cached_property
    def lag(self) -> Array:
        """Time (L,) between both events, samples."""
        return self.evidence.pairs.lag[self.order]

    @cached_property
    def lag_arc(self) -> Array:
        """Arc (L,) of the race that a ball covers in the lag, rad."""
        # The tracked period stands for one ball spacing, whatever the stated speed and the slip were.
        return self.lag / self.evidence.mean.period * self.situation.bearing().spacing

    @property
    def features(self) -> Array:
        """What is known (L, F) of these among all pairs, `table.PAIR_COLUMNS`."""
        return self.evidence.pairs.features[self.order].astype(np.float64)


def leading_view(evidence: Evidence, score: Array, situation: Situation) -> LeadingView:
    """What the columns of the pairs of `evidence` that lead by `score` (P,) are computed from."""
    return LeadingView(evidence, score, situation, leading_order(evidence.pairs, score))


def leading_order(pairs: Pairs, score: Array) -> NDArray[np.int64]:
    """Indices (L,) of the `pairs` of different lags that lead by `score` (P,), the best first."""
    lag, chosen = np.log(pairs.lag), list[int]()
    for pair in np.argsort(-score, kind="stable"):
        if np.all(np.abs(lag[pair] - lag[chosen]) > DISTINCT):
            chosen.append(int(pair))
        if len(chosen) == LEADING:
            break
    return np.array(chosen)
