"""Marching on the modes with steps as long as the scene allows, every contact change located and every kink a stop.

Steps are whole numbers of units, a sixteenth of a sample, or two to twenty-four samples, and shorter than a unit
where an error asks for it; the samples inside a stride are exact responses of the modes to the step's contact force.
Everything is measured by one tolerance, the momentum (N s) by which a step or a contact change may be wrong. The length
of steps follows from the fourth power in the course of the contact force, and how exactly a change is located from the
jump of force it makes; next to it steps are graded as finely as contact begins or ends fast.
"""

from __future__ import annotations

from physics._jit import keep_arguments_apart, njit_lean, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import count_changes, note_motion, reset_contact, restore_motion
from physics.contact.forces import ACTIVE, Contacts, of_ball, set_time
from physics.integrators.modal.approach import leads_astray
from physics.integrators.modal.between import set_between
from physics.integrators.modal.bumps import has_corners
from physics.integrators.modal.carried import step_carried
from physics.integrators.modal.changes import AGAIN, CHANGED, TAKE, change_sides, land_on_ridge, look
from physics.integrators.modal.choice import Choice, next_step
from physics.integrators.modal.flow import LinearFlow, set_rest
from physics.integrators.modal.grazing import has_relief, mark_grazing
from physics.integrators.modal.judgement import (
    dipped,
    is_carried,
    judge,
    remember,
    set_tolerance,
)
from physics.integrators.modal.memory import (
    AT_WALL,
    BALL,
    BEFORE,
    BETWEEN,
    BUMPY,
    LEFT,
    NO_BALL,
    ON_GRID,
    PACE,
    PASSED,
    RETUNE,
    SPENT,
    SQUARES,
    STOP,
    TIME,
    TRIED,
    UNITS,
    Memory,
    ModalGrid,
)
from physics.integrators.modal.remainder import remaining_force
from physics.integrators.modal.rk4 import step_modal_rk4
from physics.integrators.modal.samples import keep, record, write_inside
from physics.integrators.modal.tension import add_contact_time
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
from physics.integrators.stops import KINK_NUDGE_SHARE, Stops, has_ridges, passed_kinks
from physics.integrators.trial import SMALLEST_STEP_SHARE, Trial

# No scene takes this many steps on average: what does, asks for more accuracy than it has.
MOST_STEPS_PER_SAMPLE, SPARE_STEPS = 128, 100_000
# The tolerance follows the signal once in so many samples: at every one its divisions and roots would take a
# twentieth of the time.
TUNED_EVERY = 32


@njit_lean
def begin(contacts: Contacts, flow: LinearFlow, grid: ModalGrid, memory: Memory, output: Output) -> None:
    """Find the first contact set and write sample 0."""
    clock, marks = memory.clock, memory.marks
    state, rest = memory.states[0], memory.rest
    set_rest(flow, 0.0, rest)
    set_time(contacts, 0.0)
    remaining_force(contacts, flow, state, rest)
    reset_contact(contacts)
    for ball in range(output.initial.size):
        output.initial[ball] = of_ball(contacts.balls, ACTIVE, ball)
    force = remaining_force(contacts, flow, state, rest)
    clock[:] = 0.0
    marks[:] = 0
    clock[PACE], marks[BALL], marks[ON_GRID] = min(grid.interval, memory.longest), NO_BALL, 1
    marks[BUMPY] = int(has_corners(contacts.track))
    clock[SQUARES] = record(flow, state, rest, 0, output)
    set_tolerance(grid, memory, 1)
    keep(contacts.balls, flow, rest, 0.0, state, force, 0, output)


@njit_pasted
def land(grid: ModalGrid, memory: Memory, units: int, beyond: float) -> None:
    """Move the clock to the end of a step of `units`, or off the grid to `beyond` (s)."""
    clock, marks = memory.clock, memory.marks
    unit = grid.interval / UNITS
    if units > 0:
        marks[PASSED] += units
        marks[ON_GRID] = 1
    else:
        near = int(beyond / unit + 0.5)
        marks[ON_GRID] = abs(beyond - near * unit) < SMALLEST_STEP_SHARE * grid.interval
        marks[PASSED] = near if marks[ON_GRID] == 1 else int(beyond / unit)
    clock[TIME] = marks[PASSED] * unit if marks[ON_GRID] == 1 else beyond


@njit_pasted
def write_sample(
    balls: Array,
    flow: LinearFlow,
    grid: ModalGrid,
    memory: Memory,
    state: Array,
    force: tuple[float, float],
    units: int,
    output: Output,
) -> bool:
    """Write the sample at which a step of `units` has ended, if there is one; False if it is no longer finite."""
    clock, marks = memory.clock, memory.marks
    if marks[ON_GRID] == 0 or marks[PASSED] % UNITS != 0:
        return True
    marks[TRIED] = 0
    sample, weight = marks[PASSED] // UNITS, max(1, units // UNITS)
    square = record(flow, state, memory.rest, sample, output)
    keep(balls, flow, memory.rest, clock[TIME], state, force, sample, output)
    clock[SQUARES] += weight * square
    if sample >= marks[RETUNE]:
        set_tolerance(grid, memory, sample + 1)
        marks[RETUNE] = sample + TUNED_EVERY
    return square < LARGEST_ACCELERATION**2


@njit_pasted
def arrive(
    contacts: Contacts, grid: ModalGrid, memory: Memory, choice: Choice, step: float, ridges: bool, output: Output
) -> bool:
    """What follows a `step` (s) that was taken as the `choice` says; True if it changes the contact force.

    A ball changes sides if this was the instant; behind a kink or a wall, the force is that of its far side.
    """
    clock, marks = memory.clock, memory.marks
    if ridges:
        note_motion(contacts.balls, memory.noted)
    if marks[BALL] != NO_BALL:
        clock[LEFT] -= step
        if clock[LEFT] > SMALLEST_STEP_SHARE * grid.interval:
            return False
        change_sides(contacts.balls, memory, output)
        if marks[AT_WALL] == 0:
            return True
        marks[AT_WALL] = 0
        beyond = clock[TIME] + KINK_NUDGE_SHARE * grid.interval
        if marks[ON_GRID] == 0:
            clock[TIME] = beyond
    elif choice.beyond > choice.end:
        beyond = choice.beyond
        clock[BEFORE], clock[PACE] = 0.0, min(clock[PACE], grid.interval)
    else:
        return False
    set_time(contacts, beyond)
    return True


@njit_pasted
def force_behind(
    contacts: Contacts, flow: LinearFlow, memory: Memory, now: Array, ridges: bool, output: Output
) -> tuple[float, float]:
    """Remaining contact force (N) behind a contact change, a kink or a wall, where free balls may land on a ridge."""
    force = remaining_force(contacts, flow, now, memory.rest)
    if ridges and land_on_ridge(contacts, memory, output):
        force = remaining_force(contacts, flow, now, memory.rest)
    return force


@njit_pasted
def try_step(
    contacts: Contacts,
    flow: LinearFlow,
    memory: Memory,
    row: int,
    step: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
) -> tuple[Trial, tuple[float, float]]:
    """The step from `now` to `then` (12,), carried by the one before if that was long enough; and the remaining contact
    force (N) halfway."""
    time = memory.clock[TIME]
    note_motion(contacts.balls, memory.noted)
    if is_carried(memory, step):
        halfway, middle, after = step_carried(contacts, flow, memory, row, time, step, now, force, then)
    else:
        halfway, middle, after = step_modal_rk4(contacts, flow, memory, row, time, step, now, force, then)
    return Trial(time, step, now, force, then, after, halfway), middle


@njit_pasted
def consider(
    contacts: Contacts,
    flow: LinearFlow,
    grid: ModalGrid,
    memory: Memory,
    units: int,
    trial: Trial,
    bumps: bool,
    output: Output,
) -> tuple[int, tuple[float, float]]:
    """What to do about the `trial` of `units`: TAKE it, AGAIN or CHANGED; and the remaining contact force (N) at its
    end."""
    contradicted = trial.contradicted + count_changes(contacts) > 0
    if dipped(contacts, grid, memory, trial.step, contradicted):
        return AGAIN, trial.after
    grazing = bumps and mark_grazing(contacts, memory.noted, trial.time, trial.step, memory.suspects) > 0
    after = trial.after
    if contradicted or grazing:
        action = look(contacts, flow, grid, memory, units, trial, contradicted, grazing, output)
        if action != TAKE:
            return action, after
        after = remaining_force(contacts, flow, trial.then, memory.rest)
    return TAKE if judge(contacts, grid, memory, trial.step) else AGAIN, after


@njit_pasted
def take_back(contacts: Contacts, flow: LinearFlow, memory: Memory, trial: Trial, action: int) -> tuple[float, float]:
    """Go back to the beginning of the `trial`, where a ball may have CHANGED sides; the remaining contact force (N)."""
    set_rest(flow, trial.time, memory.rest)
    restore_motion(contacts.balls, memory.noted)
    if action != CHANGED:
        return trial.force
    set_time(contacts, trial.time)
    return remaining_force(contacts, flow, trial.now, memory.rest)


@njit_lean
def march_modal(
    contacts: Contacts, flow: LinearFlow, grid: ModalGrid, stops: Stops, memory: Memory, output: Output
) -> int:
    """Fill `output` up to the samples of `grid` from where `begin`, or the march before, has left `memory`.

    Returns DONE, NOT_FINITE, LOG_FULL or OUT_OF_STEPS. After DONE it can go on to more samples, after LOG_FULL with a
    longer log.
    """
    keep_arguments_apart()
    now, then, rest = memory.states[0], memory.states[1], memory.rest
    clock, marks = memory.clock, memory.marks
    set_rest(flow, clock[TIME], rest)
    set_time(contacts, clock[TIME])
    force = remaining_force(contacts, flow, now, rest)
    most = MOST_STEPS_PER_SAMPLE * grid.samples + SPARE_STEPS
    room, smallest = output.change_time.size, SMALLEST_STEP_SHARE * grid.interval
    bumps, ridges = has_relief(contacts.track), has_ridges(stops)
    while marks[PASSED] < (grid.samples - 1) * UNITS and output.tally[LOGGED] < room:
        if output.tally[STEPS] > most:
            return OUT_OF_STEPS
        marks[STOP] = passed_kinks(stops, marks[STOP], clock[TIME] + smallest)
        choice = next_step(contacts.balls, grid, stops, memory)
        step = choice.end - clock[TIME]
        if choice.row == BETWEEN:
            # Otherwise what moves stands still over the nudge: 2e-8 of a sample, at every kink alike.
            reach = choice.beyond if memory.fine and choice.units == 0 else choice.end
            set_between(flow, memory, reach - clock[TIME], grid.interval / UNITS)
        trial, middle = try_step(contacts, flow, memory, choice.row, step, now, force, then)
        after = trial.after
        if marks[BALL] == NO_BALL:
            action, after = consider(contacts, flow, grid, memory, choice.units, trial, bumps, output)
            if action != TAKE:
                force = take_back(contacts, flow, memory, trial, action)
                continue
        elif leads_astray(contacts, grid, memory, step):
            force = take_back(contacts, flow, memory, trial, AGAIN)
            continue
        output.tally[STEPS] += 1
        add_contact_time(contacts, memory, step, output)
        remember(memory, step, force, middle)
        if choice.units > UNITS:
            write_inside(contacts, flow, grid, memory, choice, trial, output)
        now, then = then, now
        force = after
        land(grid, memory, choice.units, choice.beyond)
        if arrive(contacts, grid, memory, choice, step, ridges, output):
            force = force_behind(contacts, flow, memory, now, ridges, output)
        if not write_sample(contacts.balls, flow, grid, memory, now, force, choice.units, output):
            return NOT_FINITE
    for part in range(now.size):
        memory.states[0, part] = now[part]
    output.spent[0] = clock[SPENT]
    return DONE if output.tally[LOGGED] < room else LOG_FULL
