"""A response to a stated accuracy: the modal method with the tolerance that the scene's own size asks for.

The method measures every step by the momentum it may be wrong by. What such a push leaves in the resonator's
acceleration follows from the modes alone, so the accuracy asked for, the size of the signal seen so far and a usual
number of pushes a second give the tolerance; and the sum of the errors made gives the estimate of the whole, times what
a pilot shows that this scene makes of them: contact changes can multiply an error.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics.integrators.methods import MODAL
from physics.integrators.modal.memory import STRIDES, Stride
from physics.integrators.output import LOGGED, STEPS, Grid, Output
from physics.outcome import SimulationFailed
from physics.response.march import trace_of
from physics.response.modal_case import USUAL_PUSHES, Case, Kept, March, case_of
from physics.scene import Scene
from physics.statics.load_distribution import Equilibrium
from physics.trace import Trace

Array = NDArray[np.float64]
GoOn = Callable[[March, Stride], Output]
ACCELERATION_ALONE = Kept()

# Errors are up to this many times what the errors of the steps add up to, or SENSITIVE times what a short pilot made of
# them if that is more: measured on the reference scenes and on scenes of the wide corpus that are not chaotic.
ERROR_FACTOR, SENSITIVE = 3.5, 6.0
# Of the accuracy asked for, what the tolerance aims at before errors are known, and what the estimate then aims at.
AIM, MARGIN = 0.1, 0.75
# A response of more than this sensitivity may be chaotic where the pilot did not look: it is made again with this share
# of the tolerance, and what both are apart tells. So is one whose errors may grow and that is farther from a coarse one
# than this many times the error allowed.
DOUBTFUL, FINER, NEAR = 4.0, 0.25, 3.0
# A response of more than this sensitivity may be chaotic, and is to be confirmed.
CHAOTIC = 50.0
# Of a response that is farther than LOST of its size from a coarser one no point is known. To confirm one, up to so
# many are made, with between MUCH_FINER and SURE of the tolerance of the one before.
LOST, MOST_CONFIRMATIONS = 0.1, 4
# None is made after one that took this many times the steps of the response to be confirmed.
MUCH_WORK = 7
MUCH_FINER, SURE = 1.0 / 256.0, 1.0 / 16.0
# What the share of the samples before they are LOST must exceed, with two attempts left and with one: it grew at most
# 2.6 times when the tolerance became MUCH_FINER (in 100 such scenes of 2780 of the wide corpus, from 0.1 to 1 s long).
SOON = (0.15, 0.4)
# Distances shrink with tolerances to this power, or to a higher one if the responses show it: impacts' errors shrink
# late.
LATE = 0.5
# The finer of two responses may be this many times as wrong as their distance leaves to hope for.
CONFIRMED = 6.0
PILOT_SAMPLES = 2048
SEED_ATTEMPTS = 3
# First guess of the signal's size: this share of the acceleration that the load would give the outer ring.
GUESSED_SHARE, SMALLEST_SHARE = 1e-2, 1e-8
# No tolerance is below this share of what the load does in a sample: forces are not known better.
ROUND_OFF = 1e-13
# The tolerance of the pilot; weights of the guessed size of the signal, in samples.
COARSE, CERTAIN, UNCERTAIN = 1e-3, 1e9, 512.0
# A beginning made with more than this many times the tolerance that the scene turns out to need is made again.
CALM = 1.5
# No further attempt is made after one that has left more than this share of the error.
MOST_ATTEMPTS, WORTHWHILE = 4, 0.5


def respond_accurately(
    scene: Scene,
    rest: Equilibrium,
    rate: float,
    samples: int,
    accuracy: float,
    least: float,
    kept: Kept = ACCELERATION_ALONE,
    go_on: GoOn = March.go_on,
    pilot: int = PILOT_SAMPLES,
) -> Trace:
    """Trace of `scene` at k / rate from the first of its positions at `rest` (modal_case.resting), to the relative RMS
    `accuracy` with its estimate.

    `least` (m/s², RMS) is an error that is always allowed. `go_on` may end a march before all samples. A coarse
    `pilot` of some samples and the beginning of the response say how large the signal is and how much this scene makes
    of the errors of its steps; where that is much, a finer response says it again. A response that no finer one
    confirms is chaotic: two are as far apart as two records of the same machine, and the estimate is 1. Raises
    SimulationFailed if the response stops being finite, contact changes more often than can be logged, or steps become
    too many.
    """
    case = case_of(scene, rest, rate)
    march = March(case, samples, kept)
    begun = _beginning(march, pilot, accuracy, least)
    sensitivity, apart = begun.sensitivity, begun.apart
    tame = 1.0 if sensitivity > CHAOTIC else _tame(sensitivity)
    output, grid, error, size = _to_accuracy(march, go_on, accuracy, least, begun.square, tame)
    fewest, allowed, growing = _fewest_touching(output), max(accuracy * size, least), case.memory > 0.0
    if not growing and fewest <= scene.rig.bearing.rows:
        # Nothing may hold the rings beside a single direction of contact: they swing, and errors grow, at any time.
        share = max(COARSE, allowed / size) if size > 0.0 else COARSE
        coarse = go_on(March(case, samples), _grid(case, samples, share, 0.0, size**2, CERTAIN, CERTAIN))
        sensitivity, apart, growing = max(sensitivity, _shown(case, coarse, output)), _apart(coarse, output), True
    if growing:
        error = max(error, SENSITIVE * sensitivity * case.pushed(output))
    if sensitivity > DOUBTFUL or (growing and max(error, apart / NEAR) > allowed):
        again, share = March(case, samples, kept), SURE if sensitivity > CHAOTIC or fewest == 0 else FINER
        output, error, size, sensitivity = _made_sure(again, go_on, accuracy, least, output, grid, share, sensitivity)
    marched = output.acceleration.shape[0]
    trace = trace_of(scene, Grid(marched, 1, grid.interval), output, MODAL)
    step = (marched - 1) * grid.interval / max(1, int(output.tally[STEPS]))
    chaotic = math.isinf(error)
    estimate = 1.0 if chaotic else error / size if size > 0.0 else 0.0
    return replace(trace, step=step, error_estimate=estimate, sensitivity=sensitivity, chaotic=chaotic)


def _fewest_touching(output: Output) -> int:
    """The smallest number of balls that touched at the same time."""
    made = output.change_made[: output.tally[LOGGED]]
    touching = output.initial.sum() + np.cumsum(np.where(made, 1, -1))
    return int(touching.min(initial=output.initial.sum()))


def _tame(sensitivity: float) -> float:
    """How many times more exact the steps of a scene have to be than those of one that makes nothing of errors."""
    return max(1.0, SENSITIVE * sensitivity / ERROR_FACTOR)


def _to_accuracy(
    march: March, go_on: GoOn, accuracy: float, least: float, seen: float, tame: float
) -> tuple[Output, Stride, float, float]:
    """The response with an estimated error (m/s², RMS) within the accuracy, the grid that gave it, that error, and the
    response's own RMS (m/s²).

    The first attempt goes on with the `march` that has begun, unless steps are to be more exact; more begin anew.
    """
    case, samples = march.case, march.samples
    aim, error = AIM / tame, math.inf
    for attempt in range(MOST_ATTEMPTS):
        if attempt > 0 or tame > CALM:
            march = March(case, samples, march.kept)
        spending = 2.0 * USUAL_PUSHES * (MARGIN / (ERROR_FACTOR * tame * aim)) ** 2
        grid = _grid(case, samples, aim * accuracy, aim * least, seen, UNCERTAIN, spending)
        output = go_on(march, grid)
        size = rms(output.acceleration)
        before, error = error, ERROR_FACTOR * tame * case.pushed(output)
        if error <= max(accuracy * size, least) or error > WORTHWHILE * before:
            break
        aim *= min(0.5, 0.7 * max(accuracy * size, least) / error)
        seen = size**2
    return output, grid, error, size


def _made_sure(
    march: March,
    go_on: GoOn,
    accuracy: float,
    least: float,
    output: Output,
    grid: Stride,
    share: float,
    sensitivity: float,
) -> tuple[Output, float, float, float]:
    """The response made again by a fresh `march` with this `share` of the tolerance of the `output`'s grid; its
    estimated error and its own RMS (m/s²), and the sensitivity that both tell.

    Where that is CHAOTIC or the rings part, until another one confirms it; else once more, to that sensitivity, if that
    is not within the accuracy.
    """
    case, grid = march.case, _finer(grid, share)
    finer = go_on(march, grid)
    sensitivity = max(sensitivity, _shown(case, output, finer))
    if sensitivity > CHAOTIC or _fewest_touching(finer) == 0:
        return *_confirmed(march, go_on, accuracy, least, output, finer, grid, share), sensitivity
    error, size = SENSITIVE * sensitivity * case.pushed(finer), rms(finer.acceleration)
    if error > max(accuracy * size, least):
        again = March(case, march.samples, march.kept)
        finer, _, error, size = _to_accuracy(again, go_on, accuracy, least, size**2, _tame(sensitivity))
    return finer, error, size, sensitivity


def _confirmed(
    march: March,
    go_on: GoOn,
    accuracy: float,
    least: float,
    coarse: Output,
    fine: Output,
    grid: Stride,
    share: float,
) -> tuple[Output, float, float]:
    """The `fine` response of a `march` on `grid`, or the first finer one, that is well within the accuracy of the one
    before, at first the `coarse` one with a `share` less tolerance; the error that this tells, and its RMS (m/s²).

    Where they are LOST too SOON for the attempts that are left, the error is infinite.
    """
    most = MUCH_WORK * int(coarse.tally[STEPS])
    power, apart, size = LATE, _apart(coarse, fine), rms(fine.acceleration)
    for attempt in range(MOST_CONFIRMATIONS):
        lost, allowed = apart > LOST * size, max(accuracy * size, least)
        if CONFIRMED * apart * share**LATE <= allowed:
            return fine, CONFIRMED * apart * share**LATE, size
        if lost and (attempt >= len(SOON) or _apart(coarse, fine, SOON[attempt]) > LOST * size):
            break
        if int(fine.tally[STEPS]) > most:
            break
        wanted = allowed / (CONFIRMED * apart * share**power)
        finer = MUCH_FINER if lost else min(max(wanted ** (1.0 / power), MUCH_FINER), SURE)
        grid = _finer(grid, finer)
        try:
            coarse, fine = fine, go_on(March(march.case, march.samples, march.kept), grid)
        except SimulationFailed:
            break  # no finer one can be made
        before, apart, size = apart, _apart(coarse, fine), rms(fine.acceleration)
        power = min(max(math.log(max(apart, ROUND_OFF * size) / before) / math.log(share), LATE), 1.0)
        share = finer
    return fine, math.inf if apart > LOST * size else CONFIRMED * apart * share**LATE, size


def _finer(grid: Stride, share: float) -> Stride:
    """A grid with this share of the tolerance."""
    return grid._replace(share=share * grid.share, least=share * grid.least)


def _shown(case: Case, coarse: Output, fine: Output) -> float:
    """How many times the errors of its steps the `coarse` response is apart from the `fine` one."""
    pushed = case.pushed(coarse)
    return _apart(coarse, fine) / pushed if pushed > 0.0 else 0.0


def _apart(one: Output, other: Output, share: float = 1.0) -> float:
    """How far two responses are apart (m/s², RMS) in this share of the samples, as long as both last."""
    both = math.ceil(share * min(one.acceleration.shape[0], other.acceleration.shape[0]))
    return rms(one.acceleration[:both] - other.acceleration[:both])


def rms(values: Array) -> float:
    """Root mean square over all entries."""
    return float(np.sqrt(np.mean(np.square(values))))


def _grid(case: Case, samples: int, share: float, least: float, seen: float, weight: float, spending: float) -> Stride:
    load = abs(case.scene.operation.load)
    floor = share * SMALLEST_SHARE * load / case.scene.rig.outer_mass
    return Stride(
        samples=samples,
        interval=1.0 / case.rate,
        levels=len(STRIDES),
        share=share * case.push * math.sqrt(0.5),
        least=max(case.push * max(least, floor), ROUND_OFF * load / case.rate),
        seen=2.0 * seen,
        seen_samples=weight,
        spending=spending,
    )


class Beginning(NamedTuple):
    """How a march begins: the mean `square` (m²/s⁴) of its first samples' acceleration, how far it is `apart` (m/s²,
    RMS) from a coarse one, and how many times as far as the errors of that one's steps add up to: all along, if
    contacts may make them grow."""

    square: float
    apart: float
    sensitivity: float


def _beginning(march: March, pilot: int, accuracy: float, least: float) -> Beginning:
    """Let the `march` begin, beside a coarse one of `pilot` samples."""
    case, short = march.case, min(march.samples, pilot)
    length = march.samples if case.memory > 0.0 else short
    size = GUESSED_SHARE * max(abs(case.scene.operation.load), 1e-3) / case.scene.rig.outer_mass
    for _ in range(SEED_ATTEMPTS):
        coarse = March(case, short).go_on(_grid(case, short, COARSE, 0.0, size**2, CERTAIN, CERTAIN))
        found = rms(coarse.acceleration[short // 2 : short])
        if found > 0.1 * size:
            size = found
            break
        size = max(found, 1e-3 * size)
    if length > short:
        # Made anew, now that the size is known: errors as large from the beginning on show whether they grow.
        coarse = March(case, length).go_on(_grid(case, length, COARSE, 0.0, size**2, CERTAIN, CERTAIN))
    wanted = AIM * min(max(accuracy, least / size), COARSE)
    fine = march.go_on(_grid(case, length, wanted, 0.0, size**2, CERTAIN, 1.0))
    pushed = case.pushed(coarse)
    apart = rms(coarse.acceleration - fine.acceleration[:length])
    return Beginning(size**2, apart, apart / pushed if pushed > 0.0 else 1.0)
