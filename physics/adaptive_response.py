"""A response to a stated accuracy: the modal method with the tolerance that the scene's own size asks for.

The method measures every step by the momentum it may be wrong by. What such a push leaves in the resonator's
acceleration follows from the modes alone, so the accuracy asked for, the size of the signal seen so far and a usual
number of pushes a second give the tolerance; and the sum of the errors made gives the estimate of the whole, times what
a pilot shows that this scene makes of them: contact changes can multiply an error.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from physics.assembly import assemble
from physics.contact import ContactModel
from physics.integrators.adaptive_march import OUT_OF_STEPS
from physics.integrators.march import LOG_FULL, NOT_FINITE, STEPS, Grid, Output, Stops
from physics.integrators.methods import MODAL
from physics.integrators.modal.flow import LinearFlow, amplitudes_of, linear_flow, ringing
from physics.integrators.modal.march import MOST_STEPS_PER_SAMPLE, march_modal
from physics.integrators.modal.memory import Stride, memory_for
from physics.kinks import known_kinks
from physics.motion import MotionModel, motion_model
from physics.outcome import Outcome, SimulationFailed
from physics.response import FIRST_CHANGE_LOG, LARGEST_CHANGE_LOG, empty_output, trace_of
from physics.scene import Scene
from physics.statics import equilibrium
from physics.trace import CHAOTIC, Trace

Array = NDArray[np.float64]

LONGEST_LEVEL = 4
# Steps and contact changes a sample that share the error: their pushes add up like noise.
USUAL_PUSHES = 0.3
# Errors are up to this many times what the errors of the steps add up to, or SENSITIVE times what a short pilot made of
# them if that is more: measured on the reference scenes and on scenes of the wide corpus that are not chaotic.
ERROR_FACTOR, SENSITIVE = 3.5, 6.0
# Of the accuracy asked for, what the tolerance aims at before errors are known, and what the estimate then aims at.
AIM, MARGIN = 0.1, 0.75
# A response of more than this sensitivity may be chaotic where the pilots did not look: it is made again with this
# share of the tolerance, and what both are apart tells.
DOUBTFUL, FINER = 4.0, 0.25
PILOT_SAMPLES = 2048
SEED_ATTEMPTS = 3
# First guess of the signal's size: this share of the acceleration that the load would give the outer ring.
GUESSED_SHARE, SMALLEST_SHARE = 1e-2, 1e-8
# No tolerance is below this share of what the load does in a sample: forces are not known better.
ROUND_OFF = 1e-13
# The tolerance of the first pilot over that of the second; weights of the guessed size of the signal, in samples.
COARSE, CERTAIN, UNCERTAIN = 1e-3, 1e9, 512.0
# No further attempt is made after one that has left more than this share of the error.
MOST_ATTEMPTS, WORTHWHILE = 4, 0.5
MEAN_STIFFNESS_TIMES = 64
SMALLEST_STIFFNESS = 1e3


@dataclass(frozen=True)
class Kept:
    """What else a trace keeps besides acceleration and contact changes."""

    state: bool = False
    force: bool = False
    outer: bool = False


@dataclass(frozen=True)
class _Case:
    """What every march of a scene has in common; `push` turns an error of the response into one of a single step."""

    scene: Scene
    flow: LinearFlow
    contact: ContactModel
    stops: Stops
    start: Array
    rate: float

    @cached_property
    def ringing(self) -> float:
        """What a push of 1 N s leaves in the resonator's acceleration, m²/s³ per (N s)²."""
        return ringing(self.flow, self.scene.duration)

    @cached_property
    def amplitudes(self) -> Array:
        """Amplitudes (12,) of the modes at t = 0."""
        return amplitudes_of(self.flow, self.start)

    @property
    def push(self) -> float:
        """Momentum (N s) a step may be wrong by for an error of 1 m/s² (RMS), at the usual number of pushes."""
        return 1.0 / math.sqrt(self.ringing * USUAL_PUSHES * self.rate)

    def pushed(self, output: Output, samples: int) -> float:
        """What the errors of a march's steps add up to in the resonator's acceleration (m/s², RMS of both axes)."""
        return math.sqrt(0.5 * self.ringing * float(output.budget[0]) * self.rate / samples)


def respond_accurately(
    scene: Scene, start: Array, rate: float, samples: int, accuracy: float, least: float, kept: Kept
) -> Trace:
    """Trace of `scene` at k / rate from the state `start` (12,), to the relative RMS `accuracy` with its estimate.

    `least` (m/s², RMS) is an error that is always allowed. Two short pilots say how large the signal is and how much
    this scene makes of the errors of its steps; where that is much, a finer response says it again. Raises
    SimulationFailed if the response stops being finite or contact changes more often than can be logged.
    """
    motion, contact = motion_model(scene), assemble(scene)
    case = _Case(scene, mean_flow(scene, motion), contact, known_kinks(scene, contact), start, rate)
    seen, sensitivity = _pilots(case, samples, accuracy)
    output, grid, error = _to_accuracy(case, samples, accuracy, least, kept, seen, sensitivity)
    if DOUBTFUL < sensitivity <= CHAOTIC:
        finer = _run(case, grid._replace(share=FINER * grid.share, least=FINER * grid.least), kept)
        apart, pushed = rms(output.acceleration - finer.acceleration), case.pushed(output, samples)
        sensitivity = max(sensitivity, apart / pushed if pushed > 0.0 else 0.0)
        output, error = finer, SENSITIVE * sensitivity * case.pushed(finer, samples)
    size = rms(output.acceleration)
    trace = trace_of(scene, contact, Grid(samples, 1, grid.interval), output, MODAL)
    step = (samples - 1) * grid.interval / max(1, int(output.tally[STEPS]))
    # Of a chaotic response no point is known: two such traces are as far apart as two records of the same machine.
    relative = 1.0 if sensitivity > CHAOTIC else error / size if size > 0.0 else 0.0
    return replace(trace, step=step, error_estimate=relative, sensitivity=sensitivity)


def _to_accuracy(
    case: _Case, samples: int, accuracy: float, least: float, kept: Kept, seen: float, sensitivity: float
) -> tuple[Output, Stride, float]:
    """The response with an estimated error (m/s², RMS) within the accuracy, the grid that gave it, and that error."""
    tame = 1.0 if sensitivity > CHAOTIC else max(1.0, SENSITIVE * sensitivity / ERROR_FACTOR)
    aim, error = AIM / tame, math.inf
    for _ in range(MOST_ATTEMPTS):
        spending = 2.0 * USUAL_PUSHES * (MARGIN / (ERROR_FACTOR * tame * aim)) ** 2
        grid = _grid(case, samples, aim * accuracy, aim * least, seen, UNCERTAIN, spending)
        output = _run(case, grid, kept)
        size = rms(output.acceleration)
        before, error = error, ERROR_FACTOR * tame * case.pushed(output, samples)
        if error <= max(accuracy * size, least) or error > WORTHWHILE * before:
            break
        aim *= min(0.5, 0.7 * max(accuracy * size, least) / error)
        seen = size**2
    return output, grid, error


def mean_flow(scene: Scene, motion: MotionModel) -> LinearFlow:
    """Modes of `scene` with the mean of its quasi-static contact stiffness and damping."""
    rest = equilibrium(scene, np.linspace(0.0, scene.duration, MEAN_STIFFNESS_TIMES))
    stiffness, damping = rest.stiffness.mean(axis=0), rest.damping.mean(axis=0)
    kx, ky = (max(float(stiffness[axis]), SMALLEST_STIFFNESS) for axis in range(2))
    return linear_flow(motion, (kx, ky), (float(damping[0]), float(damping[1])))


def rms(values: Array) -> float:
    """Root mean square over all entries."""
    return float(np.sqrt(np.mean(np.square(values))))


def _grid(case: _Case, samples: int, share: float, least: float, seen: float, weight: float, spending: float) -> Stride:
    load = abs(case.scene.operation.load)
    floor = share * SMALLEST_SHARE * load / case.scene.rig.outer_mass
    return Stride(
        samples=samples,
        interval=1.0 / case.rate,
        levels=LONGEST_LEVEL,
        share=share * case.push * math.sqrt(0.5),
        least=max(case.push * max(least, floor), ROUND_OFF * load / case.rate),
        seen=2.0 * seen,
        seen_samples=weight,
        spending=spending,
    )


def _pilots(case: _Case, samples: int, accuracy: float) -> tuple[float, float]:
    """Mean square (m²/s⁴) of the first samples' acceleration, and how many times as far apart two marches of them are
    as the errors of the coarser one's steps add up to."""
    length = min(samples, PILOT_SAMPLES)
    size = GUESSED_SHARE * max(abs(case.scene.operation.load), 1e-3) / case.scene.rig.outer_mass
    for _ in range(SEED_ATTEMPTS):
        coarse = _run(case, _grid(case, length, COARSE, 0.0, size**2, CERTAIN, CERTAIN), Kept())
        found = rms(coarse.acceleration[length // 2 :])
        if found > 0.1 * size:
            size = found
            break
        size = max(found, 1e-3 * size)
    fine = _run(case, _grid(case, length, AIM * min(accuracy, COARSE), 0.0, size**2, CERTAIN, 1.0), Kept())
    pushed = case.pushed(coarse, length)
    apart = rms(coarse.acceleration - fine.acceleration)
    return size**2, apart / pushed if pushed > 0.0 else 1.0


def _run(case: _Case, grid: Stride, kept: Kept) -> Output:
    capacity, status, contact = FIRST_CHANGE_LOG, LOG_FULL, case.contact
    while status == LOG_FULL:
        if capacity > LARGEST_CHANGE_LOG:
            raise SimulationFailed(
                Outcome.TOO_MANY_CHANGES, f"more than {capacity // 8} changes of contact in {case.scene.duration:g} s"
            )
        output = empty_output(contact, grid.samples, capacity, kept.state, kept.force, kept.outer)
        memory = memory_for(case.flow, case.amplitudes, grid, contact.balls.shape[0], contact.balls.shape[2])
        status = march_modal(
            contact.balls, contact.frames, contact.law, contact.track, case.flow, grid, case.stops, memory, output
        )
        capacity *= 8
    if status == OUT_OF_STEPS:
        raise SimulationFailed(
            Outcome.TOO_MANY_STEPS,
            f"more than {MOST_STEPS_PER_SAMPLE} steps a sample of {case.rate:.6g} Hz; a larger accuracy or least_error "
            "takes fewer",
        )
    if status == NOT_FINITE:
        raise SimulationFailed(
            Outcome.NOT_FINITE, f"the response stopped being finite with steps down to {grid.interval / 16:.3g} s"
        )
    return output
