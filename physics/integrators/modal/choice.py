"""Which step to try next: as long as pace, kinks, the grid and balls about to change sides allow."""

from __future__ import annotations

from typing import NamedTuple

from physics._jit import njit_inline, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import count_ahead
from physics.integrators.modal.judgement import LEAST_RATIO
from physics.integrators.modal.memory import (
    BALL,
    BETWEEN,
    CAREFUL,
    GRADED,
    LEFT,
    NEARLY,
    NO_BALL,
    ON_GRID,
    ON_WAY,
    PACE,
    PASSED,
    STOP,
    STRIDES,
    TIME,
    UNITS,
    Memory,
    ModalGrid,
)
from physics.integrators.stops import KINK_NUDGE_SHARE, Stops, next_kink
from physics.integrators.trial import SMALLEST_STEP_SHARE

# A stride is taken only if no ball would change sides within this many times its length.
LOOK_AHEAD = 1.0
# A pace below this share of a unit leaves the grid; a rest of a unit below this share of a step joins it.
SHORT = 0.7


class Choice(NamedTuple):
    """A step to try: the `row` of its weights, BETWEEN if they are not there yet; its `units`, 0 if it ends off the
    grid; its `end` (s); and where to go on (s), `beyond` a kink at its end."""

    row: int
    units: int
    end: float
    beyond: float


@njit_pasted
def stride_level(balls: Array, grid: ModalGrid, stops: Stops, memory: Memory) -> int:
    """How many of the `STRIDES` may be taken from here, as a number from 1; 0 if the step is a sample or less."""
    clock, marks = memory.clock, memory.marks
    if marks[ON_GRID] == 0 or marks[PASSED] % UNITS != 0 or marks[PASSED] < marks[CAREFUL]:
        return 0
    level = grid.levels
    while level > 0:
        size = STRIDES[level - 1]
        length = size * grid.interval
        behind = clock[TIME] + length + SMALLEST_STEP_SHARE * grid.interval
        if (
            clock[PACE] >= length
            and marks[PASSED] + UNITS * size <= (grid.samples - 1) * UNITS
            and next_kink(balls, stops, marks[STOP], behind) >= behind
            and count_ahead(balls, LOOK_AHEAD * length) == 0
        ):
            break
        level -= 1
    return level


@njit_inline
def up_to_kink(
    balls: Array, grid: ModalGrid, stops: Stops, memory: Memory, row: int, units: int, target: float
) -> Choice:
    """The step to `target` (s), or to the first kink before it.

    A kink may also be where the step would end anyway: halves of a step that was taken back add up to it.
    """
    smallest, nudge = SMALLEST_STEP_SHARE * grid.interval, KINK_NUDGE_SHARE * grid.interval
    kink = next_kink(balls, stops, memory.marks[STOP], target + smallest)
    if kink >= target + smallest:
        return Choice(row, units, target, target)
    if kink < target - smallest or units == 0:
        return Choice(BETWEEN, 0, kink - nudge, kink + nudge)
    return Choice(row, units, target, max(target, kink) + nudge)


@njit_inline
def even_share(left: int, longest: int) -> int:
    """Length of the next of the steps, none above the `longest`, that cover what is `left` of a sample; all in units.

    They are as few as can be and all of like length. Behind a long one and a short rest the next long one could not be
    carried (judgement.py): its error would look larger, and the pace stay.
    """
    steps = (left + longest - 1) // longest
    return (left + steps - 1) // steps


@njit_pasted
def next_step(balls: Array, grid: ModalGrid, stops: Stops, memory: Memory) -> Choice:
    """The step to try next."""
    clock, marks = memory.clock, memory.marks
    unit, time = grid.interval / UNITS, clock[TIME]
    if marks[BALL] != NO_BALL:
        left = clock[LEFT]
        length = min(left if left <= clock[GRADED] else 0.5 * left, clock[ON_WAY])
        units = int(length / unit + 0.5)
        whole = abs(left / unit - int(left / unit + 0.5)) < NEARLY and (units - NEARLY) * unit <= clock[ON_WAY]
        if marks[ON_GRID] == 1 and units > 0 and whole:
            return Choice(units, units, time + units * unit, time + units * unit)
        return Choice(BETWEEN, 0, time + length, time + length)
    level = stride_level(balls, grid, stops, memory)
    if level > 0:
        units = UNITS * STRIDES[level - 1]
        return Choice(UNITS + level, units, (marks[PASSED] + units) * unit, (marks[PASSED] + units) * unit)
    next_line = (marks[PASSED] + 1) * unit
    if clock[PACE] < SHORT * unit and next_line - time > (1.0 + SHORT) * clock[PACE]:
        return up_to_kink(balls, grid, stops, memory, BETWEEN, 0, time + clock[PACE])
    left = (marks[PASSED] // UNITS + 1) * UNITS - marks[PASSED]
    units = min(left, max(1, int((time + clock[PACE]) / unit + NEARLY) - marks[PASSED]))
    row = units if marks[ON_GRID] == 1 else BETWEEN
    choice = up_to_kink(balls, grid, stops, memory, row, units, (marks[PASSED] + units) * unit)
    if not 0 < left - units < LEAST_RATIO * units or choice.beyond > choice.end:
        return choice
    units = even_share(left, units)
    row = units if marks[ON_GRID] == 1 else BETWEEN
    return Choice(row, units, (marks[PASSED] + units) * unit, (marks[PASSED] + units) * unit)
