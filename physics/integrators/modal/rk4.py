"""A step that knows no step before it: exponential Runge-Kutta of order 4 (Krogstad 2005, ETDRK4-B), four contact sums.

The first step after a change of contact or a kink is one; those that follow are carried (modal/carried.py).
The modes turn exactly under the stages' contact forces; what is integrated numerically is only what the contact force
differs from its mean spring and damper, so neither the fast resonator nor the contact modes limit the step, only how
fast that difference changes. Order 4 while the contact set does not change, which the march ensures by stopping at
every change. Not to be confused with Cox and Matthews' ETDRK4, whose stages lose order when the linear part is stiff,
nor with Lawson's integrating-factor RK4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inner, njit_pasted
from physics.contact import Law, press, set_time
from physics.contact_set import count_changes, note_motion
from physics.integrators.modal.flow import LinearFlow, set_rest
from physics.integrators.modal.weights import AT_END, AT_HALF, END, HALF, KICKS, OTHER, TURN, free_motion, push, turn
from physics.track import Track

Array = NDArray[np.float64]


@njit_inner
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
    course: Array,
) -> tuple[int, float, float, float, float]:
    """One step of length `step` from `start` (12,), under the remaining contact force given, into `end`.

    The contact set stays frozen. Leaves `balls` and `rest` (2, 11) at the end time; writes the motion of the balls
    halfway to `midway` (G, 2, M) and the contact force of the step to `course` (2, 5); returns how many balls
    contradict the set halfway, and the remaining contact force there and at the end.
    """
    w = weights
    kx, ky = flow.stiffness
    cx, cy = flow.damping
    set_time(balls, frames, track, time + 0.5 * step)
    set_rest(flow, time + 0.5 * step, rest)
    free_x, free_y, free_u, free_v = free_motion(w, HALF, start, rest)
    x, y = free_x + w[AT_HALF] * force_x, free_y + w[OTHER + AT_HALF] * force_y
    u, v = free_u + w[AT_HALF + 1] * force_x, free_v + w[OTHER + AT_HALF + 1] * force_y
    fx, fy = press(balls, frames, law, x, y, u, v)
    x2, y2 = fx - kx * x - cx * u, fy - ky * y - cy * v
    rise_x, rise_y = 2.0 * (x2 - force_x), 2.0 * (y2 - force_y)
    x += w[AT_HALF + 2] * rise_x
    y += w[OTHER + AT_HALF + 2] * rise_y
    u += w[AT_HALF + 3] * rise_x
    v += w[OTHER + AT_HALF + 3] * rise_y
    fx, fy = press(balls, frames, law, x, y, u, v)
    contradicted = count_changes(balls, law)
    note_motion(balls, midway)
    x3, y3 = fx - kx * x - cx * u, fy - ky * y - cy * v

    set_time(balls, frames, track, time + step)
    set_rest(flow, time + step, rest)
    free_x, free_y, free_u, free_v = free_motion(w, END, start, rest)
    rise_x, rise_y = 2.0 * (x3 - force_x), 2.0 * (y3 - force_y)
    x = free_x + w[AT_END] * force_x + w[AT_END + 2] * rise_x
    y = free_y + w[OTHER + AT_END] * force_y + w[OTHER + AT_END + 2] * rise_y
    u = free_u + w[AT_END + 1] * force_x + w[AT_END + 3] * rise_x
    v = free_v + w[OTHER + AT_END + 1] * force_y + w[OTHER + AT_END + 3] * rise_y
    fx, fy = press(balls, frames, law, x, y, u, v)
    x4, y4 = fx - kx * x - cx * u, fy - ky * y - cy * v
    set_parabola(force_x, x2 + x3, x4, course[0])
    set_parabola(force_y, y2 + y3, y4, course[1])
    turn(w, TURN, OTHER, start, end)
    push(w, KICKS, OTHER, course, end)
    x, y, u, v = free_x, free_y, free_u, free_v
    for power in range(3):
        place, other = AT_END + 2 * power, OTHER + AT_END + 2 * power
        x += w[place] * course[0, power]
        u += w[place + 1] * course[0, power]
        y += w[other] * course[1, power]
        v += w[other + 1] * course[1, power]
    fx, fy = press(balls, frames, law, x, y, u, v)
    return contradicted, x3, y3, fx - kx * x - cx * u, fy - ky * y - cy * v


@njit_pasted
def set_parabola(first: float, twice_middle: float, last: float, course: Array) -> None:
    """Fill `course` (5,) with the parabola through forces (N) at the beginning, in the middle and at the end."""
    course[0], course[1] = first, 2.0 * twice_middle - 3.0 * first - last
    course[2] = 2.0 * (first - twice_middle + last)
    course[3], course[4] = 0.0, 0.0
