"""A response by a method of fixed steps: as many a sample as are stable, resolve the modes and keep an accuracy."""

from __future__ import annotations

import math
from dataclasses import replace

from physics.arrays import Array
from physics.integrators.methods import METHODS
from physics.integrators.output import Grid
from physics.integrators.propagator import reach
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.response.march import respond
from physics.response.stability import require_stable, stable_substeps
from physics.rms import relative_error
from physics.scene import Scene
from physics.statics.load_distribution import Equilibrium
from physics.trace import Kept, Trace

STEPS_PER_FAST_PERIOD = 6.2
PILOT_PASSES = 3.0
# A pilot has to see twice what comes round with the shaft, or with the cage where balls differ.
PILOT_TURNS = 2.2
SHORTEST_PILOT = 2048
MOST_SUBSTEPS = 32
# On a line spall the start of contact, F ~ (t − t0)^n, limits the order to n + 1; with rollers that is 2.1.
PILOT_ORDER = 2.0


def respond_by_fixed_steps(
    scene: Scene,
    rest: Equilibrium,
    rate: float,
    samples: int,
    method: str,
    substeps: int | None,
    accuracy: float | None,
    kept: Kept,
) -> Trace:
    """Trace of `scene` at k / rate from its `rest` at t = 0 by `substeps` steps a sample of `method`.

    None starts from the fewest that are stable and resolve the fastest mode, and doubles them until a pilot of a few
    ball passes keeps the `accuracy`. Without an accuracy there is no pilot, and no estimate of the error. Raises
    SimulationFailed for steps that are not stable, and where MOST_SUBSTEPS do not keep the accuracy.
    """
    start = starting_state(motion_model(scene), rest.displacement[0])
    least = stable_substeps(scene, METHODS[method], rest, rate)
    steps = substeps or max(default_substeps(scene, rate), least)
    require_stable(METHODS[method], rate, steps, least)
    error = math.nan
    if accuracy is not None:
        most = steps if substeps else max(MOST_SUBSTEPS, steps)
        steps, error = _pilot(scene, start, rate, method, steps, most, accuracy)
        if substeps is None and error > accuracy:
            raise SimulationFailed(
                Outcome.INACCURATE,
                f"{method} with {steps} steps a sample of {rate:.6g} Hz is off by {error:.2g} of the acceleration's "
                f"RMS, and {accuracy:g} is asked for",
            )
    grid = Grid(samples, steps, 1.0 / (rate * steps))
    trace = respond(scene, start, grid, method, kept)
    return replace(trace, error_estimate=error)


def default_substeps(scene: Scene, rate: float) -> int:
    """Fewest steps a sample that give the fastest linear mode about six steps a period."""
    per_step = reach(motion_model(scene), 1.0 / rate)
    return max(1, math.ceil(per_step * STEPS_PER_FAST_PERIOD / (2.0 * math.pi)))


def _pilot(
    scene: Scene, start: Array, rate: float, method: str, steps: int, most: int, accuracy: float
) -> tuple[int, float]:
    """Steps a sample (up to `most`) that meet `accuracy` over the scene's first passes, and their estimated error."""
    samples = min(round(scene.duration * rate), max(SHORTEST_PILOT, math.ceil(_pilot_duration(scene) * rate)))

    def response(steps: int) -> Array:
        return respond(scene, start, Grid(samples, steps, 1.0 / (rate * steps)), method).acceleration

    coarse, fine = response(steps), response(2 * steps)
    error = _estimated_error(coarse, fine)
    while error > accuracy and 2 * steps <= most:
        steps *= 2
        coarse, fine = fine, response(2 * steps)
        error = _estimated_error(coarse, fine)
    return steps, error


def _pilot_duration(scene: Scene) -> float:
    passes = PILOT_PASSES if scene.balls_are_alike else PILOT_TURNS * scene.rig.bearing.balls
    duration = passes * scene.rig.bearing.spacing / scene.cage.mean_speed
    turns = PILOT_TURNS * 2.0 * math.pi / scene.operation.shaft_speed
    return max(duration, turns) if scene.turns_with_the_shaft else duration


def _estimated_error(coarse: Array, fine: Array) -> float:
    """Estimated RMS error of `coarse`, relative to its RMS, from a response at half the step."""
    return relative_error(coarse, fine) / (1.0 - 2.0**-PILOT_ORDER)
