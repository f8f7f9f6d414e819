"""Weights of every step of whole units or samples, and of the samples inside strides, computed before a march."""

from __future__ import annotations

import numpy as np

from physics._jit import njit_lean
from physics.arrays import Array
from physics.integrators.modal.flow import AMPLITUDES, LinearFlow
from physics.integrators.modal.layout import INSIDE_WEIGHTS, POWERS, STEP_WEIGHTS
from physics.integrators.modal.memory import FIRST_INSIDE, ROWS, STRIDES, UNITS
from physics.integrators.modal.weights import set_inside, set_step

INSIDE_ROWS = FIRST_INSIDE[-1] + STRIDES[-1] - 1


@njit_lean
def _fill(flow: LinearFlow, interval: float, weights: Array, inside: Array, phi: Array) -> None:
    for k in range(UNITS + 1):
        set_step(flow, weights[k], k * (interval / UNITS), phi)
    for level in range(len(STRIDES)):
        size, first = STRIDES[level], FIRST_INSIDE[level]
        set_step(flow, weights[UNITS + 1 + level], size * interval, phi)
        set_inside(flow, inside[first : first + size - 1], size * interval, phi[0])


def tables_for(flow: LinearFlow, interval: float) -> tuple[Array, Array]:
    """Weights (26, 168) of steps of 0 to 16 units, of the strides and room for one more, on a grid of `interval` (s),
    and weights (67, 172) of the samples inside strides."""
    weights, inside = empty_tables()
    _fill(flow, interval, weights, inside, np.zeros((2, POWERS + 1, AMPLITUDES)))
    return weights, inside


def empty_tables() -> tuple[Array, Array]:
    """Arrays for what `tables_for` gives, all zero."""
    return np.zeros((ROWS, STEP_WEIGHTS)), np.zeros((INSIDE_ROWS, INSIDE_WEIGHTS))
