"""Divisors that a silent stretch does not bring to zero."""

from __future__ import annotations

from typing import Any

import numpy as np

# Below the level of any signal that is not silent.
TINIEST = 1e-300


def divisor(level: float | np.floating[Any]) -> float:
    """The `level` of a signal to divide by: at least TINIEST, so that silence over its own level is silence."""
    return max(float(level), TINIEST)
