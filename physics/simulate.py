"""The front door: a scene in, its response out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from physics.freed_memory import keep_freed_memory
from physics.integrators.methods import MODAL, REFERENCE
from physics.ladder.models import SIMPLER_MODELS
from physics.motion import motion_model, starting_state
from physics.request import SMALLEST_ACCURACY, Request
from physics.response.adaptive import respond_accurately
from physics.response.fixed_steps import respond_by_fixed_steps
from physics.response.lead_in import from_start, respond_behind, started_earlier, starting_at
from physics.response.march import MODEL, respond_by_reference
from physics.response.modal_case import resting
from physics.response.oversampling import oversampling
from physics.response.periodic import METHOD as REPEATED
from physics.response.periodic import respond_until_repeated, worth_repeating
from physics.response.resampling import decimate
from physics.rms import rms
from physics.scene import Scene
from physics.statics.load_distribution import carried
from physics.trace import ACCELERATION_ALONE, Kept, Trace

# A response that is repeated must keep this share of its RMS where its rate is lowered.
LEAST_LEFT = 0.5


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

    By default the modal method chooses its own steps and says what error it made: an `error_estimate` above the
    `accuracy` says that it was not reached, as where edges are narrower than the shortest step, or that the response is
    chaotic. A rate too low to hold the resonator is simulated at a multiple of it and decimated without aliasing
    (states and forces stay samples).

    `method`: None is the modal one, or exponential_rk4 where `substeps` are given; a name of METHODS.
    `model`: a simpler one of physics.ladder has neither method, steps nor an estimate, and keeps states and forces as
        far as it knows them, asked for or not.
    `substeps`: fixed steps a sample, not of the modal method. None starts from the fewest that resolve the fastest mode
        and doubles them, up to 32, until the response differs from one at half the step by no more than `accuracy`.
    `accuracy`: relative RMS error of the acceleration that is allowed, 1e-6 to 0.1.
    `least_error` (m/s², RMS): an error that is always allowed.
    `keep_state`: displacements and velocities too.
    `keep_force`: the normal force of every ball too; not of the reference method.
    `keep_outer`: the outer ring's motion too, at the multiple of the rate; not of the reference method.
    `fastest_path` (Hz): that multiple is also large enough for what is to follow the outer ring at up to this.
    `estimate_error`: False spares methods with fixed steps the response at half the step, and so the doubling; the
        reference has none.
    `repeat`: whether the modal method, where nothing slips and the acceleration alone is kept, stops when the response
        repeats itself from ball to ball.
    `lead_in` (s): the machine starts so long before t = 0, rounded to whole samples, so that one that runs is recorded
        and not its start; accuracy and error estimate of the modal method are of what comes from t = 0 on.
    `keep_lead_in`: gives the instants before 0 too.

    Raises SimulationFailed with a typed outcome.
    """
    keep_freed_memory()
    wanted = Request(
        rate=rate,
        model=model,
        method=method,
        substeps=substeps,
        accuracy=accuracy,
        least_error=least_error,
        kept=Kept(keep_state, keep_force, keep_outer),
        fastest_path=fastest_path,
        estimate_error=estimate_error,
        repeat=repeat,
        lead_in=lead_in,
    )
    wanted.check(scene)
    before = wanted.before
    if before == 0:
        return _respond(scene, wanted)
    earlier = started_earlier(scene, before / rate)
    if model == MODEL and wanted.solver == MODAL:

        def respond(asked: float) -> Trace:
            return _respond(earlier, replace(wanted, accuracy=max(asked, SMALLEST_ACCURACY)))

        trace = respond_behind(respond, before, accuracy, least_error)
    else:
        trace = _respond(earlier, wanted)
    trace = starting_at(trace, before)
    return trace if keep_lead_in else from_start(trace)


def _respond(scene: Scene, wanted: Request) -> Trace:
    """The response from t = 0 on, without a lead-in."""
    if wanted.model != MODEL:
        return _respond_simply(scene, wanted)
    return _respond_modally(scene, wanted) if wanted.solver == MODAL else _respond_by_steps(scene, wanted)


def _respond_simply(scene: Scene, wanted: Request) -> Trace:
    """By a model of physics.ladder."""
    simpler = SIMPLER_MODELS[wanted.model]
    factor = oversampling(scene, wanted.rate, wanted.fastest_path) if simpler.rings else 1
    return _lowered(simpler.respond(scene, wanted.rate * factor), wanted.rate, factor, wanted.samples(scene))


def _respond_modally(scene: Scene, wanted: Request) -> Trace:
    """By steps that the modal method chooses."""
    rate, samples, accuracy = wanted.rate, wanted.samples(scene), wanted.accuracy
    rest, factor = resting(scene), oversampling(scene, rate, wanted.fastest_path)
    asked = (scene, rest, rate * factor, samples * factor, accuracy, wanted.least_error)
    alone = wanted.kept == ACCELERATION_ALONE
    repeated = wanted.repeat and alone and worth_repeating(scene, samples / rate, accuracy)
    trace = respond_until_repeated(*asked) if repeated else respond_accurately(*asked, wanted.kept)
    lowered = _lowered(trace, rate, factor, samples)
    if trace.method == REPEATED and rms(lowered.acceleration) < LEAST_LEFT * rms(trace.acceleration):
        # What repeating leaves out lies at low frequencies, where hardly anything of the signal is.
        lowered = _lowered(respond_accurately(*asked, wanted.kept), rate, factor, samples)
    return lowered


def _respond_by_steps(scene: Scene, wanted: Request) -> Trace:
    """By fixed steps, or by the slow reference method."""
    rate, samples, kept = wanted.rate, wanted.samples(scene), wanted.kept
    rest, factor = carried(scene, np.zeros(1)), oversampling(scene, rate, wanted.fastest_path)
    if wanted.solver == REFERENCE:
        start = starting_state(motion_model(scene), rest.displacement[0])
        trace = respond_by_reference(scene, start, rate * factor, samples * factor, keep_state=kept.state)
    else:
        accuracy = wanted.accuracy if wanted.estimate_error else None
        trace = respond_by_fixed_steps(
            scene, rest, rate * factor, samples * factor, wanted.solver, wanted.substeps, accuracy, kept
        )
    return _lowered(trace, rate, factor, samples)


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
