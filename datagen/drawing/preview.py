"""The preview: one record of a recipe or of a corpus, drawn on one sheet."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.corpus_files.manifest import manifest_path, no_corpus, read_manifest
from datagen.corpus_files.shard import has_finished_shards
from datagen.errors import BadInput
from datagen.files.atomic import write_file
from datagen.files.places import OUT, require_file
from datagen.progress import Say, ignore
from datagen.recipes.recipe_files import FILE_NAME
from labels.schema import LABELS
from labels.truth import PassTable
from labels.variables import SHAFT_ANGLE
from physics.arrays import Array

if TYPE_CHECKING:
    import xarray

    from datagen.drawing.measured_portrait import MeasuredPortrait
    from datagen.drawing.portrait import Portrait
    from datagen.scenarios.scenario import Scenario


def draw_preview(source: str | Path, record: int, out: str | Path, say: Say = ignore) -> dict[str, Any]:
    """Draw `record` of a recipe (it is simulated) or of a corpus (it is read) into the PNG `out`; gives what was drawn.

    `say` is told where something has to be compiled first, which takes a while. Raises BadInput if the source, the
    record or the picture's name cannot be used, SimulationFailed if the record cannot be simulated; nothing is written
    then.
    """
    picture = _writable(Path(out))
    content, facts = preview_png(source, record, say)
    write_file(picture, content, OUT)
    return facts


def first_record(source: str | Path) -> int:
    """The lowest record of the corpus in the folder `source`; 0 for one without records and for a recipe."""
    if not manifest_path(Path(source)).is_file():
        return 0
    from datagen.corpus import Corpus

    return int(min(Corpus(source).labels["record"], default=0))


def preview_png(source: str | Path, record: int, say: Say = ignore) -> tuple[bytes, dict[str, Any]]:
    """The sheet of `record` of a recipe or a corpus as the bytes of a PNG file, and what it shows.

    Raises BadInput, and SimulationFailed of a recipe's record.
    """
    from datagen.drawing.sheet import sheet_png

    folder = Path(source)
    if folder.is_dir() and not (manifest_path(folder).exists() or (folder / FILE_NAME).exists()):
        if has_finished_shards(folder):
            raise no_corpus(folder, manifest_path(folder).name)
        problem = f"neither a corpus ({manifest_path(folder).name}) nor a recipe ({FILE_NAME}) is in this folder"
        raise BadInput(problem, str(folder))
    if manifest_path(folder).is_file() and read_manifest(folder).imported:
        return _measured_png(folder, record)
    held = manifest_path(folder).is_file()
    portrait = corpus_portrait(folder, record) if held else recipe_portrait(source, record, say)
    return sheet_png(portrait), _facts(portrait)


def _measured_png(folder: Path, record: int) -> tuple[bytes, dict[str, Any]]:
    from datagen.drawing.measured_sheet import measured_sheet_png

    portrait = measured_portrait(folder, record)
    return measured_sheet_png(portrait), {
        "labels": dict(portrait.labels),
        "frequencies_hz": portrait.frequencies,
        "close_up_s": list(portrait.window),
        "axis": portrait.axis,
    }


def measured_portrait(folder: Path, record: int) -> MeasuredPortrait:
    """What a sheet shows of a record of the imported corpus in `folder`; raises BadInput if it is not there."""
    from datagen.corpus import Corpus
    from datagen.drawing.measured_portrait import MeasuredPortrait

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


def _writable(picture: Path) -> Path:
    if picture.suffix.lower() != ".png":
        raise BadInput(field=OUT, value=str(picture), allowed="a file name that ends in .png")
    require_file(picture)
    return picture


def recipe_portrait(source: str | Path, record: int, say: Say = ignore) -> Portrait:
    """What a sheet shows of a record of a recipe, simulated now; raises BadInput and SimulationFailed."""
    from datagen.drawing.portrait import Portrait
    from datagen.recipes.recipe import load_recipe
    from datagen.records.record import make_record
    from datagen.runs.requirements import require_memory, require_record_memory
    from datagen.runs.task import compile_kernels
    from datagen.scenarios.sampling import draw_scenario

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
    from datagen.corpus import Corpus
    from datagen.drawing.portrait import Portrait
    from datagen.scenarios.scenario_text import scenario_of

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
    from datagen.records.layers import background_layers
    from physics.sensor.chain import SensorChain

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


def _plain(values: np.ndarray) -> Any:
    return values.item() if values.ndim == 0 else tuple(values.tolist())


def _pass_table(found: xarray.Dataset) -> PassTable:
    names = [field.name for field in fields(PassTable)]
    return PassTable(**{name: found[f"pass_{name}" if f"pass_{name}" in found else name].values for name in names})


def _facts(portrait: Portrait) -> dict[str, Any]:
    """What the sheet shows, in numbers: labels, frequencies (Hz), modes along y (Hz) and the close-up (s)."""
    from datagen.drawing.time_panels import vertical_modes

    table, shown = portrait.passes, portrait.shown_pass
    facts: dict[str, Any] = {
        "labels": {name: list(value) if isinstance(value, tuple) else value for name, value in portrait.labels.items()},
        "frequencies_hz": portrait.frequencies,
        "modes_along_y_hz": vertical_modes(portrait),
        "close_up_s": list(portrait.window),
        "passes": len(table),
        "released": int(np.isfinite(table.release_time).sum()),
    }
    if shown is not None:
        facts["shown_pass"] = {field.name: getattr(table, field.name)[shown].item() for field in fields(PassTable)}
    return facts
