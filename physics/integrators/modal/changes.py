"""What follows from a trial step in which balls may change sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inner
from physics.contact import ACTIVE, Law, of_ball, set_time
from physics.contact_set import count_changes, reset_contact
from physics.integrators.march import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE
from physics.integrators.modal.flow import LinearFlow
from physics.integrators.modal.judgement import meet_change
from physics.integrators.modal.location import locate
from physics.integrators.modal.memory import (
    BALL,
    BEFORE,
    CAREFUL,
    CELL,
    LEFT,
    NO_BALL,
    TIME,
    TRIED,
    UNITS,
    Memory,
    Stride,
)
from physics.integrators.output import UNLOCATED, Output, toggle
from physics.track import Track

Array = NDArray[np.float64]

# What a look at a trial step says: take it, or go on from where it began, where a ball has CHANGED sides meanwhile.
TAKE, AGAIN, CHANGED = range(3)


@njit_inner
def change_sides(balls: Array, memory: Memory, output: Output) -> None:
    """Let the ball of the contact change ahead change sides now."""
    toggle(balls, memory.marks[BALL], memory.clock[TIME], output)
    memory.marks[BALL], memory.clock[BEFORE] = NO_BALL, 0.0


@njit_inner
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
    contradicted: bool,
    halfway: bool,
    grazing: bool,
    output: Output,
) -> int:
    """What to do about the trial step `now` to `then` in which balls may change sides: TAKE it, AGAIN or CHANGED.

    They do if `contradicted`, and may if `grazing`. AGAIN: shorter, or up to the change that was located.
    """
    clock, marks, rest = memory.clock, memory.marks, memory.rest
    if units > UNITS and contradicted:
        marks[CAREFUL] = marks[CELL] + units
        return AGAIN
    if marks[TRIED] >= MOST_CHANGES_PER_STEP:
        if contradicted:
            output.tally[UNLOCATED] += count_changes(balls, law)
            reset_contact(balls, law)
        return TAKE
    share, ball, speed = locate(
        balls, frames, law, track, flow, clock[TIME], step, now, force, then, after, rest, halfway, grazing,
        memory.ends, memory.suspects,
    )  # fmt: skip
    if ball < 0:
        set_time(balls, frames, track, clock[TIME] + step)
        return TAKE
    if units > UNITS:
        marks[CAREFUL] = marks[CELL] + units
        return AGAIN
    marks[TRIED] += 1
    meet_change(law, grid, memory, share * step, ball, of_ball(balls, ACTIVE, ball) > 0.5, speed, step)
    if clock[LEFT] > SMALLEST_STEP_SHARE * grid.interval:
        return AGAIN
    change_sides(balls, memory, output)
    return CHANGED
