"""The front door: a scene in, its response out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from physics.integrators.methods import METHODS, MODAL, REFERENCE
from physics.integrators.output import Grid
from physics.integrators.propagator import reach
from physics.ladder.models import SIMPLER_MODELS
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.response.adaptive import ACCELERATION_ALONE, respond_accurately
from physics.response.march import MODEL, respond, respond_by_reference
from physics.response.modal_case import Kept
from physics.response.oversampling import oversampling
from physics.response.periodic import respond_until_repeated, worth_repeating
from physics.response.resampling import decimate
from physics.response.stability import require_stable, stable_substeps
from physics.scene import Scene
from physics.statics.load_distribution import carried
from physics.trace import Trace

Array = NDArray[np.float64]

SMALLEST_ACCURACY, LARGEST_ACCURACY = 1e-6, 0.1
STEPS_PER_FAST_PERIOD = 6.2
PILOT_PASSES = 3.0
# A pilot of a scene that turns with the shaft has to see it come round twice.
PILOT_TURNS = 2.2
SHORTEST_PILOT = 2048
MOST_SUBSTEPS = 32
# On a line spall the start of contact, F ~ (t − t0)^n, limits the order to n + 1; with rollers that is 2.1.
PILOT_ORDER = 2.0


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
) -> Trace:
    """Response of `scene` at the instants k / rate (Hz), k = 0 … duration · rate − 1, from its quasi-static position.

    By default the modal method chooses its own steps so that the relative RMS error of the acceleration stays within
    `accuracy`, or the error itself within `least_error` (m/s², RMS) where that is more, and says what error it made;
    where nothing slips, it stops when the response repeats itself from ball to ball (unless more is to be kept, or not
    with `repeat` False).
    Other methods take `substeps` fixed steps a sample (and are meant if they are given); None starts from the fewest
    that resolve the fastest mode and doubles them until a pilot of a few ball passes differs from one at half the step
    by no more than `accuracy`, or 32 are reached; without `estimate_error` there is no pilot and no doubling. A rate
    too low to hold the resonator is simulated at a multiple of it and decimated without aliasing (states and forces
    stay samples). The outer ring's motion kept by `keep_outer` stays at that multiple, which is also large enough for
    what is to follow that motion at up to `fastest_path` (Hz). The reference method has no estimate. A simpler `model`
    (physics.ladder) has neither steps nor an estimate, and keeps states and forces as far as it knows them, asked for
    or not.
    Raises SimulationFailed with a typed outcome.
    """
    method = method or (MODAL if substeps is None else "exponential_rk4")
    _check_request(scene, rate, method, model, substeps, keep_force or keep_outer, accuracy, least_error, fastest_path)
    samples = round(scene.duration * rate)
    if model != MODEL:
        simpler = SIMPLER_MODELS[model]
        factor = oversampling(scene, rate, fastest_path) if simpler.rings else 1
        return _lowered(simpler.respond(scene, rate * factor), rate, factor, samples)
    rest = carried(scene, np.zeros(1))
    start = starting_state(motion_model(scene), rest.displacement[0])
    factor = oversampling(scene, rate, fastest_path)
    if method == REFERENCE:
        trace = respond_by_reference(scene, start, rate * factor, samples * factor, keep_state=keep_state)
        return _lowered(trace, rate, factor, samples)
    if method == MODAL:
        kept = Kept(keep_state, keep_force, keep_outer)
        wanted = (scene, start, rate * factor, samples * factor, accuracy, least_error)
        repeated = repeat and kept == ACCELERATION_ALONE and worth_repeating(scene, samples / rate, accuracy)
        trace = respond_until_repeated(*wanted) if repeated else respond_accurately(*wanted, kept)
        return _lowered(trace, rate, factor, samples)
    steps, error = substeps or default_substeps(scene, rate * factor), math.nan
    least = stable_substeps(scene, METHODS[method], rest, rate * factor)
    if substeps is None:
        steps = max(steps, least)
    require_stable(METHODS[method], rate * factor, steps, least)
    if estimate_error:
        most = steps if substeps else max(MOST_SUBSTEPS, steps)
        steps, error = _pilot(scene, start, rate * factor, method, steps, most, accuracy)
    grid = Grid(samples * factor, steps, 1.0 / (rate * factor * steps))
    trace = respond(scene, start, grid, method, keep_state=keep_state, keep_force=keep_force, keep_outer=keep_outer)
    return replace(_lowered(trace, rate, factor, samples), error_estimate=error)


def default_substeps(scene: Scene, rate: float) -> int:
    """Fewest steps a sample that give the fastest linear mode about six steps a period."""
    per_step = reach(motion_model(scene), 1.0 / rate)
    return max(1, math.ceil(per_step * STEPS_PER_FAST_PERIOD / (2.0 * math.pi)))


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


def _pilot(
    scene: Scene, start: Array, rate: float, method: str, steps: int, most: int, accuracy: float
) -> tuple[int, float]:
    """Steps a sample (up to `most`) that meet `accuracy` over the scene's first passes, and their estimated error."""
    samples = min(round(scene.duration * rate), max(SHORTEST_PILOT, math.ceil(_pilot_duration(scene) * rate)))

    def response(steps: int) -> Array:
        return respond(scene, start, Grid(samples, steps, 1.0 / (rate * steps)), method).acceleration

    coarse, fine = response(steps), response(2 * steps)
    error = _relative_error(coarse, fine)
    while error > accuracy and 2 * steps <= most:
        steps *= 2
        coarse, fine = fine, response(2 * steps)
        error = _relative_error(coarse, fine)
    return steps, error


def _pilot_duration(scene: Scene) -> float:
    passes = PILOT_PASSES * scene.rig.bearing.spacing / scene.cage.mean_speed
    turns = PILOT_TURNS * 2.0 * math.pi / scene.operation.shaft_speed
    run = scene.operation
    turning = scene.defective_race == "inner" or run.unbalance_force > 0.0 or run.load_fluctuation > 0.0
    return max(passes, turns) if turning else passes


def _relative_error(coarse: Array, fine: Array) -> float:
    """Estimated RMS error of `coarse`, relative to its RMS, from a response at half the step."""
    size = np.sqrt(np.mean(fine**2))
    if size == 0.0:
        return 0.0
    return float(np.sqrt(np.mean((coarse - fine) ** 2)) / size / (1.0 - 2.0**-PILOT_ORDER))


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
