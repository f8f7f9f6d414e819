"""The front door: a scene in, its response out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from physics.checks import require, require_positive
from physics.integrators.modal.error_growth import share_below
from physics.ladder.model_table import SIMPLER_MODELS
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.request import Accurate, FixedSteps, HalvedSteps, LeadIn, Reference, Simpler, Solution
from physics.response.adaptive import respond_accurately
from physics.response.asked import Asked
from physics.response.finer_paths import FINE_ACCURACY, respond_on_finer_paths
from physics.response.fixed_steps import Stepping
from physics.response.lead_in import from_start, respond_behind, started_earlier, starting_at
from physics.response.lowered import respond_lowered
from physics.response.modal_case import mean_flow
from physics.response.oversampling import oversampling
from physics.response.periodic import REPEATED, respond_until_repeated, worth_repeating
from physics.response.resampling import HALF_LENGTH_SAMPLES, decimate
from physics.response.silence import silence
from physics.response.single_march import respond_by_reference
from physics.rms import rms
from physics.scene import Scene
from physics.statics.load_distribution import resting
from physics.trace import ACCELERATION_ALONE, KEEPABLE, Kept, Trace

# A response that is repeated must keep this share of its RMS where its rate is lowered.
LEAST_LEFT = 0.5
TO_USUAL_ACCURACY, NO_LEAD_IN = Accurate(), LeadIn()


def simulate(
    scene: Scene,
    rate: float,
    solution: Solution = TO_USUAL_ACCURACY,
    *,
    keep: Kept = ACCELERATION_ALONE,
    lead_in: LeadIn = NO_LEAD_IN,
) -> Trace:
    """Response of `scene` at the instants k / rate (Hz), k = 0 … duration · rate − 1, from its quasi-static position.

    `solution` says by what model, method and steps, `keep` what the trace has besides acceleration and contact changes,
    and `lead_in` how long before t = 0 the machine starts. A rate too low to hold the resonator is simulated at a
    multiple of it and decimated without aliasing (states and forces stay samples).

    Raises InvalidParameter unless the rate is above 0 and the solution can keep what `keep` asks for; SimulationFailed,
    with a typed outcome, if no response comes of this scene.
    """
    require_positive("rate", rate, "Hz")
    for what in KEEPABLE:
        problem = f"keep.{what} = True; {solution} keeps {' and '.join(solution.keeps) or 'the acceleration'} alone"
        require(what in solution.keeps or not getattr(keep, what), problem, "keep")
    _require_known_time(scene, rate, lead_in.samples(rate))
    rounding = silence(scene)
    if isinstance(solution, Accurate):
        solution = replace(solution, least_error=max(solution.least_error, rounding))
    if isinstance(solution, Accurate) and _needs_finer_paths(scene, solution):
        usual = solution

        def respond(fineness: int) -> Trace:
            return _respond_behind(scene, rate, replace(usual, path_fineness=fineness), keep, lead_in)

        trace = respond_on_finer_paths(respond, solution.accuracy, solution.least_error)
    else:
        trace = _respond_behind(scene, rate, solution, keep, lead_in)
    if not 0.0 < rms(trace.acceleration) <= rounding:
        return trace
    return replace(trace, silent=True, chaotic=False, error_estimate=min(trace.error_estimate, 1.0))


def _needs_finer_paths(scene: Scene, solution: Accurate) -> bool:
    """Whether the usual paths over spalls may leave more than the accuracy."""
    return bool(scene.spalls) and solution.accuracy < FINE_ACCURACY and solution.path_fineness is None


def _respond_behind(scene: Scene, rate: float, solution: Solution, keep: Kept, lead_in: LeadIn) -> Trace:
    """The response behind a lead-in, if there is one, and of that if it is kept."""
    before = lead_in.samples(rate)
    if before == 0:
        return _respond(scene, rate, solution, keep)
    trace = _respond_to_lead_in(scene, rate, solution, keep, before)
    return trace if lead_in.kept else from_start(trace)


def _respond_to_lead_in(scene: Scene, rate: float, solution: Solution, keep: Kept, before: int) -> Trace:
    """The response from `before` samples before t = 0 on."""
    earlier = started_earlier(scene, before / rate)
    if isinstance(solution, Accurate):

        def respond(asked: float) -> Trace:
            return _respond(earlier, rate, replace(solution, accuracy=asked), keep)

        trace = respond_behind(respond, before, solution.accuracy, solution.least_error)
    else:
        trace = _respond(earlier, rate, solution, keep)
    return starting_at(trace, before)


def _require_known_time(scene: Scene, rate: float, before: int) -> None:
    """Raise SimulationFailed unless `scene` lasts a sample of `rate` (Hz) and its slip is known `before` samples."""
    if scene.samples(rate) < 1:
        raise SimulationFailed(
            Outcome.BAD_REQUEST, f"a duration of {scene.duration:g} s holds no sample at {rate:g} Hz"
        )
    known_from = max((cage.knot_start for cage in scene.cages if cage.knot_values), default=-math.inf)
    if -before / rate < known_from:
        raise SimulationFailed(
            Outcome.BAD_REQUEST,
            f"a lead-in of {before / rate:.4g} s; the cage's slip is known from {known_from:g} s on",
        )


def _respond(scene: Scene, rate: float, solution: Solution, keep: Kept) -> Trace:
    """The response from t = 0 on, without a lead-in."""
    if isinstance(solution, Simpler):
        return _respond_simply(scene, rate, solution, keep)
    if isinstance(solution, Accurate):
        return _respond_accurately(scene, rate, solution, keep)
    return _respond_by_steps(scene, rate, solution, keep)


def _respond_simply(scene: Scene, rate: float, solution: Simpler, keep: Kept) -> Trace:
    """By a model of physics.ladder."""
    simpler = SIMPLER_MODELS[solution.model]
    factor = oversampling(scene, rate) if simpler.rings else 1
    longer, _ = _looking_ahead(scene, rate, factor)
    return _lowered(simpler.respond(longer, rate * factor, keep), rate, factor, scene.samples(rate))


def _respond_accurately(scene: Scene, rate: float, solution: Accurate, keep: Kept) -> Trace:
    """By steps that the modal method chooses."""
    samples, accuracy = scene.samples(rate), solution.accuracy
    rest, factor = resting(scene), oversampling(scene, rate, keep.fastest_path)
    longer, marched = _looking_ahead(scene, rate, factor)
    alone = keep == ACCELERATION_ALONE
    repeated = solution.repeat and alone and worth_repeating(scene, samples / rate, accuracy)

    def respond(sought: float) -> tuple[Trace, float]:
        asked = Asked(longer, rest, rate * factor, marched, sought, solution.least_error, solution.path_fineness or 1)
        trace = respond_until_repeated(asked) if repeated else respond_accurately(asked, keep)
        lowered, size = _lowered(trace, rate, factor, samples), rms(trace.acceleration)
        if trace.method == REPEATED and rms(lowered.acceleration) < LEAST_LEFT * size:
            # What repeating leaves out lies at low frequencies, where hardly anything of the signal is.
            trace = respond_accurately(asked, keep)
            lowered, size = _lowered(trace, rate, factor, samples), rms(trace.acceleration)
        return lowered, size

    if factor == 1:
        return respond(accuracy)[0]
    share = share_below(mean_flow(motion_model(longer), rest), scene.duration, rate / 2.0)
    return respond_lowered(respond, share, accuracy, solution.least_error)


def _respond_by_steps(scene: Scene, rate: float, solution: FixedSteps | HalvedSteps | Reference, keep: Kept) -> Trace:
    """By fixed steps, or by the slow reference method."""
    samples = scene.samples(rate)
    rest, factor = resting(scene), oversampling(scene, rate, keep.fastest_path)
    longer, marched = _looking_ahead(scene, rate, factor)
    if isinstance(solution, Reference):
        start = starting_state(motion_model(scene), rest.displacement[0])
        trace = respond_by_reference(longer, start, rate * factor, marched, keep_state=keep.state)
    else:
        stepping = Stepping(longer, rest, rate * factor, marched, solution.method, keep)
        if isinstance(solution, HalvedSteps):
            trace = stepping.halved_until(solution.accuracy)
        else:
            steps = solution.substeps or stepping.fewest
            trace = stepping.judged(steps) if solution.estimate_error else stepping.once(steps)
    return _lowered(trace, rate, factor, samples)


def _looking_ahead(scene: Scene, rate: float, factor: int) -> tuple[Scene, int]:
    """The scene that is marched at a `factor` times the `rate` (Hz), and for how many samples: it lasts longer by what
    the low-pass behind it looks ahead, if there is one."""
    if factor == 1:
        return scene, scene.samples(rate)
    ahead = HALF_LENGTH_SAMPLES / rate
    second = None if scene.second_cage is None else scene.second_cage.going_on(ahead)
    longer = replace(scene, cage=scene.cage.going_on(ahead), second_cage=second)
    return longer, (scene.samples(rate) + HALF_LENGTH_SAMPLES) * factor


def _lowered(trace: Trace, rate: float, factor: int, samples: int) -> Trace:
    """The first `samples` of a trace at `rate`, a `factor` below the one it was marched at."""
    known = trace.rate == rate and trace.time.size == samples
    time = trace.time if known else np.arange(samples) / rate
    outer = None if trace.outer is None else replace(trace.outer, rate=rate * factor)
    if factor == 1:
        return replace(trace, rate=rate, time=time, outer=outer)
    return replace(
        trace,
        rate=rate,
        time=time,
        outer=outer,
        acceleration=decimate(trace.acceleration, factor)[:samples],
        changes=trace.changes.before(samples / rate),
        state=None if trace.state is None else trace.state[::factor][:samples],
        contact_force=None if trace.contact_force is None else trace.contact_force[::factor][:samples],
    )
