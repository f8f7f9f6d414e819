"""The table of the waviness: how its columns lie, and how a row of balls reads them.

Each of the spacings of a row is divided into equal cells, over which the waves of either race are polynomials of degree
five. The balls of a row are whole spacings apart, so all of them are at the same place in the same cell of their
spacings: what they read lies side by side, and the powers of that place are computed once for all of them.
"""

from __future__ import annotations

import numpy as np

from physics._jit import njit_pasted
from physics.arrays import Array

# Of the polynomial of one cell.
WAVE_COEFFICIENTS = 6
# Columns that each of these has in the table: room for a row of up to 16 balls twice. Longer rows have twice theirs.
SHORT_ROW_COLUMNS = np.uint64(32)

# A cell of one race and the first column of its table that a row of balls reads.
Cell = tuple[int, np.uint64]
# What the coefficients of a cell are multiplied by, that of the fifth power first.
Weights = tuple[float, float, float, float, float, float]


def wave_columns(balls: int) -> int:
    """How many columns each power of a cell of the waviness has, for rows of so many `balls`."""
    return max(int(SHORT_ROW_COLUMNS), 2 * balls)


@njit_pasted
def powers(x: float) -> Weights:
    """Powers of the place `x` in a cell, 0 to 1, from the fifth down."""
    square = x * x
    return square * square * x, square * square, square * x, square, x, 1.0


@njit_pasted
def rates_of(of_x: Weights, pace: float) -> Weights:
    """Rates of the powers of x where x grows by `pace` a second."""
    _, x4, x3, x2, x, _ = of_x
    return 5.0 * pace * x4, 4.0 * pace * x3, 3.0 * pace * x2, 2.0 * pace * x, pace, 0.0


@njit_pasted
def add_waves(
    balls: Array,
    entry: int,
    here: tuple[np.uint64, np.uint64, np.uint64],
    waves: Array,
    outer: Cell,
    inner: Cell,
    p: Weights,
    q: Weights,
    columns: np.uint64,
) -> None:
    """Add the polynomials of a cell of either race, with the weights `p` of the outer and `q` of the inner one, to an
    `entry` (m or m/s) of the balls of a row: `here` are its cage, its first ball and its size; a power has so many
    `columns`."""
    cage, first, row = here
    second, third = columns, columns + columns
    fourth, fifth, sixth = third + columns, third + third, third + third + columns
    for j in range(row):
        a, b = outer[1] + j, inner[1] + j
        balls[cage, entry, first + j] += (
            (waves[0, outer[0], a] * p[0] + waves[0, outer[0], a + second] * p[1])
            + (waves[0, outer[0], a + third] * p[2] + waves[0, outer[0], a + fourth] * p[3])
            + (waves[0, outer[0], a + fifth] * p[4] + waves[0, outer[0], a + sixth] * p[5])
        ) + (
            (waves[1, inner[0], b] * q[0] + waves[1, inner[0], b + second] * q[1])
            + (waves[1, inner[0], b + third] * q[2] + waves[1, inner[0], b + fourth] * q[3])
            + (waves[1, inner[0], b + fifth] * q[4] + waves[1, inner[0], b + sixth] * q[5])
        )
