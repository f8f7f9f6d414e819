"""Where inside a trial step of the modes a ball first contradicts the contact set."""

from __future__ import annotations

from physics._jit import njit_inline
from physics.arrays import Array
from physics.contact.forces import Contacts
from physics.integrators.events import Way, earliest_change
from physics.integrators.modal.flow import ACCELERATION, LinearFlow, reading, relative, set_rest
from physics.integrators.modal.memory import Memory
from physics.integrators.trial import Trial


@njit_inline
def relative_motion(
    flow: LinearFlow, step: float, state: Array, force: tuple[float, float], rest: Array, ends: Array
) -> None:
    """Fill `ends` (3, 2), one end of a `Way`, from the amplitudes `state` (12,) and the remaining `force` (N) there."""
    ends[0, 0], ends[0, 1], u, v = relative(flow, state, rest)
    ends[1, 0], ends[1, 1] = step * u, step * v
    a = reading(flow, ACCELERATION, state, 0) + rest[0, ACCELERATION] + flow.jump * force[0]
    b = reading(flow, ACCELERATION, state, 1) + rest[1, ACCELERATION] + flow.jump * force[1]
    ends[2, 0], ends[2, 1] = step * step * a, step * step * b


@njit_inline
def locate(
    contacts: Contacts, flow: LinearFlow, memory: Memory, trial: Trial, grazing: bool
) -> tuple[float, int, float]:
    """Share of the step, ball and its speed of compression (m/s) of the first contact change in the `trial`; ball −1 if
    none.

    The change was seen at the end of the step, halfway, or between: if `grazing`, the memory's suspects say where. Its
    `rest` is of the end of the step, as are `contacts`, which are left somewhere inside it.
    """
    time, step, rest, ends = trial.time, trial.step, memory.rest, memory.ends
    relative_motion(flow, step, trial.then, trial.after, rest, ends[1])
    set_rest(flow, time, rest)
    relative_motion(flow, step, trial.now, trial.force, rest, ends[0])
    set_rest(flow, time + step, rest)
    if not grazing:
        memory.suspects[:] = 0.0
    return earliest_change(contacts, Way(time, step, ends[0], ends[1]), trial.contradicted > 0, memory.suspects)
