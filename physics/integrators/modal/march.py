"""Marching on the modes with steps as long as the scene allows, every contact change located and every kink a stop.

Steps are whole numbers of units, a sixteenth of a sample, or two to twenty-four samples, and shorter than a unit
where an error asks for it; the samples inside a stride are exact responses of the modes to the step's contact force.
Everything is measured by one tolerance, the momentum (N s) by which a step or a contact change may be wrong: the length
of steps from the fourth power in the course of the contact force, how exactly a change is located from the jump of
force it makes, how finely steps are graded next to it from how fast contact begins or ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_lean, njit_pasted
from physics.contact import ACTIVE, Law, of_ball, set_time
from physics.contact_set import count_changes, note_motion, reset_contact, restore_motion
from physics.integrators.march import SMALLEST_STEP_SHARE
from physics.integrators.modal.carried import step_carried
from physics.integrators.modal.changes import AGAIN, CHANGED, TAKE, change_sides, look
from physics.integrators.modal.choice import next_step
from physics.integrators.modal.flow import OUTPUT, LinearFlow, set_rest
from physics.integrators.modal.grazing import is_rough, mark_grazing
from physics.integrators.modal.judgement import dipped, is_carried, judge, remember, set_tolerance
from physics.integrators.modal.memory import (
    BALL,
    BEFORE,
    BUDGET,
    CELL,
    FIRST_INSIDE,
    LEFT,
    NO_BALL,
    ON_GRID,
    PACE,
    SQUARES,
    STOP,
    TIME,
    TRIED,
    UNITS,
    Memory,
    Stride,
)
from physics.integrators.modal.output import keep, record, remaining_force, write_inside
from physics.integrators.modal.rk4 import step_modal_rk4
from physics.integrators.modal.weights import set_step
from physics.integrators.output import (
    DONE,
    LARGEST_ACCELERATION,
    LOG_FULL,
    LOGGED,
    NOT_FINITE,
    OUT_OF_STEPS,
    STEPS,
    Output,
)
from physics.integrators.stops import Stops, passed_kinks
from physics.track import Track

Array = NDArray[np.float64]

# No scene takes this many steps on average: what does, asks for more accuracy than it has.
MOST_STEPS_PER_SAMPLE, SPARE_STEPS = 128, 100_000


@njit_lean
def begin(
    balls: Array, frames: Array, law: Law, track: Track, flow: LinearFlow, grid: Stride, memory: Memory, output: Output
) -> None:
    """Find the first contact set and write sample 0."""
    clock, marks = memory.clock, memory.marks
    state = memory.states[0]
    set_rest(flow, 0.0, memory.rest)
    set_time(balls, frames, track, 0.0)
    remaining_force(balls, frames, law, flow, state, memory.rest)
    reset_contact(balls, law)
    for ball in range(output.initial.size):
        output.initial[ball] = of_ball(balls, ACTIVE, ball)
    force = remaining_force(balls, frames, law, flow, state, memory.rest)
    clock[:] = 0.0
    marks[:] = 0
    clock[PACE], marks[BALL], marks[ON_GRID] = grid.interval, NO_BALL, 1
    clock[SQUARES] = record(balls, flow, state, memory.rest, 0, 1, output)
    set_tolerance(grid, memory, 1)
    keep(balls, flow, state, memory.rest, force, 0.0, 0, output)


@njit_pasted
def land(grid: Stride, memory: Memory, units: int, beyond: float) -> None:
    """Move the clock to the end of a step of `units`, or off the grid to `beyond` (s)."""
    clock, marks = memory.clock, memory.marks
    unit = grid.interval / UNITS
    if units > 0:
        marks[CELL] += units
        marks[ON_GRID] = 1
    else:
        near = int(beyond / unit + 0.5)
        marks[ON_GRID] = abs(beyond - near * unit) < SMALLEST_STEP_SHARE * grid.interval
        marks[CELL] = near if marks[ON_GRID] == 1 else int(beyond / unit)
    clock[TIME] = marks[CELL] * unit if marks[ON_GRID] == 1 else beyond


@njit_pasted
def write_sample(
    balls: Array,
    flow: LinearFlow,
    grid: Stride,
    memory: Memory,
    state: Array,
    force: tuple[float, float],
    units: int,
    kept: bool,
    output: Output,
) -> bool:
    """Write the sample at which a step of `units` has ended, if there is one; False if it is no longer finite.

    `kept`: more is wanted than the acceleration.
    """
    clock, marks = memory.clock, memory.marks
    if marks[ON_GRID] == 0 or marks[CELL] % UNITS != 0:
        return True
    marks[TRIED] = 0
    sample, weight = marks[CELL] // UNITS, max(1, units // UNITS)
    square = record(balls, flow, state, memory.rest, sample, weight, output)
    if kept:
        keep(balls, flow, state, memory.rest, force, clock[TIME], sample, output)
    clock[SQUARES] += weight * square
    set_tolerance(grid, memory, sample + 1)
    return square < LARGEST_ACCELERATION**2


@njit_pasted
def arrive(
    balls: Array,
    frames: Array,
    track: Track,
    grid: Stride,
    memory: Memory,
    step: float,
    jump: float,
    output: Output,
) -> bool:
    """What follows a `step` (s) that was taken; True if it changes the contact force.

    A ball changes sides if this was the instant, and a kink is passed in a `jump` (s).
    """
    clock, marks = memory.clock, memory.marks
    if marks[BALL] != NO_BALL:
        clock[LEFT] -= step
        if clock[LEFT] > SMALLEST_STEP_SHARE * grid.interval:
            return False
        change_sides(balls, memory, output)
        return True
    if jump > 0.0:
        set_time(balls, frames, track, clock[TIME])
        clock[BEFORE], clock[PACE] = 0.0, min(clock[PACE], grid.interval)
        return True
    return False


@njit_pasted
def try_step(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    memory: Memory,
    row: int,
    step: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
) -> tuple[bool, int, float, float, float, float]:
    """Whether the step before carried this one, how many balls contradict the contact set halfway, and the remaining
    contact force (N) halfway and at the end."""
    start = memory.clock[TIME]
    note_motion(balls, memory.noted)
    carried = is_carried(memory, step)
    if carried:
        halfway, mx, my, after_x, after_y = step_carried(
            balls, frames, law, track, flow, memory.weights[row], start, step, now, force[0], force[1], then,
            memory.rest, memory.past, memory.clock[BEFORE] / step, memory.course,
        )  # fmt: skip
    else:
        halfway, mx, my, after_x, after_y = step_modal_rk4(
            balls, frames, law, track, flow, memory.weights[row], start, step, now, force[0], force[1], then,
            memory.rest, memory.midway, memory.course,
        )  # fmt: skip
    return carried, halfway, mx, my, after_x, after_y


@njit_pasted
def consider(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    grid: Stride,
    memory: Memory,
    step: float,
    units: int,
    now: Array,
    force: tuple[float, float],
    then: Array,
    after: tuple[float, float],
    halfway: int,
    carried: bool,
    rough: bool,
    output: Output,
) -> tuple[int, float, float]:
    """What to do about the trial step `now` to `then`, at whose middle `halfway` balls contradict the contact set: TAKE
    it, AGAIN or CHANGED; and the remaining contact force (N) at its end, `after` if no ball changes sides."""
    start = memory.clock[TIME]
    contradicted = halfway + count_changes(balls, law) > 0
    if not contradicted and dipped(balls, grid, memory, step):
        return AGAIN, after[0], after[1]
    grazing = rough and mark_grazing(balls, law, track, memory.noted, start, step, memory.suspects) > 0
    if contradicted or grazing:
        action = look(
            balls, frames, law, track, flow, grid, memory, step, units, now, force, then, after, contradicted,
            halfway > 0, grazing, output,
        )  # fmt: skip
        if action != TAKE:
            return action, after[0], after[1]
        after = remaining_force(balls, frames, law, flow, then, memory.rest)
    return TAKE if judge(balls, law, grid, memory, step, carried) else AGAIN, after[0], after[1]


@njit_lean
def march_modal(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    flow: LinearFlow,
    grid: Stride,
    stops: Stops,
    memory: Memory,
    output: Output,
) -> int:
    """Fill `output` up to the samples of `grid` from where `begin`, or the march before, has left `memory`.

    Returns DONE, NOT_FINITE, LOG_FULL or OUT_OF_STEPS. After DONE it can go on to more samples, after LOG_FULL with a
    longer log.
    """
    now, then, rest = memory.states[0], memory.states[1], memory.rest
    clock, marks = memory.clock, memory.marks
    set_rest(flow, clock[TIME], rest)
    set_time(balls, frames, track, clock[TIME])
    force = remaining_force(balls, frames, law, flow, now, rest)
    most = MOST_STEPS_PER_SAMPLE * grid.samples + SPARE_STEPS
    room, smallest = output.change_time.size, SMALLEST_STEP_SHARE * grid.interval
    rough = is_rough(track)
    kept = output.outer.shape[0] + output.state.shape[0] + output.force.shape[0] > 0
    while marks[CELL] < (grid.samples - 1) * UNITS and output.tally[LOGGED] < room:
        if output.tally[STEPS] > most:
            return OUT_OF_STEPS
        marks[STOP] = passed_kinks(stops, marks[STOP], clock[TIME] + smallest)
        row, units, target, beyond = next_step(balls, grid, stops, memory)
        start, step = clock[TIME], target - clock[TIME]
        if row == 0:
            set_step(flow, memory.weights[0], step, memory.phi)
        before = rest[0, OUTPUT], rest[1, OUTPUT]
        carried, halfway, mx, my, after_x, after_y = try_step(
            balls, frames, law, track, flow, memory, row, step, now, force, then
        )
        if marks[BALL] == NO_BALL:
            action, after_x, after_y = consider(
                balls, frames, law, track, flow, grid, memory, step, units, now, force, then, (after_x, after_y),
                halfway, carried, rough, output,
            )  # fmt: skip
            if action != TAKE:
                set_rest(flow, start, rest)
                restore_motion(balls, memory.noted)
                if action == CHANGED:
                    set_time(balls, frames, track, start)
                    force = remaining_force(balls, frames, law, flow, now, rest)
                continue
        output.tally[STEPS] += 1
        remember(memory, step, force, (mx, my))
        if units > UNITS:
            write_inside(
                balls, frames, law, track, flow, memory.inside, FIRST_INSIDE[row - UNITS - 1], units // UNITS, now,
                memory.between, then, before, rest, memory.course, start, grid.interval, marks[CELL] // UNITS, output,
            )  # fmt: skip
        now, then = then, now
        force = after_x, after_y
        land(grid, memory, units, beyond)
        if arrive(balls, frames, track, grid, memory, step, beyond - target, output):
            force = remaining_force(balls, frames, law, flow, now, rest)
        if not write_sample(balls, flow, grid, memory, now, force, units, kept, output):
            return NOT_FINITE
    for part in range(now.size):
        memory.states[0, part] = now[part]
    output.budget[0] = clock[BUDGET]
    return DONE if output.tally[LOGGED] < room else LOG_FULL
