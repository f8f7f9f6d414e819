"""The feature table: every feature by name, and the row of values of one record."""

from __future__ import annotations

import numpy as np

from labels.features import modulation, orders, waveform
from labels.features.analysis import Analysis, analyse
from labels.features.conditioning import COMMON_BANDWIDTH, Array
from labels.features.feature import Feature
from labels.features.kinematics import Kinematics

GROUPS = (waveform, modulation, orders)
FEATURES: tuple[Feature, ...] = tuple(row for group in GROUPS for row in group.ROWS)
FEATURE_NAMES: tuple[str, ...] = tuple(row.name for row in FEATURES)


def feature_values(analysis: Analysis) -> Array:
    """Values (F,) of all FEATURES, in their order."""
    found: dict[str, float] = {}
    for group in GROUPS:
        found |= group.measure(analysis)
    return np.array([found[name] for name in FEATURE_NAMES])


def features(signal: Array, rate: float, kinematics: Kinematics, bandwidth: float = COMMON_BANDWIDTH) -> Array:
    """Values (F,) of all FEATURES of one axis (T,) sampled at `rate` (Hz); ValueError if it holds no signal."""
    return feature_values(analyse(signal, rate, kinematics, bandwidth))
