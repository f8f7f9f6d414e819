"""The classical explicit Runge-Kutta method of order 4: four contact sums a step, every coordinate treated alike.

Stable up to |λ| h = 2.61 to 2.96 of the fastest mode of all, the resonator's included: 2.82 undamped, 2.96 at 0.14 of
critical damping, 2.62 at half of it, 2.785 for pure decay.
Order 4 while the contact set does not change, which the marching loop ensures. Not to be confused with
the same method run blindly through changes of contact, which drops to first order.
"""

from __future__ import annotations

from physics._jit import njit_inline
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import Contacts, move_to
from physics.integrators.accelerations import accelerations
from physics.integrators.fixed_step_march import Workspace, bind_method
from physics.integrators.state_contact import press_state
from physics.motion import MotionModel


@njit_inline
def step_runge_kutta4(
    contacts: Contacts,
    motion: MotionModel,
    work: Workspace,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
) -> int:
    """One step of length `step` from `start` (12,), where the net contact force is `force`, into `end` (12,).

    The contact set stays frozen. Leaves `contacts` at the end time; returns how many balls contradict the set halfway.
    """
    square, stage = step * step, work.stage
    accelerations(motion, time, start, force, stage[0])
    for i in range(6):
        end[i] = start[i] + 0.5 * step * start[6 + i]
        end[6 + i] = start[6 + i] + 0.5 * step * stage[0, i]
    move_to(contacts, time + 0.5 * step)
    pushed = press_state(contacts, end)
    accelerations(motion, time + 0.5 * step, end, pushed, stage[1])
    for i in range(6):
        end[i] = start[i] + 0.5 * step * start[6 + i] + 0.25 * square * stage[0, i]
        end[6 + i] = start[6 + i] + 0.5 * step * stage[1, i]
    pushed = press_state(contacts, end)
    contradicted = count_changes(contacts)
    accelerations(motion, time + 0.5 * step, end, pushed, stage[2])
    for i in range(6):
        end[i] = start[i] + step * start[6 + i] + 0.5 * square * stage[1, i]
        end[6 + i] = start[6 + i] + step * stage[2, i]
    move_to(contacts, time + step)
    pushed = press_state(contacts, end)
    accelerations(motion, time + step, end, pushed, stage[3])
    for i in range(6):
        end[i] = start[i] + step * start[6 + i] + square / 6.0 * (stage[0, i] + stage[1, i] + stage[2, i])
        end[6 + i] = start[6 + i] + step / 6.0 * (stage[0, i] + 2.0 * (stage[1, i] + stage[2, i]) + stage[3, i])
    return contradicted


march_runge_kutta4 = bind_method("runge_kutta4", step_runge_kutta4)
