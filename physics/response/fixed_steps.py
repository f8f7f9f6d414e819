"""A response by a method of fixed steps: as many a sample as are stable, resolve the modes and keep an accuracy."""

from __future__ import annotations

import math
from dataclasses import replace

from physics.integrators.method_table import METHODS
from physics.integrators.output import Grid
from physics.integrators.propagator import fast_periods
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.response.asked import Asked
from physics.response.single_march import respond
from physics.response.stability import require_stable, stable_substeps
from physics.rms import relative_error
from physics.scene import Scene
from physics.trace import Kept, Trace

STEPS_PER_FAST_PERIOD = 6.2
MOST_SUBSTEPS = 32
# Steps end at the edges of a spall. Where a ball passes a taper or the floor within a step, halving the step leaves it
# as it is, so steps are held against ones of which it takes this many, as far as so many a sample are enough.
STEPS_OF_A_PIECE = 2.0
MOST_HELD_AGAINST = 256
# Over shorter pieces methods are held against this one: its stages lie at both ends and in the middle of a step, so
# that it sums the film's force over a taper by Simpson's rule (within 5 % of its impulse), however short that is.
SURE_OVER_EDGES = "exponential_rk4"
# On a line spall the start of contact, F ~ (t − t0)^n, limits the order to n + 1; with rollers that is 2.1.
ORDER = 2.0
ROUNDING = 1e-9  # of a floor that two tapers leave nothing of


def respond_by_fixed_steps(asked: Asked, method: str, substeps: int | None, judged: bool, keep: Kept) -> Trace:
    """What is asked for by `substeps` steps a sample of `method`, whatever its `least_error`.

    None stands for the fewest that are stable in all positions and resolve the fastest mode. If the response is to be
    `judged`, they are doubled until it keeps the accuracy, which may be infinite, by what one of half the step makes of
    it, or of an even shorter one where `steps_over_spalls` asks for that, or one by another method where these are too
    many. If not, there is no second response, and no estimate of the error. Raises SimulationFailed for steps that are
    not stable, and where MOST_SUBSTEPS do not keep the accuracy.
    """
    scene, rate, accuracy = asked.scene, asked.rate, asked.accuracy
    start = starting_state(motion_model(scene), asked.rest.displacement[0])
    least = stable_substeps(scene, METHODS[method], asked.rest, rate)
    steps = substeps or max(default_substeps(scene, rate), least)
    require_stable(METHODS[method], rate, steps, least)

    def response(steps: int, by: str = method) -> Trace:
        return respond(scene, start, Grid(asked.samples, steps, 1.0 / (rate * steps)), by, keep)

    if not judged:
        return response(steps)
    most = max(MOST_SUBSTEPS, steps)
    needed = 1 if METHODS[method].controls_step else steps_over_spalls(scene, rate)
    finest, judge = min(needed, MOST_HELD_AGAINST), method if needed <= MOST_HELD_AGAINST else SURE_OVER_EDGES
    coarse, fine = response(steps), response(max(2 * steps, finest), judge)
    error = _estimated_error(coarse, fine)
    while error > accuracy and 2 * steps <= most:
        steps *= 2
        coarse = fine if steps >= finest and judge == method else response(steps)
        fine = response(2 * steps, judge) if 2 * steps > finest else fine
        error = _estimated_error(coarse, fine)
    if error > accuracy:
        raise SimulationFailed(
            Outcome.INACCURATE,
            f"{method} with {steps} steps a sample of {rate:.6g} Hz is off by {error:.2g} of the acceleration's "
            f"RMS, and {accuracy:g} is asked for",
        )
    return replace(coarse, error_estimate=error)


def default_substeps(scene: Scene, rate: float) -> int:
    """Fewest steps a sample that give the fastest linear mode about six steps a period."""
    return max(1, math.ceil(fast_periods(motion_model(scene), 1.0 / rate) * STEPS_PER_FAST_PERIOD))


def steps_over_spalls(scene: Scene, rate: float) -> int:
    """Fewest steps a sample of which a ball takes STEPS_OF_A_PIECE over every taper and floor."""
    fastest = 0.0
    for spall in scene.spalls:
        floor = spall.extent - spall.entry_taper - spall.exit_taper
        speed = scene.crossing_speed(spall)
        pieces = [piece for piece in (spall.entry_taper, floor, spall.exit_taper) if piece > ROUNDING * spall.extent]
        fastest = max(fastest, speed / min(pieces))
    return max(1, math.ceil(STEPS_OF_A_PIECE * fastest / rate))


def _estimated_error(coarse: Trace, fine: Trace) -> float:
    """Estimated RMS error of the acceleration of `coarse`, relative to the RMS of `fine`, as if that were of half the
    step and both of order 2; of a finer one it is an overestimate."""
    return relative_error(coarse.acceleration, fine.acceleration) / (1.0 - 2.0**-ORDER)
