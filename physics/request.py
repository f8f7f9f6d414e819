"""How a response is wanted, and whether a scene can be simulated so."""

from __future__ import annotations

import math
from dataclasses import dataclass

from physics.integrators.methods import METHODS, MODAL, REFERENCE
from physics.ladder.models import SIMPLER_MODELS
from physics.outcome import Outcome, SimulationFailed
from physics.response.march import MODEL
from physics.scene import Scene
from physics.trace import Kept

SMALLEST_ACCURACY, LARGEST_ACCURACY = 1e-6, 0.1
GIVEN_STEPS = "exponential_rk4"


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
