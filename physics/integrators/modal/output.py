"""What a march on the modes writes: samples at the ends of steps, samples inside strides, and what else is wanted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_inner, njit_pasted
from physics.contact import ACTIVE, FORCE, Law, of_ball, press, set_time
from physics.integrators.modal.flow import (
    OUTER,
    OUTER_ACCELERATION,
    OUTER_SPEED,
    OUTPUT,
    LinearFlow,
    physical_state,
    reading,
    relative,
    set_rest,
    weigh,
)
from physics.integrators.modal.weights import (
    INSIDE_KICKS,
    INSIDE_OTHER,
    INSIDE_POWERS,
    INSIDE_READ,
    INSIDE_TURN,
    POWERS,
    push,
    turn,
)
from physics.integrators.output import HELD, HELD_BEFORE, PULLED, PULLED_BEFORE, Output
from physics.track import Track

Array = NDArray[np.float64]


@njit_inner
def remaining_force(
    balls: Array, frames: Array, law: Law, flow: LinearFlow, state: Array, rest: Array
) -> tuple[float, float]:
    """Contact force (N) of `state` (12,) less what the modes' spring and damper take of it."""
    x, y, u, v = relative(flow, state, rest)
    fx, fy = press(balls, frames, law, x, y, u, v)
    return fx - flow.stiffness[0] * x - flow.damping[0] * u, fy - flow.stiffness[1] * y - flow.damping[1] * v


@njit_inner
def keep(
    balls: Array,
    flow: LinearFlow,
    state: Array,
    rest: Array,
    force: tuple[float, float],
    time: float,
    sample: int,
    output: Output,
) -> None:
    """Write what else is wanted of one sample: the outer ring's motion, the state, the balls' forces."""
    if output.outer.shape[0] > 0:
        for axis in range(2):
            output.outer[sample, axis] = reading(flow, OUTER, state, axis) + rest[axis, OUTER]
            output.outer[sample, 2 + axis] = reading(flow, OUTER_SPEED, state, axis) + rest[axis, OUTER_SPEED]
            rate = reading(flow, OUTER_ACCELERATION, state, axis) + force[axis] / flow.outer_mass
            output.outer[sample, 4 + axis] = rate + rest[axis, OUTER_ACCELERATION]
    if output.state.shape[0] > 0:
        physical_state(flow, time, state, output.state[sample])
    if output.force.shape[0] > 0:
        for ball in range(output.force.shape[1]):
            output.force[sample, ball] = of_ball(balls, FORCE, ball)


@njit_inline
def force_on(course: Array, axis: int, share: float) -> float:
    """Contact force (N) at a share of the step."""
    force = course[axis, POWERS - 1]
    for power in range(POWERS - 2, -1, -1):
        force = force * share + course[axis, power]
    return force


@njit_inner
def keep_inside(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    inside: Array,
    first: int,
    count: int,
    state: Array,
    between: Array,
    rest: Array,
    course: Array,
    start: float,
    interval: float,
    sample: int,
    output: Output,
) -> None:
    """Write what else is wanted of the samples inside a stride that begins at `sample` and `start` (s) in `state`.

    `between` is scratch; leaves the time of `balls` and `rest` at the end of the stride.
    """
    for k in range(count - 1):
        w, share, time = inside[first + k], (k + 1.0) / count, start + (k + 1) * interval
        force = force_on(course, 0, share), force_on(course, 1, share)
        turn(w, INSIDE_TURN, INSIDE_OTHER, state, between)
        push(w, INSIDE_KICKS, INSIDE_OTHER, course, between)
        set_rest(flow, time, rest)
        if output.force.shape[0] > 0:
            set_time(balls, frames, track, time)
            remaining_force(balls, frames, law, flow, between, rest)
        keep(balls, flow, between, rest, force, time, sample + 1 + k, output)
    set_rest(flow, start + count * interval, rest)
    set_time(balls, frames, track, start + count * interval)


@njit_inline
def record(
    balls: Array, flow: LinearFlow, state: Array, rest: Array, sample: int, weight: int, output: Output
) -> float:
    """Write one sample, the last of `weight` of a step; the square of the resonator's acceleration, m²/s⁴.

    Balls in contact, and those that pull, are counted twice each; inside a stride they are taken for the mean of its
    ends.
    """
    x = reading(flow, OUTPUT, state, 0) + rest[0, OUTPUT]
    y = reading(flow, OUTPUT, state, 1) + rest[1, OUTPUT]
    output.acceleration[sample, 0] = x
    output.acceleration[sample, 1] = y
    held, pulled = 0, 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            held += balls[cage, ACTIVE, j] > 0.5
            pulled += balls[cage, FORCE, j] < 0.0
    output.tally[HELD] += 2 * held + (weight - 1) * (held + output.tally[HELD_BEFORE])
    output.tally[PULLED] += 2 * pulled + (weight - 1) * (pulled + output.tally[PULLED_BEFORE])
    output.tally[HELD_BEFORE], output.tally[PULLED_BEFORE] = held, pulled
    return x * x + y * y


@njit_pasted
def write_inside(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    inside: Array,
    first: int,
    count: int,
    state: Array,
    between: Array,
    end: Array,
    before: tuple[float, float],
    rest: Array,
    course: Array,
    start: float,
    interval: float,
    sample: int,
    output: Output,
) -> None:
    """Write the `count` − 1 samples inside the stride that starts at `sample` in `state` and ends in `end` (12,).

    `before` (x, y) is the resonator acceleration of the loads alone at its beginning, `rest` (2, 11) of its end. The
    contact force runs through the step as `course` (2, 5) says.
    """
    for k in range(count - 1):
        w = inside[first + k]
        share = (k + 1.0) / count
        x = before[0] + share * (rest[0, OUTPUT] - before[0])
        y = before[1] + share * (rest[1, OUTPUT] - before[1])
        for power in range(POWERS):
            x += w[INSIDE_POWERS + power] * course[0, power]
            y += w[INSIDE_OTHER + INSIDE_POWERS + power] * course[1, power]
        output.acceleration[sample + 1 + k, 0] = x + weigh(w, INSIDE_READ, state, 0)
        output.acceleration[sample + 1 + k, 1] = y + weigh(w, INSIDE_OTHER + INSIDE_READ, state, 1)
    if output.outer.shape[0] + output.state.shape[0] + output.force.shape[0] > 0:
        keep_inside(
            balls, frames, law, track, flow, inside, first, count, state, between, rest, course, start, interval,
            sample, output,
        )  # fmt: skip
        remaining_force(balls, frames, law, flow, end, rest)
