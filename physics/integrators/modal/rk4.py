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
from physics.contact import Law, Track, count_changes, move_to, note_motion, press
from physics.integrators.modal.flow import AXIS, DISPLACEMENT, VELOCITY, LinearFlow, set_rest, weigh
from physics.integrators.modal.march import bind_modal_method
from physics.integrators.modal.weights import (
    END,
    END_FIRST,
    END_LAST,
    END_MIDDLE,
    FIRST,
    HALF,
    LAST,
    MIDDLE,
    OTHER,
    TO_2,
    TO_3_FROM_1,
    TO_3_FROM_2,
    TO_4_FROM_1,
    TO_4_FROM_3,
    TURN,
    turn,
)

Array = NDArray[np.float64]


@njit_inline
def free_motion(weights: Array, first: int, start: Array, rest: Array) -> tuple[float, float, float, float]:
    """Relative displacement x, y (m) and velocity x, y (m/s) without contact force, by the shares from `first` on."""
    return (
        rest[0, DISPLACEMENT] + weigh(weights, first, start, 0),
        rest[1, DISPLACEMENT] + weigh(weights, OTHER + first, start, 1),
        rest[0, VELOCITY] + weigh(weights, first + AXIS, start, 0),
        rest[1, VELOCITY] + weigh(weights, OTHER + first + AXIS, start, 1),
    )


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
    midway: Array,
) -> tuple[int, float, float, float, float]:
    """One step of length `step` from `start` (12,), under the remaining contact force given, into `end`.

    The contact set stays frozen. Leaves `balls` and `rest` (2, 11) at the end time; writes the motion of the balls
    halfway to `midway` (G, 2, M); returns how many of them contradict the set there, and the remaining contact force
    there and at the end.
    """
    w = weights
    kx, ky = flow.stiffness
    cx, cy = flow.damping
    move_to(balls, frames, track, time + 0.5 * step)
    set_rest(flow, time + 0.5 * step, rest)
    free_x, free_y, free_u, free_v = free_motion(w, HALF, start, rest)
    x, y = free_x + w[TO_2] * force_x, free_y + w[OTHER + TO_2] * force_y
    u, v = free_u + w[TO_2 + 1] * force_x, free_v + w[OTHER + TO_2 + 1] * force_y
    fx, fy = press(balls, frames, law, x, y, u, v)
    x2, y2 = fx - kx * x - cx * u, fy - ky * y - cy * v
    x = free_x + w[TO_3_FROM_1] * force_x + w[TO_3_FROM_2] * x2
    y = free_y + w[OTHER + TO_3_FROM_1] * force_y + w[OTHER + TO_3_FROM_2] * y2
    u = free_u + w[TO_3_FROM_1 + 1] * force_x + w[TO_3_FROM_2 + 1] * x2
    v = free_v + w[OTHER + TO_3_FROM_1 + 1] * force_y + w[OTHER + TO_3_FROM_2 + 1] * y2
    fx, fy = press(balls, frames, law, x, y, u, v)
    contradicted = count_changes(balls, law)
    note_motion(balls, midway)
    x3, y3 = fx - kx * x - cx * u, fy - ky * y - cy * v

    move_to(balls, frames, track, time + step)
    set_rest(flow, time + step, rest)
    free_x, free_y, free_u, free_v = free_motion(w, END, start, rest)
    x = free_x + w[TO_4_FROM_1] * force_x + w[TO_4_FROM_3] * x3
    y = free_y + w[OTHER + TO_4_FROM_1] * force_y + w[OTHER + TO_4_FROM_3] * y3
    u = free_u + w[TO_4_FROM_1 + 1] * force_x + w[TO_4_FROM_3 + 1] * x3
    v = free_v + w[OTHER + TO_4_FROM_1 + 1] * force_y + w[OTHER + TO_4_FROM_3 + 1] * y3
    fx, fy = press(balls, frames, law, x, y, u, v)
    x4, y4 = fx - kx * x - cx * u, fy - ky * y - cy * v
    mx, my = x2 + x3, y2 + y3
    turn(w, TURN, OTHER, start, end)
    for part in range(AXIS):
        end[part] += w[FIRST + part] * force_x + w[MIDDLE + part] * mx + w[LAST + part] * x4
        place, other = AXIS + part, OTHER + part
        end[place] += w[other + FIRST] * force_y + w[other + MIDDLE] * my + w[other + LAST] * y4
    x = free_x + w[END_FIRST] * force_x + w[END_MIDDLE] * mx + w[END_LAST] * x4
    y = free_y + w[OTHER + END_FIRST] * force_y + w[OTHER + END_MIDDLE] * my + w[OTHER + END_LAST] * y4
    u = free_u + w[END_FIRST + 1] * force_x + w[END_MIDDLE + 1] * mx + w[END_LAST + 1] * x4
    v = free_v + w[OTHER + END_FIRST + 1] * force_y + w[OTHER + END_MIDDLE + 1] * my + w[OTHER + END_LAST + 1] * y4
    fx, fy = press(balls, frames, law, x, y, u, v)
    return contradicted, x3, y3, fx - kx * x - cx * u, fy - ky * y - cy * v


march_modal_rk4 = bind_modal_method("modal_rk4", step_modal_rk4)
