"""What a march on the modes writes: samples at the ends of steps, samples inside strides, and what else is wanted."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_lean
from physics.contact import ACTIVE, FORCE, Law, Track, of_ball, press, set_time
from physics.integrators.march import HELD, HELD_BEFORE, PULLED, PULLED_BEFORE, Output
from physics.integrators.modal.flow import (
    OUTER,
    OUTER_ACCELERATION,
    OUTER_SPEED,
    OUTPUT,
    REST_OUTER,
    REST_OUTER_ACCELERATION,
    REST_OUTPUT,
    LinearFlow,
    physical_state,
    reading,
    relative,
    set_rest,
)
from physics.integrators.modal.weights import (
    INSIDE_FIRST,
    INSIDE_KICKS,
    INSIDE_LAST,
    INSIDE_MIDDLE,
    INSIDE_MODES,
    INSIDE_TURN,
)

Array = NDArray[np.float64]


@njit_inline
def remaining_force(
    balls: Array, frames: Array, law: Law, flow: LinearFlow, state: Array, rest: Array
) -> tuple[float, float]:
    """Contact force (N) of `state` (2, 2, M) less what the modes' spring and damper take of it."""
    x, y, u, v = relative(flow.rows, state, rest)
    fx, fy = press(balls, frames, law, x, y, u, v)
    return fx - flow.stiffness[0] * x - flow.damping[0] * u, fy - flow.stiffness[1] * y - flow.damping[1] * v


@njit_lean
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
            output.outer[sample, axis] = reading(flow.rows, OUTER, state, axis) + rest[axis, REST_OUTER]
            speed = reading(flow.rows, OUTER_SPEED, state, axis) + rest[axis, REST_OUTER + 1]
            output.outer[sample, 2 + axis] = speed
            rate = reading(flow.rows, OUTER_ACCELERATION, state, axis) + force[axis] / flow.outer_mass
            output.outer[sample, 4 + axis] = rate + rest[axis, REST_OUTER_ACCELERATION]
    if output.state.shape[0] > 0:
        physical_state(flow, time, state, output.state[sample])
    if output.force.shape[0] > 0:
        for ball in range(output.force.shape[1]):
            output.force[sample, ball] = of_ball(balls, FORCE, ball)


@njit_lean
def keep_inside(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    inside: Array,
    count: int,
    state: Array,
    between: Array,
    rest: Array,
    first: tuple[float, float],
    middle: tuple[float, float],
    last: tuple[float, float],
    start: float,
    interval: float,
    sample: int,
    output: Output,
) -> None:
    """Write what else is wanted of the samples inside a stride that begins at `sample` and `start` (s) in `state`.

    `between` is scratch; leaves the time of `balls` and `rest` at the end of the stride.
    """
    for k in range(count - 1):
        w, share, time = inside[count + k], (k + 1.0) / count, start + (k + 1) * interval
        a, b, c = 1.0 - 3.0 * share + 2.0 * share**2, 4.0 * (share - share**2), 2.0 * share**2 - share
        force = a * first[0] + b * middle[0] + c * last[0], a * first[1] + b * middle[1] + c * last[1]
        for axis in range(2):
            for mode in range(state.shape[2]):
                er, ei = w[INSIDE_TURN, axis, mode], w[INSIDE_TURN + 1, axis, mode]
                real, imaginary = state[0, axis, mode], state[1, axis, mode]
                between[0, axis, mode], between[1, axis, mode] = er * real - ei * imaginary, er * imaginary + ei * real
                for part in range(2):
                    between[part, axis, mode] += (
                        w[INSIDE_KICKS + part, axis, mode] * first[axis]
                        + w[INSIDE_KICKS + 2 + part, axis, mode] * middle[axis]
                        + w[INSIDE_KICKS + 4 + part, axis, mode] * last[axis]
                    )
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
    x = reading(flow.rows, OUTPUT, state, 0) + rest[0, REST_OUTPUT]
    y = reading(flow.rows, OUTPUT, state, 1) + rest[1, REST_OUTPUT]
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


@njit_inline
def write_inside(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    inside: Array,
    count: int,
    state: Array,
    between: Array,
    end: Array,
    before: tuple[float, float],
    rest: Array,
    first: tuple[float, float],
    middle: tuple[float, float],
    last: tuple[float, float],
    start: float,
    interval: float,
    sample: int,
    output: Output,
) -> None:
    """Write the `count` − 1 samples inside the stride that starts at `sample` in `state` and ends in `end` (2, 2, M).

    `before` (x, y) is the resonator acceleration of the loads alone at its beginning, `rest` (2, 11) of its end. The
    contact force is given at the beginning, in the middle and at the end.
    """
    for k in range(count - 1):
        w = inside[count + k]
        share = (k + 1.0) / count
        x = before[0] + share * (rest[0, REST_OUTPUT] - before[0])
        y = before[1] + share * (rest[1, REST_OUTPUT] - before[1])
        x += w[INSIDE_FIRST, 0, 0] * first[0] + w[INSIDE_MIDDLE, 0, 0] * middle[0] + w[INSIDE_LAST, 0, 0] * last[0]
        y += w[INSIDE_FIRST, 1, 0] * first[1] + w[INSIDE_MIDDLE, 1, 0] * middle[1] + w[INSIDE_LAST, 1, 0] * last[1]
        output.acceleration[sample + 1 + k, 0] = x + reading(w, INSIDE_MODES, state, 0)
        output.acceleration[sample + 1 + k, 1] = y + reading(w, INSIDE_MODES, state, 1)
    if output.outer.shape[0] + output.state.shape[0] + output.force.shape[0] > 0:
        keep_inside(
            balls, frames, law, track, flow, inside, count, state, between, rest, first, middle, last, start, interval,
            sample, output,
        )  # fmt: skip
        remaining_force(balls, frames, law, flow, end, rest)
