"""The feature table: every feature by name, and the row of values of one record."""

from __future__ import annotations

import numpy as np

from labels.features import modulation, orders, waveform
from labels.features.analysis import Analysis
from labels.features.feature import Feature
from physics.arrays import Array

GROUPS = (waveform, modulation, orders)
FEATURES: tuple[Feature, ...] = tuple(row for group in GROUPS for row in group.ROWS)
FEATURE_NAMES: tuple[str, ...] = tuple(row.name for row in FEATURES)


def feature_values(analysis: Analysis) -> Array:
    """Values (F,) of all FEATURES, in their order."""
    found: dict[str, float] = {}
    for group in GROUPS:
        found |= group.measure(analysis)
    return np.array([found[name] for name in FEATURE_NAMES])
