"""A response by a method of fixed steps: as many a sample as are stable, resolve the modes and keep an accuracy."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

from physics.integrators.method_table import METHODS
from physics.integrators.output import Grid
from physics.integrators.propagator import fast_periods
from physics.motion import motion_model, starting_state
from physics.outcome import Outcome, SimulationFailed
from physics.response.single_march import respond
from physics.response.stability import require_stable, stable_substeps
from physics.rms import relative_error
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import Equilibrium
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


class Stepping:
    """Responses at k / `rate` (Hz) by one method of fixed steps, so many `samples` from the first position at `rest`,
    with what a Trace is to `keep`.

    `fewest` steps a sample are stable in all positions and resolve the fastest mode.
    """

    def __init__(self, scene: Scene, rest: Equilibrium, rate: float, samples: int, method: str, keep: Kept) -> None:
        self._scene, self._rate, self._samples, self._method, self._keep = scene, rate, samples, method, keep
        self._start = starting_state(motion_model(scene), rest.displacement[0])
        self._least = stable_substeps(scene, METHODS[method], rest, rate)
        self.fewest = max(default_substeps(scene, rate), self._least)
        needed = 1 if METHODS[method].controls_step else steps_over_spalls(scene, rate)
        # By what responses are judged: a method, and how many steps a sample it takes at least.
        self._judge = method if needed <= MOST_HELD_AGAINST else SURE_OVER_EDGES
        self._finest = min(needed, MOST_HELD_AGAINST)

    def once(self, steps: int) -> Trace:
        """The response by so many `steps` a sample, without an estimate of its error.

        Raises SimulationFailed for steps that are not stable.
        """
        require_stable(METHODS[self._method], self._rate, steps, self._least)
        return self._march(steps, self._method)

    def judged(self, steps: int) -> Trace:
        """The same with an estimate, by what a step of half the length makes of it.

        Or one of an even shorter step where `steps_over_spalls` asks for that, or another method where these are too
        many.
        """
        coarse = self.once(steps)
        return _estimated(coarse, self._march(max(2 * steps, self._finest), self._judge))

    def halved_until(self, accuracy: float) -> Trace:
        """The response by the fewest steps, doubled until the estimated error is within the `accuracy`.

        Raises SimulationFailed where MOST_SUBSTEPS do not keep it.
        """
        steps = self.fewest
        most = max(MOST_SUBSTEPS, steps)
        coarse, fine = self.once(steps), self._march(max(2 * steps, self._finest), self._judge)
        found = _estimated(coarse, fine)
        while found.error_estimate > accuracy and 2 * steps <= most:
            steps *= 2
            coarse = fine if steps >= self._finest and self._judge == self._method else self.once(steps)
            fine = self._march(2 * steps, self._judge) if 2 * steps > self._finest else fine
            found = _estimated(coarse, fine)
        if found.error_estimate > accuracy:
            raise SimulationFailed(
                Outcome.INACCURATE,
                f"{self._method} with {steps} steps a sample of {self._rate:.6g} Hz is off by "
                f"{found.error_estimate:.2g} of the acceleration's RMS, and {accuracy:g} is asked for",
            )
        return found

    def _march(self, steps: int, method: str) -> Trace:
        grid = Grid(self._samples, steps, 1.0 / (self._rate * steps))
        return respond(self._scene, self._start, grid, method, self._keep)


def default_substeps(scene: Scene, rate: float) -> int:
    """Fewest steps a sample that give the fastest linear mode about six steps a period."""
    return max(1, math.ceil(fast_periods(motion_model(scene), 1.0 / rate) * STEPS_PER_FAST_PERIOD))


def steps_over_spalls(scene: Scene, rate: float) -> int:
    """Fewest steps a sample of which a ball takes STEPS_OF_A_PIECE over every taper, floor and piece of a table."""
    fastest = 0.0
    for spall in scene.spalls:
        shortest = min(piece for piece in _pieces(spall) if piece > ROUNDING * spall.extent)
        fastest = max(fastest, scene.crossing_speed(spall) / shortest)
    return max(1, math.ceil(STEPS_OF_A_PIECE * fastest / rate))


def _pieces(spall: Spall) -> list[float]:
    """The arcs (rad) that a spall is made of."""
    if spall.profile == "table":
        return [end - begin for begin, end in pairwise(spall.table_angle)]
    return [spall.entry_taper, spall.extent - spall.entry_taper - spall.exit_taper, spall.exit_taper]


def _estimated(coarse: Trace, fine: Trace) -> Trace:
    """`coarse` with the estimated RMS error of its acceleration, relative to the RMS of `fine`, as if that were of half
    the step and both of order 2; of a finer one it is an overestimate."""
    error = relative_error(coarse.acceleration, fine.acceleration) / (1.0 - 2.0**-ORDER)
    return replace(coarse, error_estimate=error)
