"""Balls that keep contact over a spall: when their quasi-static load falls through half its due value, and rises."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array
from physics.scene import Scene
from physics.statics.ball_load import ball_load

SAMPLES_PER_PASS = 400
SHARE = 0.5
# The first and the last instant lie outside the edges by this share of a pass: on a wall, rounding would decide.
BESIDE = 1e-9


def load_dips(scene: Scene, row: int, ball: NDArray[np.integer], entry: Array, leave: Array) -> tuple[Array, Array]:
    """First fall and last rise (N,), s, of a ball's quasi-static load through half of what it would carry without
    spalls.

    `ball` (N,) is the number, from 1, of the ball of `row` in each of N passes, which last from `entry` to `leave`
    (N,), s. NaN where the load does not both fall and rise between the edges. That of a ball which comes into the load
    zone, or goes out of it, inside the spall neither falls nor rises there.
    Both loads are solved at 400 equal steps of each pass, so times are exact to about a thousandth of it, and to half a
    step at a wall; over a rough floor a dip shorter than a step may be missed, and the times then are those of a dip
    beside it.
    """
    fall, rise = np.full(entry.size, np.nan), np.full(entry.size, np.nan)
    if entry.size == 0:
        return fall, rise
    time = entry[:, None] + (leave - entry)[:, None] * np.linspace(-BESIDE, 1.0 + BESIDE, 1 + SAMPLES_PER_PASS)
    pressed = _loads(scene, time, row, ball)
    due = _loads(replace(scene, spalls=()), time, row, ball)
    for k in range(entry.size):
        fall[k], rise[k] = first_and_last_crossing(time[k], pressed[k] - SHARE * due[k])
    return fall, rise


def _loads(scene: Scene, time: Array, row: int, ball: NDArray[np.integer]) -> Array:
    """Quasi-static load (N, S) of `ball` (N,) at its own instants (N, S), N."""
    order = np.argsort(time, axis=None, kind="stable")
    load = np.empty(time.size)
    load[order] = ball_load(scene, time.ravel()[order], row, np.repeat(ball, time.shape[1])[order])
    return load.reshape(time.shape)


def first_and_last_crossing(time: Array, excess: Array) -> tuple[float, float]:
    """Times of the first change of `excess` (S,) from above to below zero and of the last one back; NaN if none.

    Interpolated linearly between the instants `time` (S,), s. Zero, where a ball neither carries load nor should, is
    neither above nor below.
    """
    above, below = excess > 0.0, excess < 0.0
    falls = np.flatnonzero(above[:-1] & below[1:])
    rises = np.flatnonzero(below[:-1] & above[1:])
    if falls.size == 0 or rises.size == 0 or rises[-1] < falls[0]:
        return np.nan, np.nan
    return _crossing(time, excess, int(falls[0])), _crossing(time, excess, int(rises[-1]))


def _crossing(time: Array, excess: Array, left: int) -> float:
    share = excess[left] / (excess[left] - excess[left + 1])
    return float(time[left] + share * (time[left + 1] - time[left]))
