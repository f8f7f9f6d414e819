"""The front door: a scene in, its response out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from physics.freed_memory import keep_freed_memory
from physics.integrators.methods import METHODS, MODAL, REFERENCE
from physics.ladder.models import SIMPLER_MODELS
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.response.adaptive import ACCELERATION_ALONE, respond_accurately
from physics.response.fixed_steps import respond_by_fixed_steps
from physics.response.lead_in import from_start, respond_behind, started_earlier, starting_at
from physics.response.march import MODEL, respond_by_reference
from physics.response.modal_case import Kept, resting
from physics.response.oversampling import oversampling
from physics.response.periodic import respond_until_repeated, worth_repeating
from physics.response.resampling import decimate
from physics.scene import Scene
from physics.statics.load_distribution import carried
from physics.trace import Trace

Array = NDArray[np.float64]

SMALLEST_ACCURACY, LARGEST_ACCURACY = 1e-6, 0.1


def simulate(
    scene: Scene,
    rate: float,
    *,
    method: str | None = None,
    model: str = MODEL,
    substeps: int | None = None,
    accuracy: float = 1e-3,
    least_error: float = 0.0,
    keep_state: bool = False,
    keep_force: bool = False,
    keep_outer: bool = False,
    fastest_path: float = 0.0,
    estimate_error: bool = True,
    repeat: bool = True,
    lead_in: float = 0.0,
    keep_lead_in: bool = False,
) -> Trace:
    """Response of `scene` at the instants k / rate (Hz), k = 0 … duration · rate − 1, from its quasi-static position.

    That is its position at t = 0, at rest, or `lead_in` seconds before (rounded to whole samples), so that a machine
    that runs is recorded and not its start; `keep_lead_in` gives the instants before 0 as well. Accuracy and error
    estimate of the modal method are of what comes from t = 0 on.

    By default the modal method chooses its own steps so that the relative RMS error of the acceleration stays within
    `accuracy`, or the error itself within `least_error` (m/s², RMS) where that is more, and says what error it made:
    an `error_estimate` above that says that it was not reached, as where edges are narrower than the shortest step, or
    that the response is chaotic. Where nothing slips, it stops when the response repeats itself from ball to ball
    (unless more is to be kept, or not with `repeat` False).
    Other methods take `substeps` fixed steps a sample (and are meant if they are given); None starts from the fewest
    that resolve the fastest mode and doubles them, up to 32, until a pilot of a few ball passes differs from one at
    half the step by no more than `accuracy`; without `estimate_error` there is no pilot and no doubling. A rate
    too low to hold the resonator is simulated at a multiple of it and decimated without aliasing (states and forces
    stay samples). The outer ring's motion kept by `keep_outer` stays at that multiple, which is also large enough for
    what is to follow that motion at up to `fastest_path` (Hz). The reference method has no estimate. A simpler `model`
    (physics.ladder) has neither steps nor an estimate, and keeps states and forces as far as it knows them, asked for
    or not.
    Raises SimulationFailed with a typed outcome.
    """
    keep_freed_memory()
    method = method or (MODAL if substeps is None else "exponential_rk4")
    _check_request(scene, rate, method, model, substeps, keep_force or keep_outer, accuracy, least_error, fastest_path)
    _check_lead_in(scene, lead_in, rate)
    kept = Kept(keep_state, keep_force, keep_outer)

    def respond(scene: Scene, accuracy: float) -> Trace:
        if model != MODEL:
            return _respond_simply(scene, rate, model, fastest_path)
        if method == MODAL:
            wanted = max(accuracy, SMALLEST_ACCURACY)
            return _respond_modally(scene, rate, wanted, least_error, kept, fastest_path, repeat)
        return _respond_by_steps(
            scene, rate, method, substeps, accuracy if estimate_error else None, kept, fastest_path
        )

    before = round(lead_in * rate)
    if before == 0:
        return respond(scene, accuracy)
    earlier = started_earlier(scene, before / rate)
    if model == MODEL and method == MODAL:
        trace = respond_behind(lambda asked: respond(earlier, asked), before, accuracy, least_error)
    else:
        trace = respond(earlier, accuracy)
    trace = starting_at(trace, before)
    return trace if keep_lead_in else from_start(trace)


def _respond_simply(scene: Scene, rate: float, model: str, fastest_path: float) -> Trace:
    """By a model of physics.ladder."""
    simpler = SIMPLER_MODELS[model]
    factor = oversampling(scene, rate, fastest_path) if simpler.rings else 1
    return _lowered(simpler.respond(scene, rate * factor), rate, factor, _samples(scene, rate))


def _respond_modally(
    scene: Scene, rate: float, accuracy: float, least_error: float, kept: Kept, fastest_path: float, repeat: bool
) -> Trace:
    """By steps that the modal method chooses."""
    rest, factor, samples = resting(scene), oversampling(scene, rate, fastest_path), _samples(scene, rate)
    wanted = (scene, rest, rate * factor, samples * factor, accuracy, least_error)
    repeated = repeat and kept == ACCELERATION_ALONE and worth_repeating(scene, samples / rate, accuracy)
    trace = respond_until_repeated(*wanted) if repeated else respond_accurately(*wanted, kept)
    return _lowered(trace, rate, factor, samples)


def _respond_by_steps(
    scene: Scene,
    rate: float,
    method: str,
    substeps: int | None,
    accuracy: float | None,
    kept: Kept,
    fastest_path: float,
) -> Trace:
    """By fixed steps, or by the slow reference method."""
    rest, factor, samples = carried(scene, np.zeros(1)), oversampling(scene, rate, fastest_path), _samples(scene, rate)
    if method == REFERENCE:
        start = starting_state(motion_model(scene), rest.displacement[0])
        trace = respond_by_reference(scene, start, rate * factor, samples * factor, keep_state=kept.state)
    else:
        trace = respond_by_fixed_steps(scene, rest, rate * factor, samples * factor, method, substeps, accuracy, kept)
    return _lowered(trace, rate, factor, samples)


def _samples(scene: Scene, rate: float) -> int:
    return round(scene.duration * rate)


def _check_request(
    scene: Scene,
    rate: float,
    method: str,
    model: str,
    substeps: int | None,
    keeps: bool,
    accuracy: float,
    least_error: float,
    fastest_path: float,
) -> None:
    problem = ""
    if method not in METHODS:
        problem = f'method = "{method}"; allowed: {", ".join(METHODS)}'
    elif model != MODEL and model not in SIMPLER_MODELS:
        problem = f'model = "{model}"; allowed: {", ".join((*SIMPLER_MODELS, MODEL))}'
    elif not (math.isfinite(rate) and rate > 0.0):
        problem = f"rate = {rate!r} Hz; it must be above 0"
    elif round(scene.duration * rate) < 1:
        problem = f"a duration of {scene.duration:g} s holds no sample at {rate:g} Hz"
    elif substeps is not None and (not float(substeps).is_integer() or substeps < 1):
        problem = f"substeps = {substeps!r}; it must be a whole number, 1 or more"
    elif method == MODAL and substeps is not None:
        problem = f"substeps = {substeps!r}; the method {MODAL} chooses its own steps, give accuracy instead"
    elif not SMALLEST_ACCURACY <= accuracy <= LARGEST_ACCURACY:
        problem = f"accuracy = {accuracy!r}; it must lie from {SMALLEST_ACCURACY:g} to {LARGEST_ACCURACY:g}"
    elif not 0.0 <= least_error < math.inf:
        problem = f"least_error = {least_error!r} m/s²; it must be 0 or more, and finite"
    elif not 0.0 <= fastest_path < math.inf:
        problem = f"fastest_path = {fastest_path!r} Hz; it must be 0 or more, and finite"
    elif method == REFERENCE and keeps:
        problem = "keep_force or keep_outer = True; the reference method keeps no forces"
    if problem:
        raise SimulationFailed(Outcome.BAD_REQUEST, problem)


def _check_lead_in(scene: Scene, lead_in: float, rate: float) -> None:
    known_from = max((cage.knot_start for cage in scene.cages if cage.knot_values), default=-math.inf)
    if not 0.0 <= lead_in < math.inf:
        problem = f"lead_in = {lead_in!r} s; it must be 0 or more, and finite"
        raise SimulationFailed(Outcome.BAD_REQUEST, problem)
    if -round(lead_in * rate) / rate < known_from:
        problem = f"lead_in = {lead_in!r} s; the cage's slip is known from {known_from:g} s on"
        raise SimulationFailed(Outcome.BAD_REQUEST, problem)


def _lowered(trace: Trace, rate: float, factor: int, samples: int) -> Trace:
    """The first `samples` of a trace at `rate`, a `factor` below the one it was marched at."""
    time = np.arange(samples) / rate
    raised = rate * factor
    if factor == 1:
        return replace(trace, rate=rate, time=time, outer_rate=raised)
    return replace(
        trace,
        rate=rate,
        time=time,
        outer_rate=raised,
        acceleration=decimate(trace.acceleration, factor)[:samples],
        state=None if trace.state is None else trace.state[::factor][:samples],
        contact_force=None if trace.contact_force is None else trace.contact_force[::factor][:samples],
    )
