"""The front door: a scene in, its response out."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from physics.freed_memory import keep_freed_memory
from physics.integrators.methods import METHODS, MODAL, REFERENCE
from physics.ladder.models import SIMPLER_MODELS
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
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

SMALLEST_ACCURACY, LARGEST_ACCURACY = 1e-6, 0.1
GIVEN_STEPS = "exponential_rk4"
# A response that is repeated must keep this share of its RMS where its rate is lowered.
LEAST_LEFT = 0.5


@dataclass(frozen=True)
class Request:
    """How a response is wanted: the arguments of `simulate`, which explains them, with what to keep in one."""

    rate: float
    model: str
    method: str | None
    substeps: int | None
    accuracy: float
    least_error: float
    kept: Kept
    fastest_path: float
    estimate_error: bool
    repeat: bool
    lead_in: float

    @property
    def solver(self) -> str:
        """The method that is meant."""
        return self.method or (MODAL if self.substeps is None else GIVEN_STEPS)

    @property
    def before(self) -> int:
        """Samples of the lead-in."""
        return round(self.lead_in * self.rate)

    def samples(self, scene: Scene) -> int:
        """How many instants of `scene` are asked for."""
        return round(scene.duration * self.rate)

    def check(self, scene: Scene) -> None:
        """Raise SimulationFailed with BAD_REQUEST, the argument and its value if `scene` cannot be simulated so."""
        problem = self._problem_of_model() or self._problem_of_numbers() or self._problem_of_time(scene)
        if problem:
            raise SimulationFailed(Outcome.BAD_REQUEST, problem)

    def _problem_of_model(self) -> str:
        if self.solver not in METHODS:
            return f'method = "{self.method}"; allowed: {", ".join(METHODS)}'
        if self.model != MODEL and self.model not in SIMPLER_MODELS:
            return f'model = "{self.model}"; allowed: {", ".join((*SIMPLER_MODELS, MODEL))}'
        if self.model != MODEL and self.method is not None:
            return f'method = "{self.method}"; the model "{self.model}" has its own and takes none'
        if self.model != MODEL and self.substeps is not None:
            return f'substeps = {self.substeps!r}; the model "{self.model}" takes no number of steps'
        if self.solver == REFERENCE and (self.kept.force or self.kept.outer):
            return "keep_force or keep_outer = True; the reference method keeps no forces"
        return ""

    def _problem_of_numbers(self) -> str:
        if not (math.isfinite(self.rate) and self.rate > 0.0):
            return f"rate = {self.rate!r} Hz; it must be above 0"
        if self.substeps is not None and (not float(self.substeps).is_integer() or self.substeps < 1):
            return f"substeps = {self.substeps!r}; it must be a whole number, 1 or more"
        if self.solver == MODAL and self.substeps is not None:
            return f"substeps = {self.substeps!r}; the method {MODAL} chooses its own steps, give accuracy instead"
        if not SMALLEST_ACCURACY <= self.accuracy <= LARGEST_ACCURACY:
            return f"accuracy = {self.accuracy!r}; it must lie from {SMALLEST_ACCURACY:g} to {LARGEST_ACCURACY:g}"
        if not 0.0 <= self.least_error < math.inf:
            return f"least_error = {self.least_error!r} m/s²; it must be 0 or more, and finite"
        if not 0.0 <= self.fastest_path < math.inf:
            return f"fastest_path = {self.fastest_path!r} Hz; it must be 0 or more, and finite"
        return ""

    def _problem_of_time(self, scene: Scene) -> str:
        if self.samples(scene) < 1:
            return f"a duration of {scene.duration:g} s holds no sample at {self.rate:g} Hz"
        if not 0.0 <= self.lead_in < math.inf:
            return f"lead_in = {self.lead_in!r} s; it must be 0 or more, and finite"
        known_from = max((cage.knot_start for cage in scene.cages if cage.knot_values), default=-math.inf)
        if -self.before / self.rate < known_from:
            return f"lead_in = {self.lead_in!r} s; the cage's slip is known from {known_from:g} s on"
        return ""


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
        and doubles them, up to 32, until a pilot of a few ball passes differs from one at half the step by no more than
        `accuracy`.
    `accuracy`: relative RMS error of the acceleration that is allowed, 1e-6 to 0.1.
    `least_error` (m/s², RMS): an error that is always allowed.
    `keep_state`: displacements and velocities too.
    `keep_force`: the normal force of every ball too; not of the reference method.
    `keep_outer`: the outer ring's motion too, at the multiple of the rate; not of the reference method.
    `fastest_path` (Hz): that multiple is also large enough for what is to follow the outer ring at up to this.
    `estimate_error`: False spares methods with fixed steps the pilot, and so the doubling; the reference has none.
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
        trace = respond_behind(
            lambda asked: _respond(earlier, replace(wanted, accuracy=asked)), before, accuracy, least_error
        )
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
    rate, samples, accuracy = wanted.rate, wanted.samples(scene), max(wanted.accuracy, SMALLEST_ACCURACY)
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
