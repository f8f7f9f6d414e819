"""Which balls touch in a physical state (12,), and with what net force, for methods that do not work in modes.

A march begins with `find_contact`, presses its states, and asks `locate` for the first change in a step that it tried.
"""

from __future__ import annotations

import numpy as np

from physics._jit import njit, njit_inner
from physics.arrays import Array
from physics.contact.contact_set import reset_contact
from physics.contact.forces import ACTIVE, Contacts, of_ball, press, set_time
from physics.integrators.events import Way, earliest_change
from physics.integrators.output import Output
from physics.integrators.trial import Trial
from physics.motion import MotionModel, outer_load, relative_acceleration


@njit_inner
def press_state(contacts: Contacts, state: Array) -> tuple[float, float]:
    """Net force (N) of the contact set in `state` (12,)."""
    return press(contacts, state[0] - state[2], state[1] - state[3], state[6] - state[8], state[7] - state[9])


@njit_inner
def find_contact(contacts: Contacts, state: Array, output: Output) -> tuple[float, float]:
    """Make the contact set, and the first one in `output`, what the `state` (12,) at t = 0 says; the net force (N)."""
    set_time(contacts, 0.0)
    press_state(contacts, state)
    reset_contact(contacts)
    for ball in range(output.initial.size):
        output.initial[ball] = of_ball(contacts.balls, ACTIVE, ball)
    return press_state(contacts, state)


@njit_inner
def _relative_motion(
    motion: MotionModel, time: float, step: float, state: Array, force: tuple[float, float], ends: Array
) -> None:
    """Fill `ends` (3, 2), one end of a `Way`, from the `state` (12,) and the net contact `force` (N) at `time` (s)."""
    load = outer_load(motion, time)
    for axis in range(2):
        ends[0, axis] = state[axis] - state[2 + axis]
        ends[1, axis] = step * (state[6 + axis] - state[8 + axis])
        ends[2, axis] = step * step * relative_acceleration(motion, state, axis, load[axis], force[axis])


@njit
def locate(contacts: Contacts, motion: MotionModel, trial: Trial) -> tuple[float, int]:
    """Share of the step and ball of the first contact change in the `trial`; ball −1 if none.

    `contacts` are as `press` left them at its end; leaves them somewhere inside it.
    """
    begin, end = np.empty((3, 2)), np.empty((3, 2))
    _relative_motion(motion, trial.time, trial.step, trial.now, trial.force, begin)
    _relative_motion(motion, trial.time + trial.step, trial.step, trial.then, trial.after, end)
    suspects = np.zeros((contacts.balls.shape[0], contacts.balls.shape[2]))
    share, ball, _ = earliest_change(
        contacts, Way(trial.time, trial.step, begin, end), trial.contradicted > 0, suspects
    )
    return share, ball
