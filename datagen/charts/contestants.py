"""Everything that is run on a scene: this package's methods and models, and the general-purpose solvers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib.util import find_spec

import numpy as np

from datagen.charts.response import Response, of_states, of_trace
from physics.arrays import Array
from physics.integrators.method_table import MARCHES, METHODS, REFERENCE
from physics.integrators.rivals.general_purpose import (
    BALL_BY_BALL,
    CONTACT_KERNEL,
    PAIRS,
    absolute_tolerance,
    c_right_hand_side,
    integrate_by_fixed_steps,
    integrate_compiled,
    right_hand_side,
)
from physics.ladder.model_table import SIMPLER_MODELS
from physics.motion import motion_model, starting_state
from physics.request import Accurate, FixedSteps, Simpler
from physics.response.periodic import REPEATED, worth_repeating
from physics.scene import Scene
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium
from physics.trace import Kept

Raw = object

METHOD, MODEL, COMPILED, SCIPY = "method", "model", "compiled solver", "SciPy solver"
SUBSTEPS: Mapping[str, tuple[int, ...]] = {
    "exponential_rk4": (1, 2, 4, 8),
    "runge_kutta4": (1, 2, 4, 8, 16),
    "generalised_alpha": (2, 4, 8, 16, 32),
    "exponential_adams2": (2, 4, 8, 16, 32),
    "exponential_adams3": (1, 2, 4, 8, 16),
    "exponential_adams4": (1, 2, 4, 8, 16),
    "dormand_prince": (1, 2, 3, 4, 6),
}
USUAL_SUBSTEPS: tuple[int, ...] = (1, 2, 4, 8)
UNLOCATED_SUBSTEPS: tuple[int, ...] = (1, 2, 4, 8, 16)
ACCURACIES: tuple[float, ...] = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5)
TOLERANCES: tuple[float, ...] = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8)
SCIPY_SOLVERS = ("RK45", "DOP853", "LSODA", "Radau")
NUMBALSODA: Mapping[str, str] = {"LSODA": "lsoda", "DOP853": "dop853"}
MOST_STEPS_A_SAMPLE = 100_000
QUICK = 2


@dataclass(frozen=True)
class Contestant:
    """One solver at one `setting`: `run(scene, rate)` is timed, `read(scene, rate, result)` afterwards is not.

    `run_with_state` is run once more, untimed, where `run` keeps no state, for the error of the stiffness. A response
    that repeats itself is marched to its end there, as it is for everybody who asks for its state. `part`: it is run on
    the first part of the scene only, being slow. `substeps`: steps a sample, of a method with fixed steps.
    """

    group: str
    name: str
    setting: str
    run: Callable[[Scene, float], Raw]
    read: Callable[[Scene, float, Raw], Response]
    part: bool = False
    run_with_state: Callable[[Scene, float], Raw] | None = None
    substeps: int | None = None

    def response(self, scene: Scene, rate: float, result: Raw) -> Response:
        """What `result` of a run says, with the displacement of a run that keeps the state if there is one."""
        found = self.read(scene, rate, result)
        if self.run_with_state is None:
            return found
        kept = self.read(scene, rate, self.run_with_state(scene, rate))
        return replace(found, displacement=kept.displacement)


def contestants(scene: Scene, quick: bool) -> list[Contestant]:
    """All that can be run on `scene`, or with `quick` two settings of each."""
    kept = slice(QUICK if quick else None)
    found = []
    for name in METHODS:
        if name in MARCHES:
            found += [_march(name, steps) for steps in SUBSTEPS.get(name, USUAL_SUBSTEPS)[kept]]
        elif name != REFERENCE:
            found += [_choosing(name, accuracy, repeat=False) for accuracy in ACCURACIES[kept]]
            repeatable = [accuracy for accuracy in ACCURACIES if worth_repeating(scene, scene.duration, accuracy)]
            found += [_choosing(REPEATED, accuracy, repeat=True) for accuracy in repeatable[kept]]
    found += [_model(name) for name in SIMPLER_MODELS]
    for kind in (BALL_BY_BALL, CONTACT_KERNEL):
        found += [_compiled(pair, kind, tolerance) for pair in PAIRS for tolerance in TOLERANCES[kept]]
        found += [_unlocated(kind, steps) for steps in UNLOCATED_SUBSTEPS[kept]]
        if find_spec("numbalsoda"):
            found += [_numbalsoda(name, kind, tolerance) for name in NUMBALSODA for tolerance in TOLERANCES[kept]]
        solvers = SCIPY_SOLVERS[:2] if quick else SCIPY_SOLVERS
        found += [_scipy(solver, kind, tolerance) for solver in solvers for tolerance in TOLERANCES[kept]]
    return found


def start_of(scene: Scene) -> Array:
    """State (12,) at rest in the quasi-static position at t = 0."""
    return starting_state(motion_model(scene), equilibrium(scene, np.zeros(1)).displacement[0])


def _march(name: str, steps: int) -> Contestant:
    def run(scene: Scene, rate: float) -> Raw:
        return simulate(scene, rate, FixedSteps(steps, name), keep=Kept(state=True))

    return Contestant(METHOD, name, f"{steps} steps a sample", run, _of_trace, substeps=steps)


def _choosing(name: str, accuracy: float, *, repeat: bool) -> Contestant:
    def run(scene: Scene, rate: float) -> Raw:
        return simulate(scene, rate, Accurate(accuracy, repeat=repeat, path_fineness=1))

    def run_with_state(scene: Scene, rate: float) -> Raw:
        return simulate(scene, rate, Accurate(accuracy, path_fineness=1), keep=Kept(state=True))

    return Contestant(METHOD, name, f"accuracy {accuracy:g}", run, _of_trace, run_with_state=run_with_state)


def _model(name: str) -> Contestant:
    keep = Kept(state="state" in SIMPLER_MODELS[name].keeps)
    return Contestant(
        MODEL,
        name,
        "",
        lambda scene, rate: simulate(scene, rate, Simpler(name)),
        _of_trace,
        run_with_state=lambda scene, rate: simulate(scene, rate, Simpler(name), keep=keep),
    )


def _of_trace(scene: Scene, rate: float, result: Raw) -> Response:
    return of_trace(result)  # type: ignore[arg-type]


def _of_states(scene: Scene, rate: float, result: Raw) -> Response:
    return of_states(scene, rate, np.asarray(result))


def _compiled(pair: str, kind: str, tolerance: float) -> Contestant:
    def run(scene: Scene, rate: float) -> Raw:
        samples = scene.samples(rate)
        return integrate_compiled(scene, pair, kind, start_of(scene), rate, samples, tolerance)[0]

    return Contestant(COMPILED, f"compiled {pair}, {kind}", f"tolerance {tolerance:g}", run, _of_states)


def _unlocated(kind: str, substeps: int) -> Contestant:
    def run(scene: Scene, rate: float) -> Raw:
        samples = scene.samples(rate)
        return integrate_by_fixed_steps(scene, kind, start_of(scene), rate, samples, substeps)

    return Contestant(COMPILED, f"compiled RK4, {kind}", f"{substeps} steps a sample", run, _of_states)


def _numbalsoda(solver: str, kind: str, tolerance: float) -> Contestant:
    import numbalsoda

    solve = NUMBALSODA[solver]

    def run(scene: Scene, rate: float) -> Raw:
        start, time = start_of(scene), np.arange(scene.samples(rate)) / rate
        slopes = c_right_hand_side(scene, kind, start)
        deviation, done = getattr(numbalsoda, solve)(
            slopes.address, np.zeros(12), time, slopes.data, tolerance, tolerance, MOST_STEPS_A_SAMPLE
        )
        return start + slopes.data[12:24] * deviation if done else np.full((time.size, 12), np.nan)

    return Contestant(COMPILED, f"numbalsoda {solver}, {kind}", f"tolerance {tolerance:g}", run, _of_states)


def _scipy(solver: str, kind: str, tolerance: float) -> Contestant:
    from scipy.integrate import solve_ivp

    def run(scene: Scene, rate: float) -> Raw:
        slope, model = right_hand_side(scene, kind)
        start, time = start_of(scene), np.arange(scene.samples(rate)) / rate
        solution = solve_ivp(
            lambda t, deviation: slope(model, t, start + deviation),
            (0.0, time[-1]),
            np.zeros(12),
            method=solver,
            t_eval=time,
            rtol=max(tolerance, 1e-12),
            atol=absolute_tolerance(scene, tolerance),
        )
        states = np.full((time.size, 12), np.nan)
        states[: solution.y.shape[1]] = start + solution.y.T
        return states

    return Contestant(SCIPY, f"SciPy {solver}, {kind}", f"tolerance {tolerance:g}", run, _of_states, part=True)
