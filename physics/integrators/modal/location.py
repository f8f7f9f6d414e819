"""Where inside a trial step of the modes a ball first contradicts the contact set."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inner
from physics.contact import Law, press, set_time
from physics.integrators.events import earliest_change, mark_suspects, quintic
from physics.integrators.modal.flow import ACCELERATION, LinearFlow, reading, relative, set_rest
from physics.track import Track

Array = NDArray[np.float64]


@njit_inner
def relative_motion(
    flow: LinearFlow, step: float, state: Array, force_x: float, force_y: float, rest: Array, ends: Array
) -> None:
    """Fill `ends` (3, 2): displacement, step · velocity and step² · acceleration of inner relative to outer ring."""
    ends[0, 0], ends[0, 1], u, v = relative(flow, state, rest)
    ends[1, 0], ends[1, 1] = step * u, step * v
    a = reading(flow, ACCELERATION, state, 0) + rest[0, ACCELERATION] + flow.jump * force_x
    b = reading(flow, ACCELERATION, state, 1) + rest[1, ACCELERATION] + flow.jump * force_y
    ends[2, 0], ends[2, 1] = step * step * a, step * step * b


@njit_inner
def locate(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    time: float,
    step: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
    after: tuple[float, float],
    rest: Array,
    halfway: bool,
    grazing: bool,
    ends: Array,
    suspects: Array,
) -> tuple[float, int, float]:
    """Share of the step, ball and its speed of compression (m/s) of the first contact change in the trial step `now` to
    `then`; ball −1 if none.

    The change was seen at the end of the step, `halfway`, or between: if `grazing`, `suspects` (G, M) says where.
    `rest` (2, 11) is of the end of the step, as is `balls`, which is left somewhere inside it.
    """
    begin, end = ends[0], ends[1]
    relative_motion(flow, step, then, after[0], after[1], rest, end)
    set_rest(flow, time, rest)
    relative_motion(flow, step, now, force[0], force[1], rest, begin)
    set_rest(flow, time + step, rest)
    if not grazing:
        suspects[:] = 0.0
    mark_suspects(balls, law, 1.0, suspects)
    if halfway:
        set_time(balls, frames, track, time + 0.5 * step)
        x, u = quintic(begin, end, 0, 0.5)
        y, v = quintic(begin, end, 1, 0.5)
        press(balls, frames, law, x, y, u / step, v / step)
        mark_suspects(balls, law, 0.5, suspects)
    return earliest_change(balls, law, track, time, step, begin, end, suspects)
