"""Probabilities as natural log odds and back."""

from __future__ import annotations

import numpy as np
from scipy.special import expit

from physics.arrays import Array

EDGE = 1e-4


def logit(probability: Array) -> Array:
    """Log odds ln(p / (1 − p)) of probabilities of any shape, which are kept within 1e-4 of 0 and 1."""
    inside = np.clip(probability, EDGE, 1.0 - EDGE)
    return np.asarray(np.log(inside / (1.0 - inside)))


def probability_of(log_odds: Array) -> Array:
    """Probabilities 1 / (1 + e^−x) of log odds x of any shape."""
    return np.asarray(expit(log_odds))
