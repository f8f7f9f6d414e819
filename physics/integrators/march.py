"""Marching a one-step method from sample to sample, stopping at every change of the contact set and every known kink.

A trial step is made with the contact set frozen. If at its end, or halfway, a ball contradicts the set, the instant of
the first contradiction is located, the step is repeated up to it, the ball changes sides, and the march goes on from
there. Times at which a ball crosses an edge of its path are known beforehand and are step ends.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit, specialise
from physics.contact import ACTIVE, Law, of_ball, press, set_time
from physics.contact_set import count_changes, reset_contact
from physics.integrators.events import earliest_change, mark_suspects, quintic, relative_motion
from physics.integrators.output import DONE, LOG_FULL, LOGGED, NOT_FINITE, UNLOCATED, Grid, Output, record, toggle
from physics.integrators.propagator import WEIGHT_ROWS, PowerSeries, set_step
from physics.integrators.stops import Stops, next_kink, passed_kinks
from physics.motion import MotionModel
from physics.track import Track

Array = NDArray[np.float64]

SMALLEST_STEP_SHARE = 1e-7
# A step ends this much before a kink and the next one starts as much after it, so that each reads its own side.
KINK_NUDGE_SHARE = 1e-8
MOST_CHANGES_PER_STEP = 100
# Contact starts and ends like |t − t0|^n: steps shrink to this share of the full one next to it.
SHORTEST_GRADED_SHARE = 1.0 / 16.0


@njit
def locate(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    motion: MotionModel,
    time: float,
    step: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
    after: tuple[float, float],
    halfway: bool,
) -> tuple[float, int]:
    """Share of the step and ball of the first contact change in the trial step `now` to `then`; ball −1 if none.

    `balls` is as `press` left it at the end of the step; leaves it somewhere inside.
    """
    begin, end = np.empty((3, 2)), np.empty((3, 2))
    suspects = np.zeros((balls.shape[0], balls.shape[2]))
    relative_motion(motion, time, step, now, force, begin)
    relative_motion(motion, time + step, step, then, after, end)
    mark_suspects(balls, law, 1.0, suspects)
    if halfway:
        set_time(balls, frames, track, time + 0.5 * step)
        x, u = quintic(begin, end, 0, 0.5)
        y, v = quintic(begin, end, 1, 0.5)
        press(balls, frames, law, x, y, u / step, v / step)
        mark_suspects(balls, law, 0.5, suspects)
    share, ball, _ = earliest_change(balls, law, track, time, step, begin, end, suspects)
    return share, ball


@njit
def press_state(balls: Array, frames: Array, law: Law, state: Array) -> tuple[float, float]:
    """Net force (N) of the contact set in `state` (12,)."""
    return press(balls, frames, law, state[0] - state[2], state[1] - state[3], state[6] - state[8], state[7] - state[9])


def _unbound(*_arguments: object) -> Any:
    raise RuntimeError("a march needs the step of a method: use bind_method")


# Bound by `bind_method`: the step of the method, pasted into the march's fast path and called from its slow path.
step_pasted: Callable[..., int] = _unbound
step_called: Callable[..., int] = _unbound
cross: Callable[..., tuple[float, float]] = _unbound


def _cross(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    motion: MotionModel,
    series: PowerSeries,
    full_step: float,
    stops: Stops,
    place: int,
    start: float,
    finish: float,
    now: Array,
    force: tuple[float, float],
    then: Array,
    pace: Array,
    output: Output,
) -> tuple[float, float]:
    """Advance `now` from `start` to `finish` in as many parts as kinks and contact changes ask for.

    `pace` (1,) is the longest step allowed (s): short after contact was made, then doubling with every step.
    """
    weights, stage = np.empty((2, WEIGHT_ROWS, 4)), np.empty((4, 6))
    time, tried = start, 0
    smallest, nudge = SMALLEST_STEP_SHARE * full_step, KINK_NUDGE_SHARE * full_step
    while finish - time > smallest:
        place = passed_kinks(stops, place, time + smallest)
        target, beyond = finish, finish
        kink = next_kink(balls, stops, place, finish - smallest)
        if kink < finish - smallest:
            target, beyond = kink - nudge, kink + nudge
        if target - time > pace[0] + smallest:
            target = beyond = time + pace[0]
        step = target - time
        set_step(series, weights, step / full_step)
        contradicted = step_called(balls, frames, law, track, motion, weights, time, step, now, force, then, stage)
        after = press_state(balls, frames, law, then)
        changed = count_changes(balls, law)
        if (changed > 0 or contradicted > 0) and tried < MOST_CHANGES_PER_STEP:
            tried += 1
            share, ball = locate(
                balls, frames, law, track, motion, time, step, now, force, then, after, contradicted > 0
            )
            if ball >= 0:
                losing = of_ball(balls, ACTIVE, ball) > 0.5
                left = share * step
                while left > smallest:
                    length = 0.5 * left if losing and left > SHORTEST_GRADED_SHARE * full_step else left
                    set_step(series, weights, length / full_step)
                    step_called(balls, frames, law, track, motion, weights, time, length, now, force, then, stage)
                    force = press_state(balls, frames, law, then)
                    now[:] = then
                    time += length
                    left -= length
                set_time(balls, frames, track, time)
                toggle(balls, ball, time, output)
                if not losing:
                    pace[0] = SHORTEST_GRADED_SHARE * full_step
                force = press_state(balls, frames, law, now)
                continue
            set_time(balls, frames, track, target)
            after = press_state(balls, frames, law, then)
        elif changed > 0:
            output.tally[UNLOCATED] += changed
            reset_contact(balls, law)
            after = press_state(balls, frames, law, then)
        now[:] = then
        force = after
        time = beyond
        if beyond > target:
            set_time(balls, frames, track, time)
            force = press_state(balls, frames, law, now)
        pace[0] = min(2.0 * pace[0], full_step)
    return force


def _march(
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
    """Fill `output` from the state at t = 0, (12,) or longer by what the method carries along.

    Returns DONE, NOT_FINITE or LOG_FULL.
    """
    now, then = start_state.copy(), np.empty(start_state.size)
    weights, stage = np.empty((2, WEIGHT_ROWS, 4)), np.empty((4, 6))
    set_step(series, weights, 1.0)
    set_time(balls, frames, track, 0.0)
    press_state(balls, frames, law, now)
    reset_contact(balls, law)
    for ball in range(output.initial.size):
        output.initial[ball] = of_ball(balls, ACTIVE, ball)
    force = press_state(balls, frames, law, now)
    place = 0
    pace = np.full(1, grid.step)
    for sample in range(grid.samples):
        if not record(balls, motion, now, force, sample, output):
            return NOT_FINITE
        if sample == grid.samples - 1:
            break
        for substep in range(grid.substeps):
            start = (sample * grid.substeps + substep) * grid.step
            finish = (sample * grid.substeps + substep + 1) * grid.step
            place = passed_kinks(stops, place, start)
            if pace[0] >= grid.step and next_kink(balls, stops, place, finish) >= finish:
                contradicted = step_pasted(
                    balls, frames, law, track, motion, weights, start, grid.step, now, force, then, stage
                )
                after = press_state(balls, frames, law, then)
                if contradicted + count_changes(balls, law) == 0:
                    now, then = then, now
                    force = after
                    continue
            force = cross(
                balls, frames, law, track, motion, series, grid.step, stops, place,
                start, finish, now, force, then, pace, output,
            )  # fmt: skip
            if output.tally[LOGGED] >= output.change_time.size:
                return LOG_FULL
    return DONE


def _step(
    balls: Array,
    frames: Array,
    law: Law,
    track: Track,
    motion: MotionModel,
    weights: Array,
    time: float,
    step: float,
    start: Array,
    force: tuple[float, float],
    end: Array,
    stage: Array,
) -> int:
    """The step of the method as a called function."""
    return step_pasted(balls, frames, law, track, motion, weights, time, step, start, force, end, stage)


def bind_method(name: str, step: Callable[..., int]) -> Callable[..., int]:
    """The march with `step` built in, compiled and cached under the method's `name`.

    `step(balls, frames, law, track, motion, weights, time, step, start, force, end, stage)` makes one step of `step`
    (s) from `time` (s) with the contact set frozen: from the state `start` (12,), where `balls` stand and the contacts'
    net `force` (N, N) is known, to `end` (12,), leaving `balls` moved to the end of the step but not pressed there.
    `weights` (2, 13, 4) are the propagator's for this length and `stage` (4, 6) is scratch; a method need not use
    either. It returns how many balls contradict the contact set at a stage inside the step, 0 if it does not look.
    """
    called = specialise(_step, f"step_{name}_called", step_pasted=step)
    crossing = specialise(_cross, f"cross_{name}", step_called=called)
    return specialise(_march, f"march_{name}", step_pasted=step, cross=crossing)
