"""What follows from a trial step in which balls may change sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_inner
from physics.contact.contact_set import count_changes, reset_contact
from physics.contact.forces import ACTIVE, Contacts, of_ball, set_time
from physics.integrators.march import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE
from physics.integrators.modal.approach import meet_change
from physics.integrators.modal.flow import LinearFlow
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
from physics.integrators.trial import Trial

Array = NDArray[np.float64]

# What a look at a trial step says: take it, or go on from where it began, where a ball has CHANGED sides meanwhile.
TAKE, AGAIN, CHANGED = range(3)


@njit_inner
def change_sides(balls: Array, memory: Memory, output: Output) -> None:
    """Let the ball of the contact change ahead change sides now."""
    toggle(balls, memory.marks[BALL], memory.clock[TIME], output)
    memory.marks[BALL], memory.clock[BEFORE] = NO_BALL, 0.0


@njit_inline
def look(
    contacts: Contacts,
    flow: LinearFlow,
    grid: Stride,
    memory: Memory,
    units: int,
    trial: Trial,
    contradicted: bool,
    grazing: bool,
    output: Output,
) -> int:
    """What to do about the `trial` of `units` in which balls may change sides: TAKE it, AGAIN or CHANGED.

    They do if `contradicted`, and may if `grazing`. AGAIN: shorter, or up to the change that was located.
    """
    clock, marks, balls = memory.clock, memory.marks, contacts.balls
    if units > UNITS and contradicted:
        marks[CAREFUL] = marks[CELL] + units
        return AGAIN
    if marks[TRIED] >= MOST_CHANGES_PER_STEP:
        if contradicted:
            output.tally[UNLOCATED] += count_changes(contacts)
            reset_contact(contacts)
        return TAKE
    share, ball, speed = locate(contacts, flow, memory, trial, grazing)
    if ball < 0:
        set_time(contacts, trial.time + trial.step)
        return TAKE
    if units > UNITS:
        marks[CAREFUL] = marks[CELL] + units
        return AGAIN
    marks[TRIED] += 1
    losing = of_ball(balls, ACTIVE, ball) > 0.5
    meet_change(contacts.law, grid, memory, share * trial.step, ball, losing, speed, trial.step)
    if clock[LEFT] > SMALLEST_STEP_SHARE * grid.interval:
        return AGAIN
    change_sides(balls, memory, output)
    return CHANGED
