"""Marching the embedded pair at steps of its own choosing; samples come from its dense output.

As in `physics.integrators.fixed_step_march`, a step is tried with the contact set frozen, the first change of contact
inside it is located, and the step is repeated up to it; known kinks of a path are step ends. `substeps` s asks for s
steps a sample or more, and for a local error of LOOSEST_TOLERANCE / s⁵ of the motion seen so far, so that doubling it
halves the steps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from physics._jit import njit, njit_inner, njit_part
from physics.arrays import Array
from physics.contact.contact_set import count_changes
from physics.contact.forces import Contacts, set_time
from physics.integrators.dormand_prince import STAGES, attempt, dense_output, local_error, make_relative, slope
from physics.integrators.output import (
    DONE,
    LOG_FULL,
    LOGGED,
    NOT_FINITE,
    OUT_OF_STEPS,
    Grid,
    Output,
    change_unlocated,
    record,
    toggle,
)
from physics.integrators.propagator import PowerSeries
from physics.integrators.state_contact import find_contact, locate, press_state
from physics.integrators.stops import KINK_NUDGE_SHARE, Stops, next_kink, passed_kinks
from physics.integrators.trial import MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE, Trial, take_over
from physics.motion import MotionModel

# Local error, relative to the motion seen so far, at one step a sample.
LOOSEST_TOLERANCE = 2e-3
# Of a sample.
FIRST_STEP_SHARE = 1e-3
# The next step is this share of the one that would just keep the tolerance, within these bounds of the last one.
SAFETY, MOST_SHRINKING, MOST_GROWTH = 0.9, 0.2, 5.0
# m: what moves less is taken to have moved by this.
SMALLEST_MOTION = 1e-18
MOST_STEPS_PER_SAMPLE, SPARE_STEPS = 40, 20_000


class Workspace(NamedTuple):
    """Scratch of one march: `rates` (7, 12) of the stages, `then`, `between`, `scale`, `deviation` (12,)."""

    rates: Array
    then: Array
    between: Array
    scale: Array
    deviation: Array


@njit_inner
def _widen(work: Workspace, start: Array, state: Array, fastest: float) -> None:
    """Let the scale of errors grow with the deviation of `state` from the `start` of the run."""
    for i in range(12):
        work.deviation[i] = state[i] - start[i]
    make_relative(work.deviation)
    for i in range(12):
        floor = SMALLEST_MOTION if i < 6 else SMALLEST_MOTION * fastest
        work.scale[i] = max(work.scale[i], abs(work.deviation[i]), floor)


@njit_inner
def _sample(
    contacts: Contacts,
    motion: MotionModel,
    period: float,
    sample: int,
    trial: Trial,
    work: Workspace,
    output: Output,
) -> int:
    """Write the samples up to the end of the step; the number of the next one, or −1 if one is not finite."""
    time, step = trial.time, trial.step
    while sample < output.acceleration.shape[0] and sample * period <= time + step:
        dense_output(work.rates, step, trial.now, (sample * period - time) / step, work.between)
        set_time(contacts, sample * period)
        force = press_state(contacts, work.between)
        if not record(contacts.balls, motion, work.between, force, sample, output):
            return -1
        sample += 1
    return sample


@njit_inner
def _control(error: float, tolerance: float, rejected: bool) -> float:
    """By what the next step is longer than this one."""
    if error == 0.0:
        return 1.0 if rejected else MOST_GROWTH
    wished = SAFETY * (tolerance / error) ** 0.2
    return max(MOST_SHRINKING, min(1.0 if rejected else MOST_GROWTH, wished))


@njit_part
def _cut(contacts: Contacts, motion: MotionModel, trial: Trial, work: Workspace) -> tuple[Trial, int]:
    """The `trial` repeated up to the first contact change in it, and the ball; the trial itself and −1 if none."""
    share, ball = locate(contacts, motion, trial)
    if ball < 0:
        return trial, ball
    step = share * trial.step
    if step > 0.0:
        return attempt(contacts, motion, trial.time, step, trial.now, trial.force, work.then, work.rates), ball
    return Trial(trial.time, 0.0, trial.now, trial.force, trial.now, trial.force, 0), ball


@njit_inner
def _hop(time: float, gap: float, now: Array) -> float:
    """Carry `now` straight over a `gap` (s) that holds a kink, so that no stage reads the path on its wrong side."""
    for i in range(6):
        now[i] += gap * now[6 + i]
    return time + gap


@njit_inner
def _settle(
    contacts: Contacts,
    time: float,
    now: Array,
    ball: int,
    changed: int,
    output: Output,
) -> None:
    """Take over the contact set at the end of a step: of the located `ball`, or of all that `changed` unlocated."""
    set_time(contacts, time)
    if ball >= 0:
        toggle(contacts.balls, ball, time, output)
    elif changed > 0:
        press_state(contacts, now)
        change_unlocated(contacts, time, output)


@njit
def march_dormand_prince(
    contacts: Contacts,
    motion: MotionModel,
    series: PowerSeries,
    grid: Grid,
    stops: Stops,
    start_state: Array,
    output: Output,
) -> int:
    """Fill `output` from the state (12,) at t = 0; returns DONE, NOT_FINITE, LOG_FULL or OUT_OF_STEPS."""
    now = start_state.copy()
    work = Workspace(np.zeros((STAGES, 12)), np.empty(12), np.empty(12), np.zeros(12), np.empty(12))
    period = grid.substeps * grid.step
    tolerance = LOOSEST_TOLERANCE / float(grid.substeps) ** 5
    smallest, nudge = SMALLEST_STEP_SHARE * period, KINK_NUDGE_SHARE * period
    finish, fastest = (grid.samples - 1) * period, series.reach / series.step
    find_contact(contacts, now, output)
    force = slope(contacts, motion, 0.0, now, work.rates[0])
    _widen(work, start_state, now, fastest)
    if not record(contacts.balls, motion, now, force, 0, output):
        return NOT_FINITE
    time, step, ahead, sample, tried, rejected = 0.0, FIRST_STEP_SHARE * period, 0, 1, 0, False
    steps_left = MOST_STEPS_PER_SAMPLE * grid.substeps * grid.samples + SPARE_STEPS
    while sample < grid.samples:
        steps_left -= 1
        if steps_left < 0:
            return OUT_OF_STEPS
        ahead = passed_kinks(stops, ahead, time + smallest)
        kink = next_kink(contacts.balls, stops, ahead, min(time + step, finish) + smallest)
        meets = kink < min(time + step, finish) + smallest
        length = kink - nudge - time if meets else min(step, finish + smallest - time)
        trial = attempt(contacts, motion, time, length, now, force, work.then, work.rates)
        error = local_error(work.rates, length, work.scale)
        if error > tolerance and length > smallest:
            step, rejected = length * _control(error, tolerance, True), True
            continue
        ball, changed = -1, count_changes(contacts)
        if trial.contradicted > 0 and tried < MOST_CHANGES_PER_STEP:
            trial, ball = _cut(contacts, motion, trial, work)
        if ball >= 0:
            tried, meets = tried + 1, False
        elif not meets:
            step = min(grid.step, length * _control(error, tolerance, rejected))
        if trial.step > 0.0:
            next_sample = _sample(contacts, motion, period, sample, trial, work, output)
            if next_sample < 0:
                return NOT_FINITE
            tried = tried if next_sample == sample else 0
            sample = next_sample
            take_over(now, work.then)
        time = _hop(time + trial.step, 2.0 * nudge if meets else 0.0, now)
        rejected = False
        _widen(work, start_state, now, fastest)
        _settle(contacts, time, now, ball, changed, output)
        if output.tally[LOGGED] >= output.change_time.size:
            return LOG_FULL
        force = slope(contacts, motion, time, now, work.rates[0])
    return DONE
