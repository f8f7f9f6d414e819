"""What follows from a trial step in which balls may change sides."""

from __future__ import annotations

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.contact_set import NOTED_COMPRESSION, contradicts, touches
from physics.contact.forces import ACTIVE, LAW, Contacts, of_ball, set_time
from physics.integrators.modal.approach import meet_change
from physics.integrators.modal.flow import LinearFlow
from physics.integrators.modal.judgement import may_shrink
from physics.integrators.modal.location import locate
from physics.integrators.modal.memory import (
    BALL,
    BEFORE,
    CAREFUL,
    LEFT,
    NO_BALL,
    PACE,
    PASSED,
    SPENT,
    TIME,
    TRIED,
    UNITS,
    Memory,
    ModalGrid,
)
from physics.integrators.output import Output, change_unlocated, toggle
from physics.integrators.trial import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE, Trial

# What a look at a trial step says: take it, or go on from where it began, where a ball has CHANGED sides meanwhile.
TAKE, AGAIN, CHANGED = range(3)


@njit_inner
def change_sides(balls: Array, memory: Memory, output: Output) -> None:
    """Let the ball of the contact change ahead change sides now."""
    toggle(balls, memory.marks[BALL], memory.clock[TIME], output)
    memory.marks[BALL], memory.clock[BEFORE] = NO_BALL, 0.0


@njit_inner
def land_on_ridge(contacts: Contacts, memory: Memory, output: Output) -> bool:
    """Whether free balls are pressed just behind a wall that were not before it, as `noted`; they begin to touch there.

    Behind a wall a ridge may end within the next step, so that nothing is seen of it at the end.
    """
    balls, noted, landed = contacts.balls, memory.noted, False
    for cage in range(balls.shape[0]):
        for place in range(balls.shape[2]):
            free = balls[cage, ACTIVE, place] < 0.5 and noted[cage, NOTED_COMPRESSION, place] < 0.0
            if free and touches(contacts, cage, place):
                toggle(balls, cage * balls.shape[2] + place, memory.clock[TIME], output)
                landed = True
    return landed


@njit_inner
def left_out(contacts: Contacts, step: float) -> float:
    """Momentum (N s) by which a `step` (s) is wrong, at most, in which balls changed sides at unknown instants: their
    forces at its end, all along."""
    balls, force = contacts.balls, 0.0
    for cage in range(balls.shape[0]):
        for place in range(balls.shape[2]):
            if contradicts(contacts, cage, place):
                force += abs(balls[cage, LAW, place])
    return force * step


@njit_inline
def look(
    contacts: Contacts,
    flow: LinearFlow,
    grid: ModalGrid,
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
        marks[CAREFUL] = marks[PASSED] + units
        return AGAIN
    if marks[TRIED] >= MOST_CHANGES_PER_STEP:
        if contradicted:
            clock[SPENT] += left_out(contacts, trial.step) ** 2
            change_unlocated(contacts, trial.time + trial.step, output)
        return TAKE
    share, ball, speed = locate(contacts, flow, memory, trial, grazing)
    if ball < 0 and not contradicted and may_shrink(grid, trial.step):
        # The cubic by which a ball was seen to graze and the quintic that has it pass agree in a shorter step.
        clock[PACE] = 0.5 * trial.step
        return AGAIN
    if ball < 0:
        set_time(contacts, trial.time + trial.step)
        return TAKE
    if units > UNITS:
        marks[CAREFUL] = marks[PASSED] + units
        return AGAIN
    marks[TRIED] += 1
    losing = of_ball(balls, ACTIVE, ball) > 0.5
    meet_change(contacts.law, grid, memory, share * trial.step, ball, losing, speed, trial.step)
    if clock[LEFT] > SMALLEST_STEP_SHARE * grid.interval:
        return AGAIN
    change_sides(balls, memory, output)
    return CHANGED
