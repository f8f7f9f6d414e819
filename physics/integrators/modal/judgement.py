"""How long steps may be: the tolerance, what the past foretells, and what the start and end of contact ask for."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_inline, njit_inner, njit_pasted
from physics.contact.contact_set import count_dips
from physics.contact.forces import ACTIVE, CLOSING, COMPRESSION, Contacts, Law, law_power, of_ball
from physics.integrators.march import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE
from physics.integrators.modal.memory import (
    BALL,
    BEFORE,
    BUDGET,
    CELL,
    GRADED,
    LEFT,
    ON_GRID,
    ON_WAY,
    PACE,
    SHORTEST,
    SQUARES,
    TIME,
    TOLERANCE,
    TRIED,
    UNITS,
    Memory,
    Stride,
)

Array = NDArray[np.float64]

# A step is carried by the one before if that was at least this share as long.
LEAST_RATIO = 0.24
# Error of Simpson's rule over a step: of the fourth power of the share of the step; and, relative, of the force
# (t − t0)^1.5 with which contact starts and ends.
FOURTH_POWER_ERROR = 1.0 / 120.0
START_ERROR = 0.0024
# And, over the step's length, in terms of how far the middle strays from the cubic of values and rates at both ends.
HERMITE_ERROR = 2.0 / 15.0
# The tolerance grows or shrinks by what the errors so far make of the budget, within these bounds, as if this many
# samples had kept to it before the first.
LEAST_SPENT, MOST_SPENT, BUDGET_SAMPLES = 0.25, 8.0, 512
# Locating a change to the nearest unit is wrong by this share of the unit (root mean square).
UNIT_ERROR = 0.29
# A contact change is planned to be wrong by this share of the tolerance at most, and counts, with the steps next to it,
# as this many; it is planned anew if the film's force at its ball turns out to be wrong by more than the tolerance, and
# the time by no more than this share of the last step.
CHANGE_SHARE, CHANGE_FACTOR, MOST_MISSED = 0.3, 3.0, 0.5
# A step is taken back if its error exceeds the tolerance this many times. The next may be twice or half as long again
# if it stays below these shares of it, since the error grows by the fifth power of the length, and has to be shorter
# by LESS if it exceeds the tolerance.
REJECTED, DOUBLED, LONGER, LESS = 4.0, 1.0 / 32.0, 1.5**-5, 0.75


@njit_pasted
def graded_length(law: Law, speed: float, tolerance: float) -> float:
    """Longest step (s) next to an instant at which a ball starts or ceases to touch at `speed` (m/s)."""
    return (tolerance / (START_ERROR * law.stiffness * max(abs(speed), 1e-12) ** 1.5)) ** 0.4


@njit_inline
def set_tolerance(grid: Stride, memory: Memory, samples: int) -> None:
    """Let the tolerance follow the acceleration of `samples` samples, and what their errors have left of the budget."""
    clock = memory.clock
    square = (grid.seen * grid.seen_samples + clock[SQUARES]) / (grid.seen_samples + samples)
    tolerance = max(grid.least, grid.share * math.sqrt(square))
    allowed = grid.spending * tolerance * tolerance
    spent = (clock[BUDGET] + allowed * BUDGET_SAMPLES) / (allowed * (samples + BUDGET_SAMPLES))
    clock[TOLERANCE] = tolerance / min(max(spent, LEAST_SPENT), MOST_SPENT)


@njit_inner
def meet_change(
    law: Law, grid: Stride, memory: Memory, left: float, ball: int, losing: bool, speed: float, step: float
) -> None:
    """Head for the contact change of `ball`, `left` (s) ahead, met at `speed` (m/s) of compression.

    A loss is put on the grid if the film's force that it ends is small enough; contact may be made at a jump of the
    path, where the elastic force begins at any size.
    """
    clock, marks = memory.clock, memory.marks
    unit = grid.interval / UNITS
    allowed = CHANGE_SHARE * clock[TOLERANCE]
    clock[GRADED] = max(graded_length(law, speed, allowed), unit / UNITS)
    clock[BUDGET] += (CHANGE_FACTOR * clock[TOLERANCE]) ** 2
    jump = UNIT_ERROR * unit * law.damping * abs(speed)
    if losing and marks[ON_GRID] == 1 and jump < allowed and clock[GRADED] > unit:
        left = unit * max(1, int(left / unit + 0.5))
    marks[BALL], clock[LEFT], clock[ON_WAY] = ball, left, left
    if not losing:
        clock[PACE] = min(clock[PACE], clock[GRADED])
        clock[GRADED] = step


@njit_pasted
def may_shrink(grid: Stride, step: float) -> bool:
    """Whether `step` (s) is long enough to be taken back for a shorter one."""
    return step > SHORTEST * grid.interval / UNITS


@njit_pasted
def dipped(balls: Array, grid: Stride, memory: Memory, step: float) -> bool:
    """Whether some ball seems to change sides and back within the step, which is then to be halved."""
    if not may_shrink(grid, step) or count_dips(balls, memory.noted, step) == 0:
        return False
    memory.clock[PACE] = 0.5 * step
    return True


@njit_inline
def resolution_error(contacts: Contacts, noted: Array, midway: Array, step: float) -> float:
    """Momentum (N s) by which the step is wrong, from the balls' motion at its beginning (`noted`), `midway` and end.

    Of the film, Simpson's rule on the rates against the compressions themselves; of the elastic contact, how far the
    force in the middle is from the cubic through force and rate of force at both ends. Knows nothing of earlier steps.
    """
    balls, law, total = contacts.balls, contacts.law, 0.0
    for cage in range(balls.shape[0]):
        for j in range(balls.shape[2]):
            if balls[cage, ACTIVE, j] > 0.5:
                start, rate = noted[cage, 0, j], noted[cage, 1, j]
                middle, middle_rate = midway[cage, 0, j], midway[cage, 1, j]
                end, end_rate = balls[cage, COMPRESSION, j], balls[cage, CLOSING, j]
                film = end - start - step / 6.0 * (rate + 4.0 * middle_rate + end_rate)
                root, end_root = law_power(law, start), law_power(law, end)
                told = 0.5 * (max(start, 0.0) * root + max(end, 0.0) * end_root)
                told += 0.125 * step * law.exponent * (root * rate - end_root * end_rate)
                elastic = max(middle, 0.0) * law_power(law, middle) - told
                total += abs(law.damping * film) + HERMITE_ERROR * step * law.stiffness * abs(elastic)
    return total


@njit_pasted
def is_carried(memory: Memory, step: float) -> bool:
    """Whether the step before is long enough to foretell this one by."""
    return memory.clock[BEFORE] >= LEAST_RATIO * step


@njit_pasted
def carried_error(memory: Memory, step: float) -> float:
    """Momentum (N s) that Simpson's rule would miss of the fourth power of the force in a carried step.

    The step does not miss it, so a smooth force is less wrong than this; a rough one is about as wrong.
    """
    return step * FOURTH_POWER_ERROR * (abs(memory.course[0, 4]) + abs(memory.course[1, 4]))


@njit_pasted
def error_of(contacts: Contacts, memory: Memory, step: float) -> float:
    """Momentum (N s) by which the step that was just made is wrong."""
    if is_carried(memory, step):
        return carried_error(memory, step)
    return resolution_error(contacts, memory.noted, memory.midway, step)


@njit_inner
def too_coarse(contacts: Contacts, grid: Stride, memory: Memory, step: float) -> bool:
    """Whether a step on the way to a change of contact has to be taken back for one half as long."""
    if error_of(contacts, memory, step) <= REJECTED * memory.clock[TOLERANCE] or not may_shrink(grid, step):
        return False
    memory.clock[ON_WAY] = 0.5 * step
    return True


@njit_inner
def misses_change(contacts: Contacts, grid: Stride, memory: Memory, step: float) -> bool:
    """Plan the contact change at the end of the `step` (s) anew if its ball is not near zero compression; True if the
    step went past the change and is to be taken back.

    The change was located in a trial step through it, whose force was not smooth. Without tension a loss is no jump.
    """
    clock, marks, balls, law = memory.clock, memory.marks, contacts.balls, contacts.law
    if clock[LEFT] - step > SMALLEST_STEP_SHARE * grid.interval or marks[TRIED] >= MOST_CHANGES_PER_STEP:
        return False
    compression, rate = of_ball(balls, COMPRESSION, marks[BALL]), of_ball(balls, CLOSING, marks[BALL])
    losing = of_ball(balls, ACTIVE, marks[BALL]) > 0.5
    if law.damping * abs(compression) <= clock[TOLERANCE] or (losing and law.no_tension):
        return False
    late = compression / rate if (rate < 0.0) == losing and rate != 0.0 else math.inf
    next_sample = (marks[CELL] // UNITS + 1) * grid.interval
    if abs(late) > MOST_MISSED * step or clock[TIME] + step - late >= next_sample:
        return False
    marks[TRIED] += 1
    clock[LEFT] = step - late
    return late > 0.0


@njit_pasted
def judge(contacts: Contacts, grid: Stride, memory: Memory, step: float) -> bool:
    """Set the pace by the error of the step; False to take it back."""
    clock, tolerance = memory.clock, memory.clock[TOLERANCE]
    error = error_of(contacts, memory, step)
    if error > REJECTED * tolerance and may_shrink(grid, step):
        clock[PACE] = 0.5 * step
        return False
    clock[BUDGET] += error * error
    if error > tolerance:
        clock[PACE] = LESS * step
    elif clock[BEFORE] == 0.0:
        clock[PACE] = min(max(2.0 * step, clock[PACE]), grid.interval)
    elif error < DOUBLED * tolerance:
        clock[PACE] = max(clock[PACE], 2.0 * step)
    elif error < LONGER * tolerance:
        clock[PACE] = 1.5 * step
    elif step < clock[PACE]:
        clock[PACE] = step
    return True


@njit_pasted
def remember(memory: Memory, step: float, force: tuple[float, float], middle: tuple[float, float]) -> None:
    """Keep the contact force of the step that was taken, which foretells that of the next."""
    past = memory.past
    past[0, 0], past[0, 1], past[1, 0], past[1, 1] = force[0], force[1], middle[0], middle[1]
    memory.clock[BEFORE] = step
