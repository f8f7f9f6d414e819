"""Exponential Runge-Kutta of order 4 (Krogstad 2005, ETDRK4-B) on the modes: four contact sums a step.

The modes turn exactly under the stages' contact forces; what is integrated numerically is only what the contact force
differs from its mean spring and damper, so neither the fast resonator nor the contact modes limit the step, only how
fast that difference changes. Order 4 while the contact set does not change, which the march ensures by stopping at
every change. Not to be confused with Cox and Matthews' ETDRK4, whose stages lose order when the linear part is stiff,
nor with Lawson's integrating-factor RK4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline
from physics.contact import Law, Track, count_changes, move_to, press
from physics.integrators.modal.flow import LinearFlow, relative, set_rest
from physics.integrators.modal.march import bind_modal_method
from physics.integrators.modal.weights import (
    FIRST,
    HALF,
    LAST,
    MIDDLE,
    TO_2,
    TO_3_FROM_1,
    TO_3_FROM_2,
    TO_4_FROM_1,
    TO_4_FROM_3,
    WHOLE,
)

Array = NDArray[np.float64]


@njit_inline
def turn(weights: Array, row: int, start: Array, end: Array) -> None:
    """Put into `end` (2, 2, M) the amplitudes `start` after the free turn whose exponentials begin at `row`."""
    for axis in range(2):
        for mode in range(start.shape[2]):
            er, ei = weights[row, axis, mode], weights[row + 1, axis, mode]
            end[0, axis, mode] = er * start[0, axis, mode] - ei * start[1, axis, mode]
            end[1, axis, mode] = er * start[1, axis, mode] + ei * start[0, axis, mode]


@njit_inline
def step_modal_rk4(
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
) -> tuple[int, float, float]:
    """One step of length `step` from `start` (2, 2, M), under the remaining contact force given, into `end`.

    The contact set stays frozen. Leaves `balls` and `rest` (2, 11) at the end time; returns how many balls contradict
    the set halfway, and the remaining contact force there.
    """
    w = weights
    kx, ky = flow.stiffness
    cx, cy = flow.damping
    turn(w, HALF, start, end)
    move_to(balls, frames, track, time + 0.5 * step)
    set_rest(flow, time + 0.5 * step, rest)
    free_x, free_y, free_u, free_v = relative(flow.rows, end, rest)
    x, y = free_x + w[TO_2, 0, 0] * force_x, free_y + w[TO_2, 1, 0] * force_y
    u, v = free_u + w[TO_2 + 1, 0, 0] * force_x, free_v + w[TO_2 + 1, 1, 0] * force_y
    fx, fy = press(balls, frames, law, x, y, u, v)
    x2, y2 = fx - kx * x - cx * u, fy - ky * y - cy * v
    x = free_x + w[TO_3_FROM_1, 0, 0] * force_x + w[TO_3_FROM_2, 0, 0] * x2
    y = free_y + w[TO_3_FROM_1, 1, 0] * force_y + w[TO_3_FROM_2, 1, 0] * y2
    u = free_u + w[TO_3_FROM_1 + 1, 0, 0] * force_x + w[TO_3_FROM_2 + 1, 0, 0] * x2
    v = free_v + w[TO_3_FROM_1 + 1, 1, 0] * force_y + w[TO_3_FROM_2 + 1, 1, 0] * y2
    fx, fy = press(balls, frames, law, x, y, u, v)
    contradicted = count_changes(balls, law)
    x3, y3 = fx - kx * x - cx * u, fy - ky * y - cy * v

    turn(w, WHOLE, start, end)
    move_to(balls, frames, track, time + step)
    set_rest(flow, time + step, rest)
    x, y, u, v = relative(flow.rows, end, rest)
    x += w[TO_4_FROM_1, 0, 0] * force_x + w[TO_4_FROM_3, 0, 0] * x3
    y += w[TO_4_FROM_1, 1, 0] * force_y + w[TO_4_FROM_3, 1, 0] * y3
    u += w[TO_4_FROM_1 + 1, 0, 0] * force_x + w[TO_4_FROM_3 + 1, 0, 0] * x3
    v += w[TO_4_FROM_1 + 1, 1, 0] * force_y + w[TO_4_FROM_3 + 1, 1, 0] * y3
    fx, fy = press(balls, frames, law, x, y, u, v)
    x4, y4 = fx - kx * x - cx * u, fy - ky * y - cy * v
    for mode in range(start.shape[2]):
        for part in range(2):
            end[part, 0, mode] += (
                w[FIRST + part, 0, mode] * force_x
                + w[MIDDLE + part, 0, mode] * (x2 + x3)
                + w[LAST + part, 0, mode] * x4
            )
            end[part, 1, mode] += (
                w[FIRST + part, 1, mode] * force_y
                + w[MIDDLE + part, 1, mode] * (y2 + y3)
                + w[LAST + part, 1, mode] * y4
            )
    return contradicted, x3, y3


march_modal_rk4 = bind_modal_method("modal_rk4", step_modal_rk4)
