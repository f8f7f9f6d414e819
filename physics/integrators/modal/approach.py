"""The way to a change of contact that was located: the steps up to it, and whether it is where it was looked for.

A change is located in a trial step through it, and so only as exactly as that step was, which is not very where a
surface is rough. So every step on the way is held against it. Where a ball has gone past its change, or the ball that
should change sides is too far from it for one correction, the plan is forgotten, and what follows is tried anew.
"""

from __future__ import annotations

import math

import numpy as np

from physics._jit import njit_inline, njit_inner, njit_pasted
from physics.contact.contact_set import NOTED_COMPRESSION, contradicts, count_changes
from physics.contact.forces import ACTIVE, CLOSING, COMPRESSION, FLOOR, LAW, Contacts, Law, compression_of
from physics.integrators.modal.judgement import DOUBLED, REJECTED, error_of, may_shrink
from physics.integrators.modal.memory import (
    AT_WALL,
    BALL,
    EXACT,
    GRADED,
    LEFT,
    NO_BALL,
    ON_GRID,
    ON_WAY,
    PACE,
    PASSED,
    SPENT,
    TIME,
    TOLERANCE,
    TRIED,
    UNITS,
    Memory,
    ModalGrid,
)
from physics.integrators.stops import KINK_NUDGE_SHARE
from physics.integrators.trial import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE

# Locating a change to the nearest unit is wrong by this share of the unit (root mean square).
UNIT_ERROR = 0.29
# A contact change is planned to be wrong by this share of the tolerance at most, and counts, with the steps next to it,
# as this many; its time is corrected by no more than this share of the last step.
CHANGE_SHARE, CHANGE_FACTOR, MOST_MISSED = 0.3, 3.0, 0.5
# Two instants whose difference is below this share of them are one: time is not known better.
ONE_INSTANT = 4.5e-16


@njit_pasted
def graded_length(law: Law, speed: float, tolerance: float) -> float:
    """Longest step (s) next to an instant t0 at which a ball starts or ceases to touch at `speed` (m/s).

    Simpson's rule over it is wrong by no more than `tolerance` (N s) in the momentum of the force K (speed (t − t0))ⁿ.
    """
    n = law.exponent
    # To a ten thousandth, and that at least: the rule is exact where n is 1 or 2.
    start_error = max(1.0, np.rint(1e4 * abs((1.0 + 4.0 * 0.5**n) / 6.0 - 1.0 / (n + 1.0)))) / 1e4
    return (tolerance / (start_error * law.stiffness * max(abs(speed), 1e-12) ** n)) ** (1.0 / (n + 1.0))


@njit_inner
def meet_change(
    law: Law, grid: ModalGrid, memory: Memory, left: float, ball: int, losing: bool, speed: float, step: float
) -> None:
    """Head for the contact change of `ball`, `left` (s) ahead, met at `speed` (m/s) of compression.

    A loss is put on the grid if the film's force that it ends is small enough; contact may be made at a jump of the
    path, where the elastic force begins at any size.
    """
    clock, marks = memory.clock, memory.marks
    unit = grid.interval / UNITS
    allowed = CHANGE_SHARE * clock[TOLERANCE]
    clock[GRADED] = max(graded_length(law, speed, allowed), unit / UNITS)
    clock[SPENT] += (CHANGE_FACTOR * clock[TOLERANCE]) ** 2
    jump = UNIT_ERROR * unit * law.damping * abs(speed)
    if losing and marks[ON_GRID] == 1 and marks[PASSED] >= marks[EXACT] and jump < allowed and clock[GRADED] > unit:
        left = unit * max(1, int(left / unit + 0.5))
    marks[BALL], clock[LEFT], clock[ON_WAY] = ball, left, left
    if not losing:
        clock[PACE] = min(clock[PACE], clock[GRADED])
        clock[GRADED] = step


@njit_inner
def leads_astray(contacts: Contacts, grid: ModalGrid, memory: Memory, step: float) -> bool:
    """Whether a `step` (s) on the way to a contact change has to be taken back: it is too coarse, or some ball is past
    its change.

    Where the change is not where it was located, it is planned anew by one correction, or the plan is forgotten. One at
    a wall of the path is marked.
    """
    clock, marks, tolerance = memory.clock, memory.marks, memory.clock[TOLERANCE]
    error = error_of(contacts, memory, step)
    if error > REJECTED * tolerance and may_shrink(grid, step):
        clock[ON_WAY] = 0.5 * step
        return True
    if error < DOUBLED * tolerance:
        clock[ON_WAY] = max(clock[ON_WAY], 2.0 * step)
    if marks[TRIED] >= MOST_CHANGES_PER_STEP:
        return False
    if clock[LEFT] - step <= SMALLEST_STEP_SHARE * grid.interval:
        size = contacts.balls.shape[2]
        cage, place = marks[BALL] // size, marks[BALL] % size
        if not _changes_at_zero(contacts, memory, cage, place) or _wrong_by(contacts, cage, place, step) <= tolerance:
            if marks[PASSED] < marks[EXACT] or not _is_past(contacts, step, tolerance, marks[BALL]):
                return False
            # Put on the grid, the change would be taken behind that of another ball.
            marks[BALL], marks[EXACT] = NO_BALL, marks[PASSED] + 1
            clock[PACE] = min(clock[PACE], step)
            return True
        late, then = _late(contacts, cage, place), clock[TIME] + step
        if _is_met_at_wall(contacts, marks[BALL], then, grid.interval):
            marks[AT_WALL] = 1
            return False
        if abs(late) <= ONE_INSTANT * then:
            return False
        next_sample = (marks[PASSED] // UNITS + 1) * grid.interval
        if abs(late) <= MOST_MISSED * step and then - late < next_sample:
            marks[TRIED] += 1
            clock[LEFT] = step - late
            return late > 0.0
    past = count_changes(contacts) > 0 and _is_past(contacts, step, tolerance, NO_BALL)
    if past or clock[LEFT] - step <= SMALLEST_STEP_SHARE * grid.interval:
        marks[BALL] = NO_BALL
        clock[PACE] = min(clock[PACE], step)
    return past


@njit_inner
def _is_met_at_wall(contacts: Contacts, ball: int, time: float, interval: float) -> bool:
    """Whether the path under a `ball` that is pressed at `time` (s), or just before, jumps there from where it was
    free; `interval` (s) is that of the samples."""
    balls, size, nudge = contacts.balls, contacts.balls.shape[2], KINK_NUDGE_SHARE * interval
    floor, compression = balls[ball // size, FLOOR, ball % size], balls[ball // size, COMPRESSION, ball % size]
    # The rings do not move in so short a time: only the floor differs.
    above, _ = compression_of(contacts, ball, time - nudge, 0.0, 0.0, 0.0, 0.0)
    below, _ = compression_of(contacts, ball, time + nudge, 0.0, 0.0, 0.0, 0.0)
    return compression + floor + above < 0.0 < compression + floor + below


@njit_inline
def _wrong_by(contacts: Contacts, cage: int, place: int, step: float) -> float:
    """Momentum (N s) by which the contact force is wrong where a ball should have changed sides: what the film has
    pushed since then, or, if it may not pull, what is missing of zero."""
    balls, law = contacts.balls, contacts.law
    film = law.damping * abs(balls[cage, COMPRESSION, place])
    return min(film, step * abs(balls[cage, LAW, place])) if law.no_tension else film


@njit_inline
def _is_past(contacts: Contacts, step: float, tolerance: float, apart_from: int) -> bool:
    """Whether some ball, `apart_from` one, contradicts the contact set by more than the tolerance (N s)."""
    for cage in range(contacts.balls.shape[0]):
        for place in range(contacts.balls.shape[2]):
            other = cage * contacts.balls.shape[2] + place != apart_from
            if other and contradicts(contacts, cage, place) and _wrong_by(contacts, cage, place, step) > tolerance:
                return True
    return False


@njit_inline
def _changes_at_zero(contacts: Contacts, memory: Memory, cage: int, place: int) -> bool:
    """Whether the ball changes sides at zero compression. Without tension it does not where it is let go of or taken
    hold of again while it is compressed: there its force is zero, or jumps past zero at a corner of the path."""
    losing = contacts.balls[cage, ACTIVE, place] > 0.5
    return not contacts.law.no_tension or not (losing or memory.noted[cage, NOTED_COMPRESSION, place] > 0.0)


@njit_inline
def _late(contacts: Contacts, cage: int, place: int) -> float:
    """How long ago (s) the ball was at zero compression by its rate now; infinite if it moves the other way."""
    compression, rate = contacts.balls[cage, COMPRESSION, place], contacts.balls[cage, CLOSING, place]
    losing = contacts.balls[cage, ACTIVE, place] > 0.5
    return compression / rate if (rate < 0.0) == losing and rate != 0.0 else math.inf
