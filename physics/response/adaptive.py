"""A response to a stated accuracy: begun beside a coarse one, gone on with, and made again where that is not enough."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from physics.integrators.method_table import MODAL
from physics.integrators.output import STEPS, Grid, Output
from physics.response.asked import Asked
from physics.response.attempts import confirm_doubtful, to_accuracy
from physics.response.goal import (
    AIM,
    COARSE,
    Goal,
    GoOn,
    fewest_touching,
    observed_sensitivity,
    perturbed_response,
    rms_distance,
    steady,
)
from physics.response.march_output import trace_of
from physics.response.modal_case import March, case_of
from physics.rms import rms
from physics.trace import ACCELERATION_ALONE, Kept, Trace

PILOT_SAMPLES = 2048
# First guess of the signal's size: this share of the acceleration that the load would give the outer ring. A coarse
# response tells it better; where it is below the second share of the guess, another one is made to what it told, so
# many in all. None is made to less than the third share of the guess before.
GUESSED_SHARE, FAR_SMALLER, SMALLEST_GUESS = 1e-2, 0.1, 1e-3
MOST_GUESSES = 3
# A response of more than this sensitivity may be chaotic where the pilot did not look: it is made again, and how far
# both are apart decides. So is one whose errors may grow and that is farther from a coarse one than this many times the
# error allowed, or than this share of its size, if that is more than what is allowed.
DOUBTFUL, NEAR, FAR = 4.0, 1.5, 0.03
# A stretch of a response is louder than its beginning if its RMS is more than this many times that.
LOUDER = 30.0


def respond_accurately(
    asked: Asked, keep: Kept = ACCELERATION_ALONE, *, go_on: GoOn = March.go_on, pilot: int = PILOT_SAMPLES
) -> Trace:
    """Trace of the response that is `asked` for, with the estimate of its error and with what it is to `keep`.

    `go_on` may end a march before all samples. A coarse `pilot` of some samples and the beginning of the response say
    how large the signal is and how much this scene makes of the errors of its steps; where that is much, a finer
    response says it again. A response that no finer one confirms is chaotic: two are as far apart as two records of the
    same machine, and the estimate is 1. Raises SimulationFailed if the response stops being finite, contact changes
    more often than can be logged, or steps become too many.
    """
    case = case_of(asked.scene, asked.rest, asked.rate, asked.fineness)
    goal = Goal(case, asked.samples, asked.accuracy, asked.least_error, keep, go_on)
    output, error, sensitivity = _response(goal, pilot)
    size, marched, interval = rms(output.acceleration), output.acceleration.shape[0], 1.0 / asked.rate
    trace = trace_of(asked.scene, Grid(marched, 1, interval), output, MODAL)
    step = (marched - 1) * interval / max(1, int(output.tally[STEPS]))
    chaotic = math.isinf(error)
    estimate = 1.0 if chaotic else error / size if size > 0.0 else 0.0
    return replace(trace, step=step, error_estimate=estimate, sensitivity=sensitivity, chaotic=chaotic)


def _response(goal: Goal, pilot: int) -> tuple[Output, float, float]:
    """The response, its estimated error (m/s², RMS) and its sensitivity."""
    march = goal.begin()
    begun = _beginning(goal, march, pilot)
    sensitivity, distance, growing = begun.sensitivity, begun.apart, goal.case.error_memory > 0.0
    if growing:
        output, grid = begun.output, goal.aimed(begun.square, AIM, 0.0)
    else:
        # One that is to be made again anyway need not be as exact as its sensitivity asks for.
        output, grid = to_accuracy(goal, march, begun.square, sensitivity if sensitivity <= DOUBTFUL else 0.0)
    size = rms(output.acceleration)
    if size == 0.0:
        return output, 0.0, sensitivity  # no load and no preload: balls that just touch the rings move nothing
    # Nothing may hold the rings beside a single direction of contact: they swing, and errors grow, at any time.
    loose = not growing and fewest_touching(output) <= goal.case.scene.rig.bearing.rows
    whole = growing or loose or _louder_later(output, pilot)
    if whole and not growing:
        coarse = goal.coarse(size)
        sensitivity = max(sensitivity, observed_sensitivity(goal.case, coarse, output))
        distance, growing = rms_distance(coarse, output), loose
    allowed = goal.allowed(size)
    if sensitivity > DOUBTFUL or (growing and distance > min(NEAR * allowed, max(FAR * size, allowed))):
        return confirm_doubtful(goal, output, grid, sensitivity)
    if whole and goal.error(output, sensitivity) > allowed:
        output, _ = to_accuracy(goal, goal.begin(), size**2, sensitivity)
    return output, goal.error(output, sensitivity), sensitivity


def _louder_later(output: Output, pilot: int) -> bool:
    """Whether the signal of some later stretch as long as the `pilot` is LOUDER than what that saw: of such a response
    it does not know what errors do."""
    values = output.acceleration.reshape(-1)
    first = np.arange(0, values.size, 2 * pilot)
    squares = np.add.reduceat(np.square(values), first) / np.diff(first, append=values.size)
    return bool(squares[1:].max(initial=0.0) > LOUDER**2 * squares[0])


class Beginning(NamedTuple):
    """How a march begins.

    `square` (m²/s⁴): mean square of the acceleration of its first samples; `apart` (m/s²): RMS distance from a coarse
    response; `sensitivity`: that distance over what the errors of the coarse steps add up to; `output`: what is marched
    so far, to the end if contacts may make errors grow.
    """

    square: float
    apart: float
    sensitivity: float
    output: Output


def _beginning(goal: Goal, march: March, pilot: int) -> Beginning:
    """Let the `march` begin, beside a coarse one of `pilot` samples."""
    case, short = goal.case, min(goal.samples, pilot)
    length = goal.samples if case.error_memory > 0.0 else short
    size = GUESSED_SHARE * max(abs(case.scene.operation.load), 1e-3) / case.scene.rig.outer_mass
    for _ in range(MOST_GUESSES):
        coarse = March(case, short).go_on(steady(case, short, COARSE, size))
        found = rms(coarse.acceleration[short // 2 : short])
        if found > FAR_SMALLER * size:
            size = found
            break
        size = max(found, SMALLEST_GUESS * size)
    if case.error_memory > 0.0:
        # Made anew, now that the size is known: errors as large from the beginning on show whether they grow.
        coarse = perturbed_response(case, steady(case, length, COARSE, size))
    wanted = AIM * min(max(goal.accuracy, goal.least_error / size), COARSE)
    fine = march.go_on(steady(case, length, wanted, size, spending=1.0))
    pushed = case.pushed(coarse)
    distance = rms(coarse.acceleration - fine.acceleration[:length])
    return Beginning(size**2, distance, distance / pushed if pushed > 0.0 else 1.0, fine)
