"""Exponential Adams methods of order 2, 3 and 4: predict, evaluate, correct, evaluate; two contact sums a step.

Outer ring, resonator and the inner ring's free motion are solved exactly under a contact force that is the polynomial
through its values at the end of this step and of the last ones; the prediction leaves out the first of these. Past
values are only of use while nothing breaks. After a change of the contact set, a kink or a step of another length the
method restarts with steps of the exponential Runge-Kutta method of order 4. It goes on with them until its past no
longer holds the break itself, where the force starts like a root. Not to be confused with Adams methods for the whole
state, whose step the resonator would limit.

The state is longer by eleven: order, length and end time of the step before, a mark of its contact set, how many equal
steps were made since the last break (four at most), and the last three forces, two numbers each.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.contact_set import count_changes, count_dips, mark_of, note_motion
from physics.contact.forces import ACTIVE, Contacts, set_time
from physics.integrators.exponential_rk4 import OUTER_STATE, flow_component, step_exponential_rk4
from physics.integrators.fixed_step_march import Workspace, bind_method, carrying
from physics.integrators.propagator import CUBE, FIRST, LAST, MIDDLE, WHOLE
from physics.integrators.state_contact import press_state
from physics.motion import MotionModel, outer_load

ORDERS = (2, 3, 4)
# Places in the longer state.
ORDER, LENGTH, END, CONTACTS, KNOWN, PAST = 12, 13, 14, 15, 16, 17
STATE_SIZE = PAST + 6
# Shares of the step below which lengths and times are the same.
SAME = 1e-9
Cubic = tuple[float, float, float, float]


@njit_inner
def _restart(
    contacts: Contacts,
    motion: MotionModel,
    work: Workspace,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
) -> int:
    """The Runge-Kutta step as a called function: it is pasted once, here, and not wherever the Adams step is."""
    return step_exponential_rk4(contacts, motion, work, time, step, start, force, end)


@njit_inner
def polynomial(order: int, now: float, past: Array, axis: int, ahead: float, corrected: bool) -> Cubic:
    """Coefficients from the constant to the cube, in shares of the step, of the force along one axis.

    Through the force `now` and as many in `past` (6,) as the order asks for; `corrected`: with the one `ahead`, at the
    step's end, in place of the oldest.
    """
    first = now - past[axis]
    second = now - 2.0 * past[axis] + past[2 + axis]
    third = now - 3.0 * past[axis] + 3.0 * past[2 + axis] - past[4 + axis]
    if order < 4:
        third = 0.0
    if order < 3:
        second = 0.0
    if corrected:
        if order == 4:
            third = ahead - now - first - second
        elif order == 3:
            second = ahead - now - first
        else:
            first = ahead - now
    return now, first + second / 2.0 + third / 3.0, second / 2.0 + third / 2.0, third / 6.0


@njit_inner
def _advance(
    motion: MotionModel,
    weights: Array,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    ahead: tuple[float, float],
    corrected: bool,
    end: Array,
) -> None:
    """Put into `end` (12,) the state after the step under the polynomial force of `polynomial`."""
    order = int(start[ORDER])
    # The load turns with the shaft: exact at both ends and in the middle, it is the parabola through these.
    load, last = outer_load(motion, time), outer_load(motion, time + step)
    middle = outer_load(motion, time + 0.5 * step)
    for axis in range(2):
        c0, c1, c2, c3 = polynomial(order, force[axis], start[PAST:], axis, ahead[axis], corrected)
        bend = 2.0 * (load[axis] - 2.0 * middle[axis] + last[axis])
        pull = last[axis] - load[axis] - bend
        inner = (load[axis] - c0) / 2.0 + (pull - c1) / 6.0 + (bend - c2) / 12.0 - c3 / 20.0
        speed = (load[axis] - c0) + (pull - c1) / 2.0 + (bend - c2) / 3.0 - c3 / 4.0
        end[axis] = start[axis] + step * start[6 + axis] + step * step / motion.inner_mass * inner
        end[6 + axis] = start[6 + axis] + step / motion.inner_mass * speed
        x, v, r, u = start[2 + axis], start[8 + axis], start[4 + axis], start[10 + axis]
        for component in range(4):
            # φ1, φ2 and φ3 from the weights of the Runge-Kutta method's stages.
            early, central = weights[axis, FIRST, component], weights[axis, MIDDLE, component]
            late = weights[axis, LAST, component]
            one, two = early + 2.0 * central + late, central + late
            three = 0.25 * (two + late)
            end[OUTER_STATE[component] + axis] = flow_component(weights, axis, WHOLE + component, x, v, r, u) + (
                one * c0 + two * c1 + 2.0 * three * c2 + 6.0 * weights[axis, CUBE, component] * c3
            )


@njit_inline
def step_exponential_adams(
    contacts: Contacts,
    motion: MotionModel,
    work: Workspace,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
) -> int:
    """One step of length `step` from `start` (23,), where the net contact force is `force`, into `end` (23,).

    The contact set stays frozen. Leaves `contacts` at the end time; returns how many balls contradict the set at the
    predicted end or seem to in between, or contradict it halfway in a restarting step.
    """
    mark, known = mark_of(contacts.balls, ACTIVE), int(start[KNOWN])
    if abs(start[LENGTH] - step) > SAME * step or abs(start[END] - time) > SAME * step or start[CONTACTS] != mark:
        known = 0
    if known >= int(start[ORDER]):
        note_motion(contacts.balls, work.noted)
        _advance(motion, work.weights, time, step, start, force, force, False, end)
        set_time(contacts, time + step)
        ahead = press_state(contacts, end)
        contradicted = count_changes(contacts) + count_dips(contacts.balls, work.noted, step)
        _advance(motion, work.weights, time, step, start, force, ahead, True, end)
    else:
        contradicted = _restart(contacts, motion, work, time, step, start, force, end)
    end[ORDER], end[LENGTH], end[END], end[CONTACTS] = start[ORDER], step, time + step, mark
    end[KNOWN] = min(known + 1, 4)
    end[PAST], end[PAST + 1] = force[0], force[1]
    for place in range(4):
        end[PAST + 2 + place] = start[PAST + place]
    return contradicted


_march = bind_method("exponential_adams", step_exponential_adams)


def march_of_order(order: int) -> Callable[..., int]:
    """The march of the method of `order` 2, 3 or 4, from the state (12,) at t = 0."""
    carried = np.zeros(STATE_SIZE - ORDER)
    carried[0] = order
    return carrying(_march, carried)
