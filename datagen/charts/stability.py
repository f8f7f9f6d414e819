"""Where each method loses its order, goes unstable or fails: one quantity of a scene varied against the step."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from datagen.charts.contestants import start_of
from datagen.charts.measure import made_with
from datagen.progress import Say
from physics.arrays import Array
from physics.bearing import Bearing
from physics.checks import InvalidParameter
from physics.integrators.method_table import MARCHES, METHODS, MODAL
from physics.integrators.output import Grid
from physics.outcome import SimulationFailed
from physics.reference_scenes import reference_scene
from physics.response.adaptive import respond_accurately
from physics.response.asked import Asked
from physics.response.single_march import respond
from physics.response.stability import longest_stable_step, stable_substeps
from physics.rms import relative_error
from physics.scene import Scene
from physics.statics.load_distribution import equilibrium, resting

RATE, DURATION = 65536.0, 0.04
# Steps of 8 samples to 1/16 of one: samples a step above one, steps a sample below.
SAMPLES_A_STEP = (8, 4, 2)
STEPS_A_SAMPLE = (1, 2, 4, 8, 16)
STEPS = tuple(float(n) for n in SAMPLES_A_STEP) + tuple(1.0 / n for n in STEPS_A_SAMPLE)
# The method that chooses its own steps is asked for these accuracies instead.
ACCURACIES = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5)
BY_STEP, BY_ACCURACY = "samples a step", "accuracy asked for"
FINEST = 64
ROUNDING = 1e-9  # as where `simulate` rounds steps a sample up
CONVERGED = 1e-3
VALUE, NOT_CONVERGED = "value", "not converged"


@dataclass(frozen=True)
class Sweep:
    """One quantity of the gearbox rig's line spall, with its `unit`, the `values` it takes and how it is set."""

    name: str
    unit: str
    values: tuple[float, ...]
    apply: Callable[[Scene, float], Scene]


@dataclass(frozen=True)
class Map:
    """Errors of one method over one sweep.

    Each is of a value and one of `rows`, which are steps or accuracies as `scale` says, (V, S). `error`: RMS error of
    the acceleration over its RMS; NaN where there is none. `outcomes`: VALUE where there is an error, NOT_CONVERGED
    where no step gives anything to compare with, or the outcome with which the calculation ended. `refused`: the step
    lies above `limit` (V,), so that `simulate` does not begin. `limit` is the longest stable step in samples by the
    linearised scene, infinite if there is none.
    """

    method: str
    scale: str
    rows: tuple[float, ...]
    sweep: str
    unit: str
    values: tuple[float, ...]
    error: tuple[tuple[float, ...], ...]
    outcomes: tuple[tuple[str, ...], ...]
    refused: tuple[tuple[bool, ...], ...]
    limit: tuple[float, ...]


def _bearing(scene: Scene, bearing: Bearing) -> Scene:
    return replace(scene, rig=replace(scene.rig, bearing=bearing))


def _speed(scene: Scene, times: float) -> Scene:
    return reference_scene("G1", scene.duration, speed_factor=times)


def _length(scene: Scene, degrees: float) -> Scene:
    extent = math.radians(degrees)
    taper = min(scene.spalls[0].entry_taper, 0.2 * extent)
    return replace(scene, spalls=(replace(scene.spalls[0], extent=extent, entry_taper=taper, exit_taper=taper),))


def _stiffness(scene: Scene, times: float) -> Scene:
    bearing = scene.rig.bearing
    return _bearing(scene, replace(bearing, load_deflection=times * bearing.load_deflection))


SWEEPS = (
    Sweep("contact stiffness K", "times the rig's", (1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6), _stiffness),
    Sweep(
        "resonator stiffness",
        "times the rig's",
        (0.01, 0.1, 0.3, 1.0, 2.0, 4.0, 10.0),
        lambda s, times: replace(s, rig=replace(s.rig, resonator_stiffness=times * s.rig.resonator_stiffness)),
    ),
    Sweep(
        "film damping",
        "N s/m",
        (1.0, 10.0, 100.0, 1e3, 1e4, 3e4, 1e5),
        lambda s, value: replace(s, rig=replace(s.rig, film_damping=value)),
    ),
    Sweep(
        "load",
        "times the rig's",
        (0.01, 0.03, 0.1, 1.0, 10.0, 30.0, 100.0),
        lambda s, times: replace(s, operation=replace(s.operation, load=times * s.operation.load)),
    ),
    Sweep(
        "clearance",
        "µm",
        (-20.0, -5.0, 0.0, 5.0, 20.0, 50.0, 100.0),
        lambda s, um: _bearing(s, replace(s.rig.bearing, clearance=um * 1e-6)),
    ),
    Sweep("speed", "times the rig's", (0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 30.0), _speed),
    Sweep("spall length", "degrees", (0.01, 0.1, 0.5, 2.0, 10.0, 40.0, 120.0), _length),
    Sweep(
        "spall depth",
        "µm",
        (0.5, 2.0, 6.0, 12.0, 30.0, 100.0, 300.0),
        lambda s, um: replace(s, spalls=(replace(s.spalls[0], depth=um * 1e-6),)),
    ),
)


def stability_maps(step: Say) -> list[Map]:
    """Every method over every sweep; `step` is called with the name of each sweep."""
    maps = []
    for sweep in SWEEPS:
        step(sweep.name)
        scenes = [sweep.apply(reference_scene("G1", DURATION), value) for value in sweep.values]
        exact = [_exact(scene) for scene in scenes]
        maps += [_map(name, sweep, scenes, exact) for name in (MODAL, *MARCHES)]
    return maps


def _map(name: str, sweep: Sweep, scenes: list[Scene], exact: list[Array | None]) -> Map:
    scale, rows = (BY_ACCURACY, ACCURACIES) if name == MODAL else (BY_STEP, STEPS)
    cells = [[_cell(scene, name, row, found) for row in rows] for scene, found in zip(scenes, exact, strict=True)]
    limit = tuple(longest_step(scene, name) for scene in scenes)
    return Map(
        method=name,
        scale=scale,
        rows=rows,
        sweep=sweep.name,
        unit=sweep.unit,
        values=sweep.values,
        error=tuple(tuple(error for error, _ in row) for row in cells),
        outcomes=tuple(tuple(outcome for _, outcome in row) for row in cells),
        refused=tuple(tuple(is_refused(row, longest) for row in rows) for longest in limit),
        limit=limit,
    )


def facts(maps: list[Map]) -> dict[str, object]:
    """What goes into the JSON file beside the picture."""
    return {
        "scene": f"G1, {DURATION} s at {RATE:g} Hz",
        "maps": maps,
        "made_with": made_with(),
    }


def _exact(scene: Scene) -> Array | None:
    """Acceleration (T, 2) with steps so short that half of them give the same, or None if there are none."""
    stable = stable_substeps(scene, METHODS["exponential_rk4"], equilibrium(scene, np.zeros(1)), RATE)
    steps = max(FINEST, 4 * stable)
    try:
        fine, finer = (_response(scene, "exponential_rk4", 1.0 / n) for n in (steps, 2 * steps))
    except (SimulationFailed, InvalidParameter):
        return None
    return finer if relative_error(fine, finer) < CONVERGED else None


def _response(scene: Scene, method: str, step: float) -> Array:
    """Acceleration at the ends of steps of `step` samples, or at the samples if steps are shorter."""
    rate = RATE / max(1.0, step)
    substeps = max(1, round(1.0 / step))
    grid = Grid(scene.samples(rate), substeps, 1.0 / (rate * substeps))
    return respond(scene, start_of(scene), grid, method).acceleration


def _cell(scene: Scene, method: str, row: float, exact: Array | None) -> tuple[float, str]:
    """Error and outcome of one method at one step or accuracy."""
    if exact is None:
        return math.nan, NOT_CONVERGED
    try:
        if method == MODAL:
            trace = respond_accurately(Asked(scene, resting(scene), RATE, round(scene.duration * RATE), row))
            return relative_error(trace.acceleration, exact), VALUE
        found = _response(scene, method, row)
    except SimulationFailed as failure:
        return math.nan, failure.outcome.name.lower().replace("_", " ")
    return relative_error(found, exact[:: max(1, round(row))][: found.shape[0]]), VALUE


def is_refused(step: float, longest: float) -> bool:
    """Whether a step is longer than the `longest` stable one, but for rounding."""
    return step > longest * (1.0 + ROUNDING)


def longest_step(scene: Scene, method: str) -> float:
    """The longest stable step of a method on a scene at rest, in samples; infinite if the method has no limit."""
    rest = equilibrium(scene, np.zeros(1))
    return longest_stable_step(scene.rig, METHODS[method], rest.stiffness[0], rest.damping[0]) * RATE
