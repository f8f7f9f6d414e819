"""How long steps may be: the tolerance, what the past foretells, and what the start and end of contact ask for."""

from __future__ import annotations

import math

from physics._jit import njit_inline, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import NOTED_COMPRESSION, NOTED_RATE, count_brushes, count_dips, count_lapses
from physics.contact.forces import ACTIVE, CLOSING, COMPRESSION, Contacts, law_power
from physics.integrators.modal.bumps import HERMITE_ERROR, passed_over
from physics.integrators.modal.memory import (
    BEFORE,
    BUMPY,
    PACE,
    SHORTEST,
    SPENT,
    SQUARES,
    TIME,
    TOLERANCE,
    UNITS,
    Memory,
    ModalGrid,
)

# A step is carried by the one before if that was at least this share as long.
LEAST_RATIO = 0.24
# Error of Simpson's rule over a step, of the fourth power of the share of the step.
FOURTH_POWER_ERROR = 1.0 / 120.0
# And of a swing, relative, over the fourth power of how far it turns (rad).
FLIGHT_ERROR = 1.0 / 2880.0
# The tolerance grows or shrinks by what the errors so far make of the budget, within these bounds, as if this many
# samples had kept to it before the first.
LEAST_SPENT, MOST_SPENT, BUDGET_SAMPLES = 0.25, 8.0, 512
# A step is taken back if its error exceeds the tolerance this many times. The next may be twice as long, or half as
# long again, if it stays below these shares of it, since the error grows by the fifth power of the length; and has to
# be LESS times as long if it exceeds the tolerance.
REJECTED, DOUBLED, LONGER, LESS = 4.0, 1.0 / 32.0, 1.5**-5, 0.75


@njit_inline
def set_tolerance(grid: ModalGrid, memory: Memory, samples: int) -> None:
    """Let the tolerance follow the acceleration of `samples` samples, and what their errors have left of the budget."""
    clock = memory.clock
    square = (grid.seen * grid.seen_samples + clock[SQUARES]) / (grid.seen_samples + samples)
    tolerance = max(grid.least, grid.share * math.sqrt(square))
    allowed = grid.spending * tolerance * tolerance
    spent = (clock[SPENT] + allowed * BUDGET_SAMPLES) / (allowed * (samples + BUDGET_SAMPLES))
    clock[TOLERANCE] = tolerance / min(max(spent, LEAST_SPENT), MOST_SPENT)


@njit_pasted
def may_shrink(grid: ModalGrid, step: float) -> bool:
    """Whether `step` (s) is long enough to be taken back for a shorter one."""
    return step > SHORTEST * grid.interval / UNITS


@njit_pasted
def dipped(contacts: Contacts, grid: ModalGrid, memory: Memory, step: float, contradicted: bool) -> bool:
    """Whether some ball changes sides and back within the step, which is then to be halved.

    If `contradicted`, another one changes sides, and those that only seem to are left until it has.
    """
    if not may_shrink(grid, step):
        return False
    dips = 0 if contradicted else count_dips(contacts.balls, memory.noted, step)
    if contacts.law.no_tension:
        dips += count_brushes(contacts.balls, memory.noted) + count_lapses(contacts, memory.noted, step)
    if dips == 0:
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
                start, rate = noted[cage, NOTED_COMPRESSION, j], noted[cage, NOTED_RATE, j]
                middle, middle_rate = midway[cage, NOTED_COMPRESSION, j], midway[cage, NOTED_RATE, j]
                end, end_rate = balls[cage, COMPRESSION, j], balls[cage, CLOSING, j]
                film = end - start - step / 6.0 * (rate + 4.0 * middle_rate + end_rate)
                root, end_root = law_power(law, start), law_power(law, end)
                cubic = 0.5 * (max(start, 0.0) * root + max(end, 0.0) * end_root)
                cubic += 0.125 * step * law.exponent * (root * rate - end_root * end_rate)
                elastic = max(middle, 0.0) * law_power(law, middle) - cubic
                total += abs(law.damping * film) + HERMITE_ERROR * step * law.stiffness * abs(elastic)
    return total


@njit_pasted
def flight_error(memory: Memory, step: float) -> float:
    """Momentum (N s) by which a step that no ball touches in may be wrong about the spring and damper that stand for
    the contacts: what Simpson's rule would miss if all of their force swung as fast as the fastest mode."""
    force, turn = 0.0, memory.fastest * step
    for power in range(3):
        force += abs(memory.course[0, power]) + abs(memory.course[1, power])
    return step * FLIGHT_ERROR * force * turn**4


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
        error = carried_error(memory, step)
        if memory.marks[BUMPY] == 1:
            error = max(error, passed_over(contacts, memory.noted, memory.clock[TIME], step))
        return error
    error = resolution_error(contacts, memory.noted, memory.midway, step)
    return error if error > 0.0 else flight_error(memory, step)


@njit_pasted
def judge(contacts: Contacts, grid: ModalGrid, memory: Memory, step: float) -> bool:
    """Set the pace by the error of the step; False to take it back."""
    clock, tolerance = memory.clock, memory.clock[TOLERANCE]
    error = error_of(contacts, memory, step)
    if error > REJECTED * tolerance and may_shrink(grid, step):
        clock[PACE] = 0.5 * step
        return False
    clock[SPENT] += error * error
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
    clock[PACE] = min(clock[PACE], memory.longest)
    return True


@njit_pasted
def remember(memory: Memory, step: float, force: tuple[float, float], middle: tuple[float, float]) -> None:
    """Keep the contact force of the step that was taken, which foretells that of the next."""
    past = memory.past
    past[0, 0], past[0, 1], past[1, 0], past[1, 1] = force[0], force[1], middle[0], middle[1]
    memory.clock[BEFORE] = step
