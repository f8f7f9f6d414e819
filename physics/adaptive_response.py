"""A response to a stated accuracy: the modal method with the tolerance that the scene's own size asks for.

The method measures every step by the momentum it may be wrong by. What such a push leaves in the resonator's
acceleration follows from the modes alone, so the accuracy asked for, the size of the signal seen so far and a usual
number of pushes a second give the tolerance; and the sum of the errors made gives the estimate of the whole.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from physics.assembly import assemble
from physics.contact import ContactModel
from physics.integrators.march import LOG_FULL, NOT_FINITE, STEPS, Grid, Output, Stops
from physics.integrators.methods import MODAL
from physics.integrators.modal.flow import LinearFlow, amplitudes, linear_flow, ringing
from physics.integrators.modal.memory import Stride, memory_for
from physics.integrators.modal.rk4 import march_modal_rk4
from physics.kinks import known_kinks
from physics.motion import MotionModel, motion_model
from physics.outcome import Outcome, SimulationFailed
from physics.response import FIRST_CHANGE_LOG, LARGEST_CHANGE_LOG, empty_output, trace_of
from physics.scene import Scene
from physics.statics import equilibrium
from physics.trace import Trace

Array = NDArray[np.float64]

LONGEST_LEVEL = 3
# Steps and contact changes a sample that share the error: their pushes add up like noise.
USUAL_PUSHES = 0.3
# Errors are this many times what the pushes alone add up to: 2 to 8 times on the reference scenes, at worst 20 times on
# scenes of the wide corpus that are not chaotic.
ERROR_FACTOR = 8.0
# Of the accuracy asked for, what the tolerance aims at.
AIM = 0.0625
SEED_SAMPLES = 2048
SEED_ATTEMPTS = 3
# First guess of the signal's size: this share of the acceleration that the load would give the outer ring.
GUESSED_SHARE, SMALLEST_SHARE = 1e-2, 1e-8
MOST_ATTEMPTS = 4
MEAN_STIFFNESS_TIMES = 64
SMALLEST_STIFFNESS = 1e3


@dataclass(frozen=True)
class Kept:
    """What else a trace keeps besides acceleration and contact changes."""

    state: bool = False
    force: bool = False
    outer: bool = False


def respond_accurately(
    scene: Scene, start: Array, rate: float, samples: int, accuracy: float, least: float, kept: Kept
) -> Trace:
    """Trace of `scene` at k / rate from the state `start` (12,), to the relative RMS `accuracy` with its estimate.

    `least` (m/s², RMS) is an error that is always allowed. Raises SimulationFailed if the response stops being finite
    or contact changes more often than can be logged.
    """
    motion = motion_model(scene)
    flow, contact = mean_flow(scene, motion), assemble(scene)
    stops = known_kinks(scene, contact)
    push = 1.0 / math.sqrt(ringing(flow) * USUAL_PUSHES * rate)
    seen = _seed(scene, start, flow, contact, stops, rate, samples, push)
    aim = AIM
    for _ in range(MOST_ATTEMPTS):
        grid = _grid(scene, rate, samples, aim * accuracy * push, aim * least * push, seen)
        trace, output = _run(scene, flow, contact, stops, start, grid, kept)
        size = rms(trace.acceleration)
        pushed = ERROR_FACTOR * math.sqrt(0.5 * ringing(flow) * output.budget[0] / (samples / rate))
        if pushed <= max(accuracy * size, least):
            break
        aim *= min(0.5, 0.7 * max(accuracy * size, least) / pushed)
        seen = size**2
    return replace(trace, error_estimate=pushed / size if size > 0.0 else 0.0)


def mean_flow(scene: Scene, motion: MotionModel) -> LinearFlow:
    """Modes of `scene` with the mean of its quasi-static contact stiffness and damping."""
    rest = equilibrium(scene, np.linspace(0.0, scene.duration, MEAN_STIFFNESS_TIMES))
    stiffness, damping = rest.stiffness.mean(axis=0), rest.damping.mean(axis=0)
    kx, ky = (max(float(stiffness[axis]), SMALLEST_STIFFNESS) for axis in range(2))
    return linear_flow(motion, (kx, ky), (float(damping[0]), float(damping[1])))


def rms(values: Array) -> float:
    """Root mean square over all entries."""
    return float(np.sqrt(np.mean(np.square(values))))


def _grid(
    scene: Scene, rate: float, samples: int, share: float, least: float, seen: float, weight: float = 512.0
) -> Stride:
    floor = share * SMALLEST_SHARE * abs(scene.operation.load) / scene.rig.outer_mass
    return Stride(
        samples=samples,
        interval=1.0 / rate,
        levels=LONGEST_LEVEL,
        share=share * math.sqrt(0.5),
        least=max(least, floor),
        seen=2.0 * seen,
        seen_samples=weight,
    )


def _seed(
    scene: Scene,
    start: Array,
    flow: LinearFlow,
    contact: ContactModel,
    stops: Stops,
    rate: float,
    samples: int,
    push: float,
) -> float:
    """Mean square (m²/s⁴) of the first samples' acceleration, from a run that is accurate enough for that."""
    size = GUESSED_SHARE * max(abs(scene.operation.load), 1e-3) / scene.rig.outer_mass
    for _ in range(SEED_ATTEMPTS):
        grid = _grid(scene, rate, min(samples, SEED_SAMPLES), 1e-3 * push, 0.0, size**2, 1e9)
        trace, _ = _run(scene, flow, contact, stops, start, grid, Kept())
        found = rms(trace.acceleration[trace.time.size // 2 :])
        if found > 0.1 * size:
            return found**2
        size = max(found, 1e-3 * size)
    return size**2


def _run(
    scene: Scene,
    flow: LinearFlow,
    contact: ContactModel,
    stops: Stops,
    start: Array,
    grid: Stride,
    kept: Kept,
) -> tuple[Trace, Output]:
    capacity, status = FIRST_CHANGE_LOG, LOG_FULL
    while status == LOG_FULL:
        if capacity > LARGEST_CHANGE_LOG:
            raise SimulationFailed(
                Outcome.TOO_MANY_CHANGES, f"more than {capacity // 8} changes of contact in {scene.duration:g} s"
            )
        output = empty_output(contact, grid.samples, capacity, kept.state, kept.force, kept.outer)
        memory = memory_for(flow, amplitudes(flow, start), grid, contact.balls.shape[0], contact.balls.shape[2])
        status = march_modal_rk4(
            contact.balls, contact.frames, contact.law, contact.track, flow, grid, stops, memory, output
        )
        capacity *= 8
    if status == NOT_FINITE:
        raise SimulationFailed(
            Outcome.NOT_FINITE, f"the response stopped being finite with steps down to {grid.interval / 16:.3g} s"
        )
    trace = trace_of(scene, contact, Grid(grid.samples, 1, grid.interval), output, MODAL)
    steps = max(1, int(output.tally[STEPS]))
    return replace(trace, step=(grid.samples - 1) * grid.interval / steps), output
