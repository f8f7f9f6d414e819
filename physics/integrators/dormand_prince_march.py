"""Marching the embedded pair at steps of its own choosing; samples come from its dense output.

As in `physics.integrators.march`, a step is tried with the contact set frozen, the first change of contact inside it is
located, and the step is repeated up to it; known kinks of a path are step ends. `substeps` s asks for a local error of
LOOSEST_TOLERANCE / s⁵ of the motion seen so far, so that doubling it halves the steps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit
from physics.contact import ACTIVE, Law, of_ball, set_time
from physics.contact_set import count_changes, reset_contact
from physics.integrators.dormand_prince import STAGES, attempt, dense_output, local_error, relative, slope
from physics.integrators.march import KINK_NUDGE_SHARE, MOST_CHANGES_PER_STEP, SMALLEST_STEP_SHARE, locate, press_state
from physics.integrators.output import (
    DONE,
    LOG_FULL,
    LOGGED,
    NOT_FINITE,
    OUT_OF_STEPS,
    UNLOCATED,
    Grid,
    Output,
    record,
    toggle,
)
from physics.integrators.propagator import PowerSeries
from physics.integrators.stops import Stops, next_kink, passed_kinks
from physics.motion import MotionModel
from physics.track import Track

Array = NDArray[np.float64]

LOOSEST_TOLERANCE = 2e-3
FIRST_STEP_SHARE = 1e-3
SAFETY, MOST_SHRINKING, MOST_GROWTH = 0.9, 0.2, 5.0
SMALLEST_MOTION = 1e-18
MOST_STEPS_PER_SAMPLE, SPARE_STEPS = 40, 20_000


class Workspace(NamedTuple):
    """Scratch of one march: `rates` (7, 12) of the stages, `trial`, `between`, `scale`, `deviation` (12,)."""

    rates: Array
    trial: Array
    between: Array
    scale: Array
    deviation: Array


@njit
def _widen(work: Workspace, start: Array, state: Array, fastest: float) -> None:
    """Let the scale of errors grow with the deviation of `state` from the `start` of the run."""
    for i in range(12):
        work.deviation[i] = state[i] - start[i]
    relative(work.deviation)
    for i in range(12):
        floor = SMALLEST_MOTION if i < 6 else SMALLEST_MOTION * fastest
        work.scale[i] = max(work.scale[i], abs(work.deviation[i]), floor)


@njit
def _sample(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    motion: MotionModel,
    period: float,
    sample: int,
    time: float,
    step: float,
    now: Array,
    work: Workspace,
    output: Output,
) -> int:
    """Write the samples up to the end of the step; the number of the next one, or −1 if one is not finite."""
    while sample < output.acceleration.shape[0] and sample * period <= time + step:
        dense_output(work.rates, step, now, (sample * period - time) / step, work.between)
        set_time(balls, frames, track, sample * period)
        force = press_state(balls, frames, law, work.between)
        if not record(balls, motion, work.between, force, sample, output):
            return -1
        sample += 1
    return sample


@njit
def _control(error: float, tolerance: float, rejected: bool) -> float:
    """By what the next step is longer than this one."""
    if error == 0.0:
        return 1.0 if rejected else MOST_GROWTH
    wished = SAFETY * (tolerance / error) ** 0.2
    return max(MOST_SHRINKING, min(1.0 if rejected else MOST_GROWTH, wished))


@njit
def _prepare(
    balls: Array, frames: Array, law: Law, track: Track, motion: MotionModel, state: Array, rates: Array, output: Output
) -> tuple[float, float]:
    """Contact set and first row of `rates` at t = 0; the net force (N)."""
    set_time(balls, frames, track, 0.0)
    press_state(balls, frames, law, state)
    reset_contact(balls, law)
    for ball in range(output.initial.size):
        output.initial[ball] = of_ball(balls, ACTIVE, ball)
    return slope(balls, frames, law, track, motion, 0.0, state, rates[0])


@njit
def _cut(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    motion: MotionModel,
    time: float,
    step: float,
    now: Array,
    force: tuple[float, float],
    after: tuple[float, float],
    work: Workspace,
) -> tuple[float, int]:
    """Repeat the tried step up to the first contact change in it: its new length (s) and the ball, −1 if none."""
    share, ball = locate(balls, frames, law, track, motion, time, step, now, force, work.trial, after, True)
    if ball < 0:
        return step, ball
    if share > 0.0:
        attempt(balls, frames, law, track, motion, time, share * step, now, work.rates, work.trial)
    return share * step, ball


@njit
def _hop(time: float, gap: float, now: Array) -> float:
    """Carry `now` straight over a `gap` (s) that holds a kink, so that no stage reads the path on its wrong side."""
    for i in range(6):
        now[i] += gap * now[6 + i]
    return time + gap


@njit
def _settle(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    time: float,
    now: Array,
    ball: int,
    changed: int,
    output: Output,
) -> None:
    """Take over the contact set at the end of a step: of the located `ball`, or of all that `changed` unlocated."""
    set_time(balls, frames, track, time)
    if ball >= 0:
        toggle(balls, ball, time, output)
    elif changed > 0:
        press_state(balls, frames, law, now)
        output.tally[UNLOCATED] += count_changes(balls, law)
        reset_contact(balls, law)


@njit
def march_dormand_prince(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
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
    force = _prepare(balls, frames, law, track, motion, now, work.rates, output)
    _widen(work, start_state, now, fastest)
    if not record(balls, motion, now, force, 0, output):
        return NOT_FINITE
    time, step, place, sample, tried, rejected = 0.0, FIRST_STEP_SHARE * period, 0, 1, 0, False
    steps_left = MOST_STEPS_PER_SAMPLE * grid.substeps * grid.samples + SPARE_STEPS
    while sample < grid.samples:
        steps_left -= 1
        if steps_left < 0:
            return OUT_OF_STEPS
        place = passed_kinks(stops, place, time + smallest)
        kink = next_kink(balls, stops, place, min(time + step, finish) + smallest)
        meets = kink < min(time + step, finish) + smallest
        length = kink - nudge - time if meets else min(step, finish + smallest - time)
        fx, fy, contradicted = attempt(balls, frames, law, track, motion, time, length, now, work.rates, work.trial)
        error = local_error(work.rates, length, work.scale)
        if error > tolerance and length > smallest:
            step, rejected = length * _control(error, tolerance, True), True
            continue
        ball, changed = -1, count_changes(balls, law)
        if contradicted > 0 and tried < MOST_CHANGES_PER_STEP:
            length, ball = _cut(balls, frames, law, track, motion, time, length, now, force, (fx, fy), work)
        if ball >= 0:
            tried, meets = tried + 1, False
        elif not meets:
            step = min(period, length * _control(error, tolerance, rejected))
        if length > 0.0:
            next_sample = _sample(balls, frames, law, track, motion, period, sample, time, length, now, work, output)
            if next_sample < 0:
                return NOT_FINITE
            tried = tried if next_sample == sample else 0
            sample = next_sample
            now[:] = work.trial
        time += length
        time = _hop(time, 2.0 * nudge if meets else 0.0, now)
        rejected = False
        _widen(work, start_state, now, fastest)
        _settle(balls, frames, law, track, time, now, ball, changed, output)
        if output.tally[LOGGED] >= output.change_time.size:
            return LOG_FULL
        force = slope(balls, frames, law, track, motion, time, now, work.rates[0])
    return DONE
