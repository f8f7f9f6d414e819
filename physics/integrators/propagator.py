"""The linear part of the motion solved exactly: outer ring and resonator under a force that is a polynomial in time.

Each direction is u' = L u + b F with u = (xo, vo, xr, vr). A step of length h needs exp(hL) and the φ-functions
φm(hL) b h; both are power series in h whose matrix powers are computed once per scene, so any step length is cheap.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from physics._jit import njit, njit_inner
from physics.arrays import Array
from physics.motion import MotionModel, axis_matrix

SERIES_TOLERANCE = 1e-18
MODELS_KEPT = 8


class PowerSeries(NamedTuple):
    """`power` (2, J, 4, 4): (h0 L)^j and `kick` (2, J, 4): (h0 L)^j b h0, per axis; `step` is h0 in s.

    `reach` is the largest |eigenvalue| of h0 L, which says how many terms a shorter step needs.
    """

    power: Array
    kick: Array
    step: float
    reach: float


# First rows of the weights of one step, (2, 13, 4): the first index is the axis, the last (xo, vo, xr, vr). Those of
# forces are for the exponential Runge-Kutta method of Krogstad, from whose stages others follow.
WHOLE = 0  # four rows: exp(hL)
HALF = 4  # two rows, of xo and vo: exp(hL/2)
FIRST, MIDDLE, LAST = 6, 7, 8  # of the forces at the beginning, in the middle and at the end, in the new state
# Of earlier forces in later stages, a pair for (xo, vo) each: of the first force in the second stage and in the third;
# of the second in the third and of the first in the fourth; of the third in the fourth.
TO_2_3, TO_3_4, TO_4 = 9, 10, 11
CUBE = 12  # φ4, for a force with a cube
WEIGHT_ROWS = 13


def linear_matrix(motion: MotionModel, axis: int) -> Array:
    """L (4, 4) of (xo, vo, xr, vr) along one axis [P14 Eq. 13-15]."""
    return np.array(axis_matrix(motion, axis, 0.0, 0.0))[2:, 2:]


def reach(motion: MotionModel, step: float) -> float:
    """Largest |eigenvalue| of the linear part times `step`: how many radians its fastest mode turns in one step."""
    return _fastest(motion) * step


def fast_periods(motion: MotionModel, step: float) -> float:
    """How many periods of its fastest mode a `step` (s) is."""
    return reach(motion, step) / (2.0 * math.pi)


@lru_cache(maxsize=MODELS_KEPT)
def _fastest(motion: MotionModel) -> float:
    """Largest |eigenvalue| (1/s) of the linear part; asked for several times a scene."""
    matrices = np.array([linear_matrix(motion, axis) for axis in range(2)])
    return float(np.abs(np.linalg.eigvals(matrices)).max())


def power_series(motion: MotionModel, step: float) -> PowerSeries:
    """Matrix powers for steps up to `step` (s), enough of them for round-off accuracy."""
    size = reach(motion, step)
    terms = 2
    while size**terms / math.factorial(terms) > SERIES_TOLERANCE:
        terms += 1
    power = np.zeros((2, terms + 1, 4, 4))
    kick = np.zeros((2, terms + 1, 4))
    for axis in range(2):
        scaled = step * linear_matrix(motion, axis)
        power[axis, 0] = np.eye(4)
        for j in range(1, terms + 1):
            power[axis, j] = scaled @ power[axis, j - 1]
        kick[axis] = power[axis] @ np.array([0.0, step / motion.outer_mass, 0.0, 0.0])
    return PowerSeries(power, kick, step, size)


@njit
def set_step(series: PowerSeries, weights: Array, share: float) -> None:
    """Fill `weights` (2, 13, 4) for a step of `share` (0 to 1) times the step of the series."""
    phi = np.zeros((5, 4))
    for axis in range(2):
        _sum_matrix(series.power[axis], share, series.reach, weights[axis, WHOLE : WHOLE + 4])
        _sum_matrix(series.power[axis, :, :2], 0.5 * share, series.reach, weights[axis, HALF : HALF + 2])
        _sum_phi(series.kick[axis], 0.5 * share, series.reach, phi)
        for row in range(2):
            # These φ are of half the step and carry the factor h/2.
            weights[axis, TO_2_3, row] = phi[1, row]
            weights[axis, TO_2_3, 2 + row] = phi[1, row] - 2.0 * phi[2, row]
            weights[axis, TO_3_4, row] = 2.0 * phi[2, row]
        _sum_phi(series.kick[axis], share, series.reach, phi)
        for row in range(4):
            weights[axis, FIRST, row] = phi[1, row] - 3.0 * phi[2, row] + 4.0 * phi[3, row]
            weights[axis, MIDDLE, row] = 2.0 * phi[2, row] - 4.0 * phi[3, row]
            weights[axis, LAST, row] = 4.0 * phi[3, row] - phi[2, row]
            weights[axis, CUBE, row] = phi[4, row]
        for row in range(2):
            weights[axis, TO_3_4, 2 + row] = phi[1, row] - 2.0 * phi[2, row]
            weights[axis, TO_4, row] = 2.0 * phi[2, row]


@njit_inner
def _sum_matrix(power: Array, share: float, reach: float, total: Array) -> None:
    total[:] = 0.0
    weight, size = 1.0, 1.0
    for j in range(power.shape[0]):
        for row in range(total.shape[0]):
            for column in range(4):
                total[row, column] += weight * power[j, row, column]
        weight *= share / (j + 1.0)
        size *= share * reach / (j + 1.0)
        if size < SERIES_TOLERANCE:
            break


@njit_inner
def _sum_phi(kick: Array, share: float, reach: float, phi: Array) -> None:
    """Rows m = 1 to 4 of `phi`: φm(share h0 L) b share h0 = Σ_j share^(j + 1) (h0 L)^j b h0 / (j + m)!"""
    phi[:] = 0.0
    weight, size = share, 1.0
    for j in range(kick.shape[0]):
        one = weight / (j + 1.0)
        two = one / (j + 2.0)
        three = two / (j + 3.0)
        for row in range(4):
            phi[1, row] += one * kick[j, row]
            phi[2, row] += two * kick[j, row]
            phi[3, row] += three * kick[j, row]
            phi[4, row] += three / (j + 4.0) * kick[j, row]
        weight *= share / (j + 1.0)
        size *= share * reach / (j + 1.0)
        if size < SERIES_TOLERANCE:
            break
