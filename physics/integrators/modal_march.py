"""Marching on the modes with steps as long as the scene allows, every contact change located and every kink a stop.

Steps are whole numbers of units, a sixteenth of a sample, or two, four, eight samples; the samples inside such a stride
are exact responses of the modes to the contact force of the step's stages. Everything is measured by one tolerance, the
momentum (N s) by which a step or a contact change may be wrong: the length of steps from how well the past of the
contact force foretells it, how exactly a change is located from the jump of force it makes, how finely steps are graded
next to it from how fast contact begins or ends.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_lean, specialise
from physics.contact import (
    ACTIVE,
    FORCE,
    Law,
    Track,
    count_ahead,
    count_changes,
    of_ball,
    press,
    reset_contact,
    set_time,
    touches,
)
from physics.integrators.events import earliest_change, mark_suspects, quintic
from physics.integrators.flow import (
    ACCELERATION,
    OUTER,
    OUTER_ACCELERATION,
    OUTER_SPEED,
    OUTPUT,
    REST_OUTER,
    REST_OUTPUT,
    LinearFlow,
    physical_state,
    reading,
    relative,
    set_rest,
)
from physics.integrators.march import (
    DONE,
    HELD,
    KINK_NUDGE_SHARE,
    LARGEST_ACCELERATION,
    LOG_FULL,
    LOGGED,
    MOST_CHANGES_PER_STEP,
    NOT_FINITE,
    PULLED,
    SMALLEST_STEP_SHARE,
    STEPS,
    UNLOCATED,
    Output,
    Stops,
    toggle,
)
from physics.integrators.modal_weights import (
    INSIDE_FIRST,
    INSIDE_KICKS,
    INSIDE_LAST,
    INSIDE_MIDDLE,
    INSIDE_MODES,
    INSIDE_ROWS,
    INSIDE_TURN,
    WEIGHT_ROWS,
    set_inside,
    set_step,
)

Array = NDArray[np.float64]

UNITS = 16
ODD = -1
# A stride is taken only if no ball would change sides within this many times its length.
LOOK_AHEAD = 1.0
# Error of Simpson's rule, in which the method's quadrature consists, over one step: its length to the fifth times the
# fourth derivative over 2880; and, relative, for the force (t − t0)^1.5 with which contact starts and ends.
SIMPSON_ERROR = 1.0 / 2880.0
START_ERROR = 0.0024
# Locating a change to the nearest unit is wrong by this share of the unit (root mean square).
UNIT_ERROR = 0.29
# A step is taken back if its error exceeds the tolerance this many times, and the next is doubled if it stays below
# this share of it: the error grows by the fifth power of the length.
REJECTED, DOUBLED = 4.0, 1.0 / 32.0


class Workspace(NamedTuple):
    """Memory of a march: two states (2, 2, 2, M) and one in between (2, 2, M), weights of every step length and of the
    samples inside strides, φ-functions, what the loads alone do, and scratch."""

    states: Array
    between: Array
    weights: Array
    inside: Array
    phi: Array
    rest: Array
    ends: Array
    suspects: Array
    past: Array
    foretelling: Array


class Stride(NamedTuple):
    """`samples` instants, `interval` (s) apart; steps of at most 2^`levels` samples.

    One step may be wrong by the momentum (N s) `share` times the root mean square of the resonator's acceleration
    (m/s²) seen so far, or by `least` if that is more. `seen` (m²/s⁴) is what to take for the mean square at the start,
    with the weight of `seen_samples`.
    """

    samples: int
    interval: float
    levels: int
    share: float
    least: float
    seen: float
    seen_samples: float


@njit_lean
def relative_motion(
    flow: LinearFlow, step: float, state: Array, force_x: float, force_y: float, rest: Array, ends: Array
) -> None:
    """Fill `ends` (3, 2): displacement, step · velocity and step² · acceleration of inner relative to outer ring."""
    ends[0, 0], ends[0, 1], u, v = relative(flow.rows, state, rest)
    ends[1, 0], ends[1, 1] = step * u, step * v
    a = reading(flow.rows, ACCELERATION, state, 0) + rest[0, 2] + flow.jump * force_x
    b = reading(flow.rows, ACCELERATION, state, 1) + rest[1, 2] + flow.jump * force_y
    ends[2, 0], ends[2, 1] = step * step * a, step * step * b


@njit_lean
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
    ends: Array,
    suspects: Array,
) -> tuple[float, int, float]:
    """Share of the step, ball and its speed of compression (m/s) of the first contact change in the trial step `now` to
    `then`; ball −1 if none.

    `rest` (2, 10) is of the end of the step; leaves `balls` somewhere inside it.
    """
    begin, end = ends[0], ends[1]
    for ball in range(suspects.size):
        suspects[ball] = 0.0
    relative_motion(flow, step, then, after[0], after[1], rest, end)
    set_rest(flow, time, rest)
    relative_motion(flow, step, now, force[0], force[1], rest, begin)
    set_rest(flow, time + step, rest)
    mark_suspects(balls, law, 1.0, suspects)
    if halfway:
        set_time(balls, frames, track, time + 0.5 * step)
        x, u = quintic(begin, end, 0, 0.5)
        y, v = quintic(begin, end, 1, 0.5)
        press(balls, frames, law, x, y, u / step, v / step)
        for ball in range(suspects.size):
            if touches(balls, law, ball) != (of_ball(balls, ACTIVE, ball) > 0.5):
                suspects[ball] = 0.5
    return earliest_change(balls, law, track, time, step, begin, end, suspects)


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
            output.outer[sample, 4 + axis] = rate
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

    `inside` (S − 1, 13, 2, M) are their weights, `between` is scratch; leaves `balls` and `rest` at the last of them.
    """
    count = inside.shape[0] + 1
    for k in range(count - 1):
        w, share, time = inside[k], (k + 1.0) / count, start + (k + 1) * interval
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


@njit_inline
def record(
    balls: Array, flow: LinearFlow, state: Array, rest: Array, sample: int, weight: int, output: Output
) -> float:
    """Write one sample that stands for `weight` of them; the square of the resonator's acceleration, m²/s⁴."""
    x = reading(flow.rows, OUTPUT, state, 0) + rest[0, REST_OUTPUT]
    y = reading(flow.rows, OUTPUT, state, 1) + rest[1, REST_OUTPUT]
    output.acceleration[sample, 0] = x
    output.acceleration[sample, 1] = y
    held, pulled = 0, 0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            held += balls[cage, ACTIVE, j] > 0.5
            pulled += balls[cage, FORCE, j] < 0.0
    output.tally[HELD] += weight * held
    output.tally[PULLED] += weight * pulled
    return x * x + y * y


@njit_inline
def record_inside(
    inside: Array,
    first_row: int,
    count: int,
    state: Array,
    before: tuple[float, float],
    rest: Array,
    first: tuple[float, float],
    middle: tuple[float, float],
    last: tuple[float, float],
    sample: int,
    acceleration: Array,
) -> None:
    """Write the `count` − 1 samples inside the stride that starts at `sample` in `state` (2, 2, M).

    `before` (x, y) is the resonator acceleration of the loads alone at its beginning, `rest` (2, 10) of its end.
    """
    for k in range(count - 1):
        w = inside[first_row + k]
        share = (k + 1.0) / count
        x = before[0] + share * (rest[0, REST_OUTPUT] - before[0])
        y = before[1] + share * (rest[1, REST_OUTPUT] - before[1])
        x += w[INSIDE_FIRST, 0, 0] * first[0] + w[INSIDE_MIDDLE, 0, 0] * middle[0] + w[INSIDE_LAST, 0, 0] * last[0]
        y += w[INSIDE_FIRST, 1, 0] * first[1] + w[INSIDE_MIDDLE, 1, 0] * middle[1] + w[INSIDE_LAST, 1, 0] * last[1]
        acceleration[sample + 1 + k, 0] = x + reading(w, INSIDE_MODES, state, 0)
        acceleration[sample + 1 + k, 1] = y + reading(w, INSIDE_MODES, state, 1)


@njit_inline
def active_kink(balls: Array, stops: Stops, place: int, finish: float) -> float:
    """Time (s) of the first kink from `place` on that a ball in contact crosses before `finish`, or `finish`."""
    while place < stops.time.size and stops.time[place] < finish:
        if of_ball(balls, ACTIVE, stops.ball[place]) > 0.5:
            return stops.time[place]
        place += 1
    return finish


@njit_inline
def graded_length(law: Law, speed: float, tolerance: float) -> float:
    """Longest step (s) next to an instant at which a ball starts or ceases to touch at `speed` (m/s)."""
    return (tolerance / (START_ERROR * law.stiffness * max(abs(speed), 1e-12) ** 1.5)) ** 0.4


@njit_inline
def set_foretelling(ratio: float, foretelling: Array) -> None:
    """Fill `foretelling` (5,): weights of the cubic's value in the middle of a step, and what turns a deviation from it
    into the error of the step over its length.

    The cubic runs through the force at the beginning and in the middle of the step before, `ratio` times as long, and
    at both ends of the step.
    """
    a, b = ratio, 0.5 * ratio
    foretelling[0] = 0.25 * (0.5 + b) / ((a - b) * a * (a + 1.0))
    foretelling[1] = -0.25 * (0.5 + a) / ((a - b) * b * (b + 1.0))
    foretelling[2] = 0.5 * (0.5 + a) * (0.5 + b) / (a * b)
    foretelling[3] = 0.5 * (0.5 + a) * (0.5 + b) / ((1.0 + a) * (1.0 + b))
    foretelling[4] = 96.0 * SIMPSON_ERROR / ((0.5 + a) * (0.5 + b))


def _unbound(*_arguments: object) -> Any:
    raise RuntimeError("a march needs the step of a method: use bind_modal_method")


# Bound by `bind_modal_method`: the step of the method, pasted into the march.
step_pasted: Callable[..., tuple[int, float, float]] = _unbound


def _march(  # noqa: C901
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    grid: Stride,
    stops: Stops,
    space: Workspace,
    output: Output,
) -> int:
    """Fill `output` from the first state of `space` at t = 0; returns DONE, NOT_FINITE or LOG_FULL."""
    now, then = space.states[0], space.states[1]
    weights, inside, phi, rest = space.weights, space.inside, space.phi, space.rest
    past, told = space.past, space.foretelling
    unit = grid.interval / UNITS
    for k in range(1, UNITS + 1):
        set_step(flow.rows, weights[k], k * unit, phi)
    for level in range(1, grid.levels + 1):
        count = 1 << level
        set_step(flow.rows, weights[UNITS + level], count * grid.interval, phi)
        set_inside(flow.rows, inside[count : 2 * count - 1], count * grid.interval, phi[0])
    odd = UNITS + grid.levels + 1
    smallest, nudge = SMALLEST_STEP_SHARE * grid.interval, KINK_NUDGE_SHARE * grid.interval
    set_rest(flow, 0.0, rest)
    set_time(balls, frames, track, 0.0)
    remaining_force(balls, frames, law, flow, now, rest)
    reset_contact(balls, law)
    for ball in range(output.initial.size):
        output.initial[ball] = of_ball(balls, ACTIVE, ball)
    fx, fy = remaining_force(balls, frames, law, flow, now, rest)
    square = record(balls, flow, now, rest, 0, 1, output) + grid.seen * grid.seen_samples
    tolerance = max(grid.least, grid.share * math.sqrt(square / (1.0 + grid.seen_samples)))
    keeps = output.outer.shape[0] + output.state.shape[0] + output.force.shape[0] > 0
    if keeps:
        keep(balls, flow, now, rest, (fx, fy), 0.0, 0, output)
    # `cell` counts units; off the grid it is the last one passed.
    cell, careful, place, tried = 0, 0, 0, 0
    time, pace, before_step, budget = 0.0, grid.interval, 0.0, 0.0
    on_grid, told_ratio = True, 0.0
    event_ball, event_left, graded, losing = -1, 0.0, 0.0, False
    last_cell = (grid.samples - 1) * UNITS
    while cell < last_cell:
        while place < stops.time.size and stops.time[place] <= time + smallest:
            place += 1
        which, units, level = odd, 0, 0
        sample_end = (cell // UNITS + 1) * UNITS
        if event_ball >= 0:
            length = event_left if event_left <= graded else 0.5 * event_left
            units = int(length / unit + 0.5)
            if on_grid and units > 0 and abs(event_left / unit - int(event_left / unit + 0.5)) < 1e-6:
                which, length = units, units * unit
            else:
                units = 0
            target, beyond = time + length, time + length
        else:
            if on_grid:
                if cell % UNITS == 0 and cell >= careful:
                    level = grid.levels
                    while level > 0:
                        length = (1 << level) * grid.interval
                        if (
                            pace >= length
                            and cell + UNITS * (1 << level) <= last_cell
                            and active_kink(balls, stops, place, time + length) >= time + length
                            and count_ahead(balls, LOOK_AHEAD * length) == 0
                        ):
                            break
                        level -= 1
                if level > 0:
                    which, units = UNITS + level, UNITS * (1 << level)
                else:
                    units = min(sample_end - cell, max(1, int(pace / unit + 1e-6)))
                    which = units
                target = (cell + units) * unit
            else:
                units = min(sample_end, max(cell + 1, int((time + pace) / unit + 1e-6))) - cell
                target = (cell + units) * unit
            beyond = target
            if level == 0:
                kink = active_kink(balls, stops, place, target - smallest)
                if kink < target - smallest:
                    target, beyond, which, units = kink - nudge, kink + nudge, odd, 0
        step = target - time
        if which == odd:
            set_step(flow.rows, weights[odd], step, phi)
        before = rest[0, REST_OUTPUT], rest[1, REST_OUTPUT]
        contradicted, mx, my = step_pasted(
            balls, frames, law, track, flow, weights[which], time, step, now, fx, fy, then, rest
        )
        gx, gy = remaining_force(balls, frames, law, flow, then, rest)
        if event_ball < 0:
            changed = count_changes(balls, law)
            if changed + contradicted > 0:
                if level > 0:
                    careful = cell + units
                    set_rest(flow, time, rest)
                    continue
                if tried < MOST_CHANGES_PER_STEP:
                    tried += 1
                    share, ball, speed = locate(
                        balls, frames, law, track, flow, time, step, now, (fx, fy), then, (gx, gy), rest,
                        contradicted > 0, space.ends, space.suspects,
                    )  # fmt: skip
                    if ball >= 0:
                        event_ball, event_left = ball, share * step
                        losing = of_ball(balls, ACTIVE, ball) > 0.5
                        graded = max(graded_length(law, speed, tolerance), unit / UNITS)
                        if on_grid and UNIT_ERROR * unit * law.damping * abs(speed) < tolerance and graded > unit:
                            event_left = unit * int(event_left / unit + 0.5)
                            jump = UNIT_ERROR * unit * law.damping * abs(speed)
                            budget += jump * jump
                        if not losing:
                            pace = min(pace, graded)
                            graded = step
                        set_rest(flow, time, rest)
                        if event_left > smallest:
                            continue
                        toggle(balls, ball, time, output)
                        if output.tally[LOGGED] >= output.change_time.size:
                            return LOG_FULL
                        event_ball, before_step = -1, 0.0
                        set_time(balls, frames, track, time)
                        fx, fy = remaining_force(balls, frames, law, flow, now, rest)
                        continue
                    set_time(balls, frames, track, target)
                    gx, gy = remaining_force(balls, frames, law, flow, then, rest)
                elif changed > 0:
                    output.tally[UNLOCATED] += changed
                    reset_contact(balls, law)
                    gx, gy = remaining_force(balls, frames, law, flow, then, rest)
            if before_step > 0.0:
                ratio = before_step / step
                if ratio != told_ratio:
                    told_ratio = ratio
                    set_foretelling(ratio, told)
                error = abs(told[0] * past[0, 0] + told[1] * past[1, 0] + told[2] * fx + told[3] * gx - mx)
                error += abs(told[0] * past[0, 1] + told[1] * past[1, 1] + told[2] * fy + told[3] * gy - my)
                error *= step * told[4]
                if error > REJECTED * tolerance and units > 1:
                    pace = 0.5 * step
                    set_rest(flow, time, rest)
                    continue
                budget += error * error
                if error > tolerance:
                    pace = max(0.5 * step, unit)
                elif error < DOUBLED * tolerance:
                    pace = 2.0 * step
                elif step < pace:
                    pace = step if error > 2.0 * DOUBLED * tolerance else pace
            else:
                budget += tolerance * tolerance
                pace = min(max(2.0 * step, pace), grid.interval)
        output.tally[STEPS] += 1
        past[0, 0], past[0, 1], past[1, 0], past[1, 1] = fx, fy, mx, my
        before_step = step
        if level > 0:
            record_inside(
                inside, units // UNITS, units // UNITS, now, before, rest, (fx, fy), (mx, my), (gx, gy),
                cell // UNITS, output.acceleration,
            )  # fmt: skip
            if keeps:
                count = units // UNITS
                keep_inside(
                    balls, frames, law, track, flow, inside[count : 2 * count - 1], now, space.between, rest,
                    (fx, fy), (mx, my), (gx, gy), time, grid.interval, cell // UNITS, output,
                )  # fmt: skip
                set_rest(flow, target, rest)
                set_time(balls, frames, track, target)
                remaining_force(balls, frames, law, flow, then, rest)
        now, then = then, now
        fx, fy, time = gx, gy, beyond
        if event_ball >= 0:
            event_left -= step
            if event_left <= smallest:
                toggle(balls, event_ball, time, output)
                if output.tally[LOGGED] >= output.change_time.size:
                    return LOG_FULL
                fx, fy = remaining_force(balls, frames, law, flow, now, rest)
                event_ball, before_step = -1, 0.0
        elif beyond > target:
            set_time(balls, frames, track, time)
            fx, fy = remaining_force(balls, frames, law, flow, now, rest)
            before_step = 0.0
            pace = min(pace, grid.interval)
        if units > 0:
            cell += units
            on_grid = True
            time = cell * unit
        else:
            cell = int(time / unit)
            on_grid = False
            near = int(time / unit + 0.5)
            if abs(time - near * unit) < smallest:
                cell, time, on_grid = near, near * unit, True
        if on_grid and cell % UNITS == 0:
            tried = 0
            sample, weight = cell // UNITS, max(1, units // UNITS)
            seen = record(balls, flow, now, rest, sample, weight, output)
            if keeps:
                keep(balls, flow, now, rest, (fx, fy), time, sample, output)
            if not seen < LARGEST_ACCELERATION**2:
                return NOT_FINITE
            square += weight * seen
            tolerance = max(grid.least, grid.share * math.sqrt(square / (1.0 + grid.seen_samples + sample)))
    output.budget[0] = budget
    return DONE


def bind_modal_method(name: str, step: Callable[..., tuple[int, float, float]]) -> Callable[..., int]:
    """The march with `step` built in, compiled and cached under the method's `name`."""
    return specialise(_march, f"march_{name}", lean=True, step_pasted=step)


def workspace(flow: LinearFlow, start: Array, grid: Stride, balls: int) -> Workspace:
    """Memory for a march on `grid` from the amplitudes `start` (2, 2, M), for a contact model of `balls` columns."""
    modes = start.shape[2]
    return Workspace(
        states=np.stack([start, np.zeros_like(start)]),
        between=np.zeros_like(start),
        weights=np.zeros((UNITS + grid.levels + 2, WEIGHT_ROWS, 2, modes)),
        inside=np.zeros((2 << grid.levels, INSIDE_ROWS, 2, modes)),
        phi=np.zeros((2, 4, 2, 2, modes)),
        rest=flow.rest.copy(),
        ends=np.zeros((2, 3, 2)),
        suspects=np.zeros(balls),
        past=np.zeros((2, 2)),
        foretelling=np.zeros(5),
    )
