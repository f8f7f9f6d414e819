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
    Law,
    Track,
    count_ahead,
    count_changes,
    count_dips,
    note_motion,
    of_ball,
    reset_contact,
    set_time,
)
from physics.integrators.flow import REST_OUTPUT, LinearFlow, set_rest
from physics.integrators.march import (
    DONE,
    KINK_NUDGE_SHARE,
    LARGEST_ACCELERATION,
    LOG_FULL,
    LOGGED,
    MOST_CHANGES_PER_STEP,
    NOT_FINITE,
    SMALLEST_STEP_SHARE,
    STEPS,
    UNLOCATED,
    Output,
    Stops,
    toggle,
)
from physics.integrators.modal_events import locate
from physics.integrators.modal_output import keep, record, remaining_force, write_inside
from physics.integrators.modal_weights import INSIDE_ROWS, WEIGHT_ROWS, set_inside, set_step

Array = NDArray[np.float64]

UNITS = 16
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
NEARLY = 1e-6
NO_BALL = -1

# Entries of `clock`: time (s), longest next step (s), length of the step before (s, 0 if its past is of no use), what
# is left to the contact change ahead (s), longest step next to it (s), tolerance (N s), sum of the squares of the
# acceleration (m²/s⁴), ratio of step lengths for which `foretelling` stands, sum of the squares of the errors (N² s²).
TIME, PACE, BEFORE, LEFT, GRADED, TOLERANCE, SQUARES, RATIO, BUDGET = range(9)
# Entries of `marks`: units passed, unit before which no stride starts, next kink, changes located in this sample, ball
# of the contact change ahead, whether `time` is a whole number of units.
CELL, CAREFUL, STOP, TRIED, BALL, ON_GRID = range(6)
# What a look at a trial step says: take it, or go on from where it began.
TAKE, AGAIN = range(2)


class Memory(NamedTuple):
    """Memory of a march: two states (2, 2, 2, M) and one in between (2, 2, M), weights of every step length and of the
    samples inside strides, φ-functions, what the loads alone do, scratch for locating changes, contact force at the
    beginning and in the middle of the step before (2, 2), weights that foretell it (5,), motion of the balls at the
    beginning of the step (G, 2, M), `clock` and `marks` as above.
    """

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
    noted: Array
    clock: Array
    marks: NDArray[np.int64]


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


@njit_lean
def set_tolerance(grid: Stride, memory: Memory, samples: int) -> None:
    """Let the tolerance follow the acceleration of `samples` samples."""
    square = memory.clock[SQUARES] / (grid.seen_samples + samples)
    memory.clock[TOLERANCE] = max(grid.least, grid.share * math.sqrt(square))


@njit_lean
def begin(
    balls: Array, frames: Array, law: Law, track: Track, flow: LinearFlow, grid: Stride, memory: Memory, output: Output
) -> tuple[float, float]:
    """Fill the tables of weights, find the first contact set, write sample 0; the remaining contact force (N)."""
    clock, marks = memory.clock, memory.marks
    for k in range(1, UNITS + 1):
        set_step(flow.rows, memory.weights[k], k * (grid.interval / UNITS), memory.phi)
    for level in range(1, grid.levels + 1):
        size = 1 << level
        set_step(flow.rows, memory.weights[UNITS + level], size * grid.interval, memory.phi)
        set_inside(flow.rows, memory.inside[size : 2 * size - 1], size * grid.interval, memory.phi[0])
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
    clock[SQUARES] = record(balls, flow, state, memory.rest, 0, 1, output) + grid.seen * grid.seen_samples
    set_tolerance(grid, memory, 1)
    keep(balls, flow, state, memory.rest, force, 0.0, 0, output)
    return force


@njit_inline
def stride_level(balls: Array, grid: Stride, stops: Stops, memory: Memory) -> int:
    """Power of two of the samples that may be passed over from here in one step; 0 if it has to be one or less."""
    clock, marks = memory.clock, memory.marks
    if marks[ON_GRID] == 0 or marks[CELL] % UNITS != 0 or marks[CELL] < marks[CAREFUL]:
        return 0
    level = grid.levels
    while level > 0:
        length = (1 << level) * grid.interval
        finish = clock[TIME] + length
        if (
            clock[PACE] >= length
            and marks[CELL] + UNITS * (1 << level) <= (grid.samples - 1) * UNITS
            and active_kink(balls, stops, marks[STOP], finish) >= finish
            and count_ahead(balls, LOOK_AHEAD * length) == 0
        ):
            break
        level -= 1
    return level


@njit_inline
def next_step(balls: Array, grid: Stride, stops: Stops, memory: Memory) -> tuple[int, int, float, float]:
    """Row of the step's weights (0 if they have to be computed), its units (0 if it ends off the grid), its end (s),
    and where to go on (s), beyond a kink at its end."""
    clock, marks = memory.clock, memory.marks
    unit, time = grid.interval / UNITS, clock[TIME]
    if marks[BALL] != NO_BALL:
        left = clock[LEFT]
        length = left if left <= clock[GRADED] else 0.5 * left
        units = int(length / unit + 0.5)
        if marks[ON_GRID] == 1 and units > 0 and abs(left / unit - int(left / unit + 0.5)) < NEARLY:
            return units, units, time + units * unit, time + units * unit
        return 0, 0, time + length, time + length
    level = stride_level(balls, grid, stops, memory)
    if level > 0:
        units = UNITS * (1 << level)
        return UNITS + level, units, (marks[CELL] + units) * unit, (marks[CELL] + units) * unit
    sample_end = (marks[CELL] // UNITS + 1) * UNITS
    reach = int((time + clock[PACE]) / unit + NEARLY)
    units = min(sample_end, max(marks[CELL] + 1, reach)) - marks[CELL]
    target = (marks[CELL] + units) * unit
    smallest = SMALLEST_STEP_SHARE * grid.interval
    kink = active_kink(balls, stops, marks[STOP], target - smallest)
    if kink < target - smallest:
        nudge = KINK_NUDGE_SHARE * grid.interval
        return 0, 0, kink - nudge, kink + nudge
    return units if marks[ON_GRID] == 1 else 0, units, target, target


@njit_lean
def meet_change(
    law: Law, grid: Stride, memory: Memory, left: float, ball: int, losing: bool, speed: float, step: float
) -> None:
    """Head for the contact change of `ball`, `left` (s) ahead, met at `speed` (m/s) of compression."""
    clock, marks = memory.clock, memory.marks
    unit = grid.interval / UNITS
    clock[GRADED] = max(graded_length(law, speed, clock[TOLERANCE]), unit / UNITS)
    jump = UNIT_ERROR * unit * law.damping * abs(speed)
    if marks[ON_GRID] == 1 and jump < clock[TOLERANCE] and clock[GRADED] > unit:
        left = unit * int(left / unit + 0.5)
        clock[BUDGET] += jump * jump
    marks[BALL], clock[LEFT] = ball, left
    if not losing:
        clock[PACE] = min(clock[PACE], clock[GRADED])
        clock[GRADED] = step


@njit_lean
def change_sides(balls: Array, memory: Memory, output: Output) -> None:
    """Let the ball of the contact change ahead change sides now."""
    toggle(balls, memory.marks[BALL], memory.clock[TIME], output)
    memory.marks[BALL], memory.clock[BEFORE] = NO_BALL, 0.0


@njit_lean
def look(
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
    halfway: bool,
    output: Output,
) -> int:
    """What to do about the trial step `now` to `then` that some ball contradicts: TAKE it or AGAIN.

    AGAIN: shorter, or up to the change that was located, or from here with a ball that has just changed sides.
    """
    clock, marks, rest = memory.clock, memory.marks, memory.rest
    if units > UNITS:
        marks[CAREFUL] = marks[CELL] + units
        return AGAIN
    if marks[TRIED] >= MOST_CHANGES_PER_STEP:
        output.tally[UNLOCATED] += count_changes(balls, law)
        reset_contact(balls, law)
        return TAKE
    marks[TRIED] += 1
    share, ball, speed = locate(
        balls, frames, law, track, flow, clock[TIME], step, now, force, then, after, rest, halfway,
        memory.ends, memory.suspects,
    )  # fmt: skip
    if ball < 0:
        set_time(balls, frames, track, clock[TIME] + step)
        return TAKE
    meet_change(law, grid, memory, share * step, ball, of_ball(balls, ACTIVE, ball) > 0.5, speed, step)
    if clock[LEFT] > SMALLEST_STEP_SHARE * grid.interval:
        return AGAIN
    change_sides(balls, memory, output)
    return AGAIN


@njit_inline
def dipped(balls: Array, memory: Memory, step: float, units: int) -> bool:
    """Whether some ball seems to change sides and back within the step, which is then to be halved."""
    if units == 1 or count_dips(balls, memory.noted, step) == 0:
        return False
    memory.clock[PACE] = 0.5 * step
    return True


@njit_inline
def judge(
    grid: Stride,
    memory: Memory,
    step: float,
    units: int,
    force: tuple[float, float],
    middle: tuple[float, float],
    after: tuple[float, float],
) -> bool:
    """Set the pace by how well the past foretold the force in the middle of the step; False to take it back."""
    clock, told, past = memory.clock, memory.foretelling, memory.past
    tolerance = clock[TOLERANCE]
    if clock[BEFORE] == 0.0:
        clock[BUDGET] += tolerance * tolerance
        clock[PACE] = min(max(2.0 * step, clock[PACE]), grid.interval)
        return True
    ratio = clock[BEFORE] / step
    if ratio != clock[RATIO]:
        clock[RATIO] = ratio
        set_foretelling(ratio, told)
    error = 0.0
    for axis in range(2):
        foretold = told[0] * past[0, axis] + told[1] * past[1, axis] + told[2] * force[axis] + told[3] * after[axis]
        error += abs(foretold - middle[axis])
    error *= step * told[4]
    if error > REJECTED * tolerance and units > 1:
        clock[PACE] = 0.5 * step
        return False
    clock[BUDGET] += error * error
    if error > tolerance:
        clock[PACE] = max(0.5 * step, grid.interval / UNITS)
    elif error < DOUBLED * tolerance:
        clock[PACE] = 2.0 * step
    elif error > 2.0 * DOUBLED * tolerance and step < clock[PACE]:
        clock[PACE] = step
    return True


@njit_inline
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


@njit_inline
def pass_stops(grid: Stride, stops: Stops, memory: Memory) -> None:
    """Count on to the first kink that is still ahead."""
    passed = memory.clock[TIME] + SMALLEST_STEP_SHARE * grid.interval
    while memory.marks[STOP] < stops.time.size and stops.time[memory.marks[STOP]] <= passed:
        memory.marks[STOP] += 1


@njit_inline
def remember(memory: Memory, step: float, force: tuple[float, float], middle: tuple[float, float]) -> None:
    """Keep the contact force of the step that was taken, which foretells that of the next."""
    past = memory.past
    past[0, 0], past[0, 1], past[1, 0], past[1, 1] = force[0], force[1], middle[0], middle[1]
    memory.clock[BEFORE] = step


@njit_inline
def write_sample(
    balls: Array,
    flow: LinearFlow,
    grid: Stride,
    memory: Memory,
    state: Array,
    force: tuple[float, float],
    units: int,
    output: Output,
) -> bool:
    """Write the sample at which a step of `units` has ended, if there is one; False if it is no longer finite."""
    clock, marks = memory.clock, memory.marks
    if marks[ON_GRID] == 0 or marks[CELL] % UNITS != 0:
        return True
    marks[TRIED] = 0
    sample, weight = marks[CELL] // UNITS, max(1, units // UNITS)
    square = record(balls, flow, state, memory.rest, sample, weight, output)
    keep(balls, flow, state, memory.rest, force, clock[TIME], sample, output)
    clock[SQUARES] += weight * square
    set_tolerance(grid, memory, sample + 1)
    return square < LARGEST_ACCELERATION**2


@njit_inline
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


def _unbound(*_arguments: object) -> Any:
    raise RuntimeError("a march needs the step of a method: use bind_modal_method")


# Bound by `bind_modal_method`: the step of the method, pasted into the march.
step_pasted: Callable[..., tuple[int, float, float]] = _unbound


def _march(
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
    """Fill `output` from the first state of `memory` at t = 0; returns DONE, NOT_FINITE or LOG_FULL."""
    now, then, rest = memory.states[0], memory.states[1], memory.rest
    clock, marks = memory.clock, memory.marks
    force = begin(balls, frames, law, track, flow, grid, memory, output)
    room = output.change_time.size
    while marks[CELL] < (grid.samples - 1) * UNITS and output.tally[LOGGED] < room:
        pass_stops(grid, stops, memory)
        row, units, target, beyond = next_step(balls, grid, stops, memory)
        start, step = clock[TIME], target - clock[TIME]
        if row == 0:
            set_step(flow.rows, memory.weights[0], step, memory.phi)
        before = rest[0, REST_OUTPUT], rest[1, REST_OUTPUT]
        note_motion(balls, memory.noted)
        halfway, mx, my = step_pasted(
            balls, frames, law, track, flow, memory.weights[row], start, step, now, force[0], force[1], then, rest
        )
        after = remaining_force(balls, frames, law, flow, then, rest)
        if marks[BALL] == NO_BALL:
            action = TAKE
            if halfway + count_changes(balls, law) > 0:
                action = look(
                    balls, frames, law, track, flow, grid, memory, step, units, now, force, then, after, halfway > 0,
                    output,
                )  # fmt: skip
                after = remaining_force(balls, frames, law, flow, then, rest)
            elif dipped(balls, memory, step, units):
                action = AGAIN
            if action == TAKE and not judge(grid, memory, step, units, force, (mx, my), after):
                action = AGAIN
            if action != TAKE:
                set_time(balls, frames, track, start)
                set_rest(flow, start, rest)
                force = remaining_force(balls, frames, law, flow, now, rest)
                continue
        output.tally[STEPS] += 1
        remember(memory, step, force, (mx, my))
        if units > UNITS:
            write_inside(
                balls, frames, law, track, flow, memory.inside, units // UNITS, now, memory.between, then, before, rest,
                force, (mx, my), after, start, grid.interval, marks[CELL] // UNITS, output,
            )  # fmt: skip
        now, then = then, now
        force = after
        land(grid, memory, units, beyond)
        if arrive(balls, frames, track, grid, memory, step, beyond - target, output):
            force = remaining_force(balls, frames, law, flow, now, rest)
        if not write_sample(balls, flow, grid, memory, now, force, units, output):
            return NOT_FINITE
    output.budget[0] = clock[BUDGET]
    return DONE if output.tally[LOGGED] < room else LOG_FULL


def bind_modal_method(name: str, step: Callable[..., tuple[int, float, float]]) -> Callable[..., int]:
    """The march with `step` built in, compiled and cached under the method's `name`."""
    return specialise(_march, f"march_{name}", lean=True, step_pasted=step)


def memory_for(flow: LinearFlow, start: Array, grid: Stride, cages: int, balls: int) -> Memory:
    """Memory for a march on `grid` from the amplitudes `start` (2, 2, M), for `cages` of `balls` columns each."""
    modes = start.shape[2]
    return Memory(
        states=np.stack([start, np.zeros_like(start)]),
        between=np.zeros_like(start),
        weights=np.zeros((UNITS + grid.levels + 1, WEIGHT_ROWS, 2, modes)),
        inside=np.zeros((2 << grid.levels, INSIDE_ROWS, 2, modes)),
        phi=np.zeros((2, 4, 2, 2, modes)),
        rest=flow.rest.copy(),
        ends=np.zeros((2, 3, 2)),
        suspects=np.zeros(cages * balls),
        past=np.zeros((2, 2)),
        foretelling=np.zeros(5),
        noted=np.zeros((cages, 2, balls)),
        clock=np.zeros(9),
        marks=np.zeros(6, dtype=np.int64),
    )
