"""Numbers that are equally likely in the logarithm."""

from __future__ import annotations

import numpy as np


def log_uniform(generator: np.random.Generator, low: float, high: float) -> float:
    """A number from `low` to `high`, both above 0."""
    return float(np.exp(generator.uniform(np.log(low), np.log(high))))
