"""When a path that rises all along, a piecewise polynomial of time, comes by given values."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PPoly

from physics._jit import njit_inner, njit_lean
from physics.arrays import Array

# Newton's method converges quadratically: a step this small, of the duration, is the last that moves anything.
CROSSING_SHARE, MOST_CROSSING_STEPS = 1e-11, 30


def crossing_times(polynomial: PPoly, mean_speed: float, duration: float, target: Array) -> Array:
    """Times (N,), s, at which a rising piecewise `polynomial` of time is at each `target` (N,), rad.

    Before 0 and after the `duration` (s) the path goes on at the `mean_speed` (rad/s).
    """
    time = np.array(target, dtype=np.float64)
    _cross(np.ascontiguousarray(polynomial.c), polynomial.x, mean_speed, duration, time)
    return time


@njit_lean
def _cross(coefficients: Array, breaks: Array, mean_speed: float, duration: float, targets: Array) -> None:
    """Turn `targets` (N,) into the times at which the pieces with these `coefficients` (degree + 1, I) from one of the
    `breaks` (I + 1,) to the next reach them."""
    first, last = _path_at(coefficients, breaks, 0.0), _path_at(coefficients, breaks, duration)
    for k in range(targets.size):
        target = targets[k]
        if target < first:
            targets[k] = (target - first) / mean_speed
        elif target > last:
            targets[k] = duration + (target - last) / mean_speed
        else:
            targets[k] = min(max(_crossing(coefficients, breaks, duration, target), 0.0), duration)


@njit_inner
def _crossing(coefficients: Array, breaks: Array, duration: float, target: float) -> float:
    """Newton's method in the last piece that begins at or below the `target`."""
    degree = coefficients.shape[0] - 1
    piece, behind = 0, coefficients.shape[1]
    while behind - piece > 1:
        middle = (piece + behind) // 2
        if coefficients[degree, middle] <= target:
            piece = middle
        else:
            behind = middle
    width, since = breaks[piece + 1] - breaks[piece], 0.0
    for _ in range(MOST_CROSSING_STEPS):
        value, slope = _value_and_slope(coefficients, piece, since)
        nearer = min(max(since + (target - value) / slope, 0.0), width)
        moved, since = abs(nearer - since), nearer
        if moved <= CROSSING_SHARE * duration:
            break
    return breaks[piece] + since


@njit_inner
def _path_at(coefficients: Array, breaks: Array, time: float) -> float:
    """What the path is at `time` (s), rad; beyond its ends the outermost pieces go on."""
    piece = coefficients.shape[1] - 1
    while piece > 0 and breaks[piece] > time:
        piece -= 1
    return _value_and_slope(coefficients, piece, time - breaks[piece])[0]


@njit_inner
def _value_and_slope(coefficients: Array, piece: int, since: float) -> tuple[float, float]:
    """The path (rad) and its speed (rad/s), `since` (s) after the beginning of a piece."""
    value, slope = 0.0, 0.0
    for power in range(coefficients.shape[0]):
        slope = slope * since + value
        value = value * since + coefficients[power, piece]
    return value, slope
