"""A step that knows no step before it: exponential Runge-Kutta of order 4 (Krogstad 2005, ETDRK4-B), four contact sums.

The first step after a change of contact or a kink is one; those that follow are carried (modal/carried.py).
The modes turn exactly under the stages' contact forces; what is integrated numerically is only what the contact force
differs from its mean spring and damper, so neither the fast resonator nor the contact modes limit the step, only how
fast that difference changes. Order 4 while the contact set does not change, which the march ensures by stopping at
every change. Not to be confused with Cox and Matthews' ETDRK4, whose stages lose order when the linear part is stiff,
nor with Lawson's integrating-factor RK4.
"""

from __future__ import annotations

from physics._jit import njit_inline, njit_pasted
from physics.arrays import Array
from physics.contact.contact_set import count_changes, note_motion
from physics.contact.forces import Contacts, move_to
from physics.integrators.modal.flow import LinearFlow, set_rest
from physics.integrators.modal.layout import AT_END, AT_HALF, END, HALF, KICKS, OTHER, TURN
from physics.integrators.modal.memory import Memory
from physics.integrators.modal.reading import free_motion, push, pushed, turn
from physics.integrators.modal.remainder import remainder_at

Force = tuple[float, float]


@njit_inline
def step_modal_rk4(
    contacts: Contacts,
    flow: LinearFlow,
    memory: Memory,
    row: int,
    time: float,
    step: float,
    start: Array,
    force: Force,
    end: Array,
) -> tuple[int, Force, Force]:
    """One step of `step` (s) with the weights in a `row` of the memory, from the amplitudes `start` (12,) at `time`,
    where the remaining contact force is `force`, to `end` (12,).

    The contact set stays frozen. Leaves `contacts` and the memory's `rest` at the end time; notes the motion of the
    balls halfway and the course of the contact force in the memory; returns how many balls contradict the set halfway,
    and the remaining contact force there and at the end.
    """
    w, rest, course = memory.weights[row], memory.rest, memory.course
    move_to(contacts, time + 0.5 * step)
    set_rest(flow, time + 0.5 * step, rest)
    motion = pushed(w, AT_HALF, 0, free_motion(w, HALF, start, rest), force)
    second = remainder_at(contacts, flow, motion)
    # Twice the rise between both forces, and not the rise itself: what order 4 asks of the third stage.
    motion = pushed(w, AT_HALF, 1, motion, rise_over_step(force, second, 4.0))
    third = remainder_at(contacts, flow, motion)
    contradicted = count_changes(contacts)
    note_motion(contacts.balls, memory.midway)

    move_to(contacts, time + step)
    set_rest(flow, time + step, rest)
    free = free_motion(w, END, start, rest)
    motion = pushed(w, AT_END, 1, pushed(w, AT_END, 0, free, force), rise_over_step(force, third, 2.0))
    fourth = remainder_at(contacts, flow, motion)
    set_parabola(force[0], second[0] + third[0], fourth[0], course[0])
    set_parabola(force[1], second[1] + third[1], fourth[1], course[1])
    turn(w, TURN, OTHER, start, end)
    push(w, KICKS, OTHER, course, end)
    motion = free
    for power in range(3):
        motion = pushed(w, AT_END, power, motion, (course[0, power], course[1, power]))
    return contradicted, third, remainder_at(contacts, flow, motion)


@njit_pasted
def rise_over_step(first: Force, middle: Force, times: float) -> Force:
    """So many `times` by what the force (N) went from `first` to the `middle` of the step."""
    return times * (middle[0] - first[0]), times * (middle[1] - first[1])


@njit_pasted
def set_parabola(first: float, twice_middle: float, last: float, course: Array) -> None:
    """Fill `course` (5,) with the parabola through forces (N) at the beginning, in the middle and at the end."""
    course[0], course[1] = first, 2.0 * twice_middle - 3.0 * first - last
    course[2] = 2.0 * (first - twice_middle + last)
    course[3], course[4] = 0.0, 0.0
