"""Marching a method at fixed steps from sample to sample, stopping at every change of contact and every known kink.

A trial step is made with the contact set frozen. If at its end, or inside it, a ball contradicts the set, the instant
of the first contradiction is located and the step is repeated up to it. There the ball changes sides, and the march
goes on. Times at which a ball crosses an edge of its path are known beforehand and are step ends.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from physics._jit import njit_inner, njit_part, njit_pasted, specialise
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import ACTIVE, Contacts, of_ball, set_time
from physics.integrators.output import (
    DONE,
    LOG_FULL,
    LOGGED,
    NOT_FINITE,
    Grid,
    Output,
    change_unlocated,
    record,
    toggle,
)
from physics.integrators.propagator import WEIGHT_ROWS, PowerSeries, set_step
from physics.integrators.state_contact import find_contact, locate, press_state
from physics.integrators.stops import KINK_NUDGE_SHARE, Stops, next_kink, passed_kinks
from physics.integrators.trial import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE, Trial, take_over
from physics.motion import MotionModel

# Contact starts and ends like |t − t0|^n: steps shrink to this share of the full one next to it.
SHORTEST_GRADED_SHARE = 1.0 / 16.0


class Workspace(NamedTuple):
    """What the step of a method may use: the propagator's `weights` (2, 13, 4) for its length, scratch (4, 6), and room
    (G, 2, M) for the motion of M balls in each of G cages."""

    weights: Array
    stage: Array
    noted: Array


class Span(NamedTuple):
    """The time from `start` to `finish` (s), and the first of the known kinks that is not behind."""

    start: float
    finish: float
    kink: int


@njit_part
def workspace(cages: int, balls: int) -> Workspace:
    """Room for the steps of one march, with so many `balls` in each of the `cages`."""
    return Workspace(np.empty((2, WEIGHT_ROWS, 4)), np.empty((4, 6)), np.empty((cages, 2, balls)))


def _unbound(*_arguments: object) -> Any:
    raise RuntimeError("a march needs the step of a method: use bind_method")


# Bound by `bind_method`: the step of the method, pasted into the march's fast path and into `attempt`, and the parts of
# the slow path.
step_pasted: Callable[..., int] = _unbound
attempt: Callable[..., Trial] = _unbound
approach: Callable[..., tuple[float, tuple[float, float]]] = _unbound
cross: Callable[..., tuple[float, float]] = _unbound


def _attempt(
    contacts: Contacts,
    motion: MotionModel,
    series: PowerSeries,
    work: Workspace,
    time: float,
    step: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
) -> Trial:
    """Try one step of any length up to that of the `series`; leaves `contacts` as `press` does at its end."""
    set_step(series, work.weights, step / series.step)
    halfway = step_pasted(contacts, motion, work, time, step, now, force, then)
    return Trial(time, step, now, force, then, press_state(contacts, then), halfway)


def _approach(
    contacts: Contacts,
    motion: MotionModel,
    series: PowerSeries,
    work: Workspace,
    trial: Trial,
    share: float,
    ball: int,
    pace: Array,
    output: Output,
) -> tuple[float, tuple[float, float]]:
    """Repeat the `trial` up to the change of `ball` located at a `share` of it, and let the ball change sides; the time
    (s) and the net force (N) then. Shortens the `pace` if contact is made."""
    losing = of_ball(contacts.balls, ACTIVE, ball) > 0.5
    time, force, left = trial.time, trial.force, share * trial.step
    while left > SMALLEST_STEP_SHARE * series.step:
        length = 0.5 * left if losing and left > SHORTEST_GRADED_SHARE * series.step else left
        force = attempt(contacts, motion, series, work, time, length, trial.now, force, trial.then).after
        take_over(trial.now, trial.then)
        time += length
        left -= length
    set_time(contacts, time)
    toggle(contacts.balls, ball, time, output)
    if not losing:
        pace[0] = SHORTEST_GRADED_SHARE * series.step
    return time, press_state(contacts, trial.now)


@njit_inner
def _end_of_part(
    balls: Array, stops: Stops, ahead: int, time: float, finish: float, pace: float, full_step: float
) -> tuple[float, float]:
    """Where the next step ends (s): at `finish`, at the `pace` or before a kink; and where to go on (s)."""
    smallest, nudge = SMALLEST_STEP_SHARE * full_step, KINK_NUDGE_SHARE * full_step
    target, beyond = finish, finish
    kink = next_kink(balls, stops, ahead, finish - smallest)
    if kink < finish - smallest:
        target, beyond = kink - nudge, kink + nudge
    if target - time > pace + smallest:
        target = beyond = time + pace
    return target, beyond


def _cross(
    contacts: Contacts,
    motion: MotionModel,
    series: PowerSeries,
    stops: Stops,
    span: Span,
    now: Array,
    force: tuple[float, float],
    pace: Array,
    output: Output,
) -> tuple[float, float]:
    """Advance `now` over the `span` in as many parts as kinks and contact changes ask for; the net force (N) then.

    `pace` (1,) is the longest step allowed (s): short after contact was made, then doubling with every step.
    """
    cages, _, balls = contacts.balls.shape
    work, then = workspace(cages, balls), np.empty(now.size)
    time, ahead, tried = span.start, span.kink, 0
    smallest = SMALLEST_STEP_SHARE * series.step
    while span.finish - time > smallest:
        ahead = passed_kinks(stops, ahead, time + smallest)
        target, beyond = _end_of_part(contacts.balls, stops, ahead, time, span.finish, pace[0], series.step)
        trial = attempt(contacts, motion, series, work, time, target - time, now, force, then)
        changed = count_changes(contacts)
        settled = changed + trial.contradicted == 0 and beyond == target
        if changed + trial.contradicted > 0 and tried < MOST_CHANGES_PER_STEP:
            tried += 1
            share, ball = locate(contacts, motion, trial)
            if ball >= 0:
                time, force = approach(contacts, motion, series, work, trial, share, ball, pace, output)
                continue
            set_time(contacts, target)
        elif changed > 0:
            change_unlocated(contacts, target, output)
        take_over(now, then)
        time = beyond
        if beyond > target:
            set_time(contacts, time)
        force = trial.after if settled else press_state(contacts, now)
        pace[0] = min(2.0 * pace[0], series.step)
    return force


def _march(
    contacts: Contacts,
    motion: MotionModel,
    series: PowerSeries,
    grid: Grid,
    stops: Stops,
    start_state: Array,
    output: Output,
) -> int:
    """Fill `output` from the state at t = 0, (12,) or longer by what the method carries along.

    Returns DONE, NOT_FINITE or LOG_FULL.
    """
    cages, _, balls = contacts.balls.shape
    now, then, work = start_state.copy(), np.empty(start_state.size), workspace(cages, balls)
    set_step(series, work.weights, 1.0)
    force = find_contact(contacts, now, output)
    ahead, pace = 0, np.full(1, grid.step)
    for sample in range(grid.samples):
        if not record(contacts.balls, motion, now, force, sample, output):
            return NOT_FINITE
        if sample == grid.samples - 1:
            break
        for substep in range(grid.substeps):
            start = (sample * grid.substeps + substep) * grid.step
            finish = (sample * grid.substeps + substep + 1) * grid.step
            ahead = passed_kinks(stops, ahead, start)
            if pace[0] >= grid.step and next_kink(contacts.balls, stops, ahead, finish) >= finish:
                contradicted = step_pasted(contacts, motion, work, start, grid.step, now, force, then)
                after = press_state(contacts, then)
                if contradicted + count_changes(contacts) == 0:
                    now, then = then, now
                    force = after
                    continue
                # The next step begins where this one did, and may look at how the balls move there.
                set_time(contacts, start)
                press_state(contacts, now)
            force = cross(contacts, motion, series, stops, Span(start, finish, ahead), now, force, pace, output)
            if output.tally[LOGGED] >= output.change_time.size:
                return LOG_FULL
    return DONE


def bind_method(name: str, step: Callable[..., int]) -> Callable[..., int]:
    """The march with `step` built in, compiled and cached under the method's `name`.

    `step(contacts, motion, work, time, step, start, force, end)` makes one step of `step` (s) from `time` (s) with the
    contact set frozen: from the state `start` (12,), where `contacts` stand and their net `force` (N, N) is known, to
    `end` (12,), leaving `contacts` moved to the end of the step but not pressed there. `work` is a Workspace, whose
    weights are of this length; a method need not use it. It returns how many balls contradict the contact set at a
    stage inside the step, or seem to, 0 if it does not look.
    """
    # The compiler optimises a part again with every kernel around it, so there are no more than needed.
    attempting = specialise(_attempt, f"attempt_{name}", njit_part, step_pasted=step)
    approaching = specialise(_approach, f"approach_{name}", njit_pasted, attempt=attempting)
    crossing = specialise(_cross, f"cross_{name}", njit_part, attempt=attempting, approach=approaching)
    return specialise(_march, f"march_{name}", step_pasted=step, cross=crossing)


def carrying(march: Callable[..., int], carried: Array) -> Callable[..., int]:
    """The `march` of a method whose state is longer by what it carries along, from the state (12,) at t = 0 with this
    behind it."""

    def longer(
        contacts: Contacts,
        motion: MotionModel,
        series: PowerSeries,
        grid: Grid,
        stops: Stops,
        start_state: Array,
        output: Output,
    ) -> int:
        return march(contacts, motion, series, grid, stops, np.concatenate([start_state, carried]), output)

    return longer
