"""Where a portrait comes from: a record of a recipe, simulated now, or one of a simulated or imported corpus, read."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.corpus import Corpus
from datagen.drawing.measured_portrait import MeasuredPortrait
from datagen.drawing.portrait import Portrait
from datagen.progress import Say, ignore
from datagen.recipes.recipe import load_recipe
from datagen.records.layers import background_layers
from datagen.records.record import make_record
from datagen.runs.requirements import require_memory, require_record_memory
from datagen.runs.task import compile_kernels
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario_text import scenario_of
from labels.schema import LABELS
from labels.truth import PassTable
from labels.variables import SHAFT_ANGLE
from physics.arrays import Array
from physics.sensor.chain import SensorChain

if TYPE_CHECKING:
    import xarray

    from datagen.scenarios.scenario import Scenario


def recipe_portrait(source: str | Path, record: int, say: Say = ignore) -> Portrait:
    """What a sheet shows of a record of a recipe, simulated now; raises BadInput and SimulationFailed."""
    stored = ("acceleration_clean", "acceleration_sensor", "background")
    recipe = load_recipe(source)
    recipe.require(record, "--record")
    require_memory(recipe)
    compile_kernels(say)
    scenario = draw_scenario(recipe, record)
    require_record_memory(recipe, scenario, stored)
    made = make_record(scenario, stored)
    return Portrait(
        corpus=recipe.name,
        scene=scenario.scene,
        labels=made.labels,
        rate=float(made.labels["rate_hz"]),
        acceleration=np.asarray(made.acceleration, dtype=np.float64),
        clean=np.asarray(made.acceleration_clean, dtype=np.float64),
        envelope=np.asarray(made.envelope, dtype=np.float64),
        stiffness_time=np.asarray(made.stiffness_time),
        stiffness=np.asarray(made.stiffness, dtype=np.float64),
        passes=made.passes,
        sensor=np.asarray(made.acceleration_sensor, dtype=np.float64),
        background=np.asarray(made.background, dtype=np.float64).sum(axis=0),
    )


def corpus_portrait(folder: Path, record: int) -> Portrait:
    """What a sheet shows of a record of the simulated corpus in `folder`; raises BadInput if it is not there."""
    with Corpus(folder) as corpus:
        found = corpus.dataset(record)
    labels = {label.name: _plain(found[label.name].values) for label in LABELS}
    scenario = scenario_of(str(found["scenario"].values))
    sensor, background = _sensor_and_background(found, scenario)
    return Portrait(
        corpus=str(found.attrs.get("id", folder.name)),
        scene=scenario.scene,
        labels=labels,
        rate=float(labels["rate_hz"]),
        acceleration=found["acceleration"].values.astype(np.float64),
        clean=_stored(found, "acceleration_clean"),
        envelope=found["envelope"].values.astype(np.float64),
        stiffness_time=found["stiffness_time"].values,
        stiffness=found["stiffness"].values.astype(np.float64),
        passes=_pass_table(found),
        sensor=sensor,
        background=background,
    )


def _stored(found: xarray.Dataset, name: str) -> Array | None:
    return found[name].values.astype(np.float64) if name in found else None


def _sensor_and_background(found: xarray.Dataset, scenario: Scenario) -> tuple[Array | None, Array | None]:
    """Sensor signal and summed background (T, 2) as far as they are stored or follow from the record and its text."""
    chain = scenario.chain
    plain = chain == SensorChain(recorder=chain.recorder)
    sensor = _stored(found, "acceleration_clean" if plain else "acceleration_sensor")
    layers = _stored(found, "background")
    if layers is None and sensor is None and scenario.noise_target is not None:
        return None, None
    still = np.zeros((scenario.samples, 2))
    again = background_layers(scenario, still if sensor is None else sensor) if layers is None else {}
    background = sum(again.values(), still) if layers is None else layers.sum(axis=0)
    if sensor is None and chain.recorder is None:
        sensor = found["acceleration"].values.astype(np.float64) - background
    return sensor, background


def measured_portrait(folder: Path, record: int) -> MeasuredPortrait:
    """What a sheet shows of a record of the imported corpus in `folder`; raises BadInput if it is not there."""
    with Corpus(folder) as corpus:
        found = corpus.dataset(record)
    return MeasuredPortrait(
        corpus=corpus.manifest.name,
        labels={label.name: _plain(found[label.name].values) for label in LABELS if label.name in found},
        rate=float(found["rate_hz"]),
        axes=tuple(str(axis) for axis in found["axis"].values),
        acceleration=found["acceleration"].values.astype(np.float64),
        shaft_angle=found[SHAFT_ANGLE.name].values if SHAFT_ANGLE.name in found else None,
    )


def _plain(values: np.ndarray) -> Any:
    return values.item() if values.ndim == 0 else tuple(values.tolist())


def _pass_table(found: xarray.Dataset) -> PassTable:
    names = [field.name for field in fields(PassTable)]
    return PassTable(**{name: found[f"pass_{name}" if f"pass_{name}" in found else name].values for name in names})
