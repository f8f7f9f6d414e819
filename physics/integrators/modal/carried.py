"""A step that is carried by the one before: exponential predictor and corrector of order 5 with two contact sums.

The force that the step before met at its beginning and in its middle foretells, with the force at the start, that in
the middle; these four foretell the end; and the polynomial through all five moves the modes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline
from physics.contact import Law, Track, count_changes, move_to, press
from physics.integrators.modal.flow import LinearFlow, set_rest
from physics.integrators.modal.weights import (
    AT_END,
    AT_HALF,
    END,
    HALF,
    KICKS,
    OTHER,
    TURN,
    free_motion,
    push,
    turn,
)

Array = NDArray[np.float64]


@njit_inline
def foretell(past: Array, ratio: float, force: float, axis: int, course: Array) -> None:
    """Fill `course` (2, 5) with the parabola through the `force` at the start and the two of the step before."""
    first, middle = past[0, axis], past[1, axis]
    late = (force - middle) * (2.0 / ratio)
    bend = (late - (middle - first) * (2.0 / ratio)) / ratio
    course[axis, 0], course[axis, 1], course[axis, 2] = force, late + 0.5 * ratio * bend, bend
    course[axis, 3], course[axis, 4] = 0.0, 0.0


@njit_inline
def through_middle(ratio: float, middle: float, axis: int, course: Array) -> None:
    """Let the `course` meet the force `middle` at half the step."""
    told = course[axis, 0] + 0.5 * course[axis, 1] + 0.25 * course[axis, 2]
    bend = (middle - told) * 2.0 / ((0.5 + 0.5 * ratio) * (0.5 + ratio))
    course[axis, 1] += 0.5 * ratio * ratio * bend
    course[axis, 2] += 1.5 * ratio * bend
    course[axis, 3] = bend


@njit_inline
def through_end(ratio: float, last: float, axis: int, course: Array) -> None:
    """Let the `course` meet the force `last` at the end of the step."""
    told = course[axis, 0] + course[axis, 1] + course[axis, 2] + course[axis, 3]
    bend = (last - told) * 2.0 / ((1.0 + 0.5 * ratio) * (1.0 + ratio))
    course[axis, 1] -= 0.25 * ratio * ratio * bend
    course[axis, 2] += (0.5 * ratio - 0.75) * ratio * bend
    course[axis, 3] += (1.5 * ratio - 0.5) * bend
    course[axis, 4] = bend


@njit_inline
def step_carried(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    weights: Array,
    time: float,
    step: float,
    start: Array,
    force_x: float,
    force_y: float,
    end: Array,
    rest: Array,
    past: Array,
    ratio: float,
    course: Array,
) -> tuple[int, float, float, float, float]:
    """As `step_modal_rk4`, with the forces `past` (2, 2) of a step before that was `ratio` times as long."""
    w = weights
    kx, ky = flow.stiffness
    cx, cy = flow.damping
    foretell(past, ratio, force_x, 0, course)
    foretell(past, ratio, force_y, 1, course)
    move_to(balls, frames, track, time + 0.5 * step)
    set_rest(flow, time + 0.5 * step, rest)
    x, y, u, v = free_motion(w, HALF, start, rest)
    for power in range(3):
        place, other = AT_HALF + 2 * power, OTHER + AT_HALF + 2 * power
        x += w[place] * course[0, power]
        u += w[place + 1] * course[0, power]
        y += w[other] * course[1, power]
        v += w[other + 1] * course[1, power]
    fx, fy = press(balls, frames, law, x, y, u, v)
    contradicted = count_changes(balls, law)
    mx, my = fx - kx * x - cx * u, fy - ky * y - cy * v
    through_middle(ratio, mx, 0, course)
    through_middle(ratio, my, 1, course)

    move_to(balls, frames, track, time + step)
    set_rest(flow, time + step, rest)
    turn(w, TURN, OTHER, start, end)
    x, y, u, v = free_motion(w, END, start, rest)
    for power in range(4):
        place, other = AT_END + 2 * power, OTHER + AT_END + 2 * power
        x += w[place] * course[0, power]
        u += w[place + 1] * course[0, power]
        y += w[other] * course[1, power]
        v += w[other + 1] * course[1, power]
    fx, fy = press(balls, frames, law, x, y, u, v)
    lx, ly = fx - kx * x - cx * u, fy - ky * y - cy * v
    through_end(ratio, lx, 0, course)
    through_end(ratio, ly, 1, course)
    push(w, KICKS, OTHER, course, end)
    return contradicted, mx, my, lx, ly
