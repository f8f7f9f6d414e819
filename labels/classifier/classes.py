"""The classes that a record is put into, and what follows from their probabilities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from labels.schema import HEALTHY
from physics.arrays import Array

CLASSES = (HEALTHY, "line outer", "line inner", "extended outer", "extended inner")
EVEN = 0.5


def called(probability: Array, alarming: NDArray[np.bool_]) -> NDArray[np.str_]:
    """The class (N,) from probabilities (N, 5): the likeliest spall where `alarming` (N,) is True, else healthy."""
    likeliest = np.asarray(CLASSES[1:])[probability[:, 1:].argmax(axis=1)]
    return np.where(alarming, likeliest, HEALTHY)


def location_probability(probability: Array) -> Array:
    """Probabilities (N, 3) of none, outer and inner from those (N, 5) of CLASSES."""
    return np.column_stack(
        [probability[:, 0], probability[:, 1] + probability[:, 3], probability[:, 2] + probability[:, 4]]
    )


def condition_probability(probability: Array) -> Array:
    """Probabilities (N, 3) of healthy, line and extended from those (N, 5) of CLASSES."""
    return np.column_stack(
        [probability[:, 0], probability[:, 1] + probability[:, 2], probability[:, 3] + probability[:, 4]]
    )


def joint_class(condition: str, location: str) -> str:
    """The one of CLASSES with this condition and location; ValueError for words that name none of them."""
    name = HEALTHY if condition == HEALTHY else f"{condition} {location}"
    if name not in CLASSES:
        raise ValueError(f'condition "{condition}" and location "{location}"; allowed: {", ".join(CLASSES)}')
    return name
