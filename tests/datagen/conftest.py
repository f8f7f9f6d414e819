"""A tiny corpus made once, and records made of plain numbers for tests of files that need no physics."""

from __future__ import annotations

import math
import shutil
import sys
from collections.abc import Callable
from dataclasses import replace
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from datagen.benchmark.model_scores import Confusion, Scores
from datagen.charts.contestants import contestants
from datagen.charts.measure import Chart, measure
from datagen.charts.scenes import find_subject
from datagen.corpus_files.shard import finished_shards
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.records.record import Record, make_record
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from datagen.scenarios.scenario import Scenario
from labels.interval import Interval
from labels.schema import LABELS, LAYERS
from labels.truth import PassTable
from physics.outcome import Outcome, SimulationFailed
from physics.spall import Spall

sys.path.insert(0, str(Path(__file__).parent))  # so that tests can import command_line and imports

RATE, SAMPLES, ROWS, BALLS = 1000.0, 200, 2, 5
TINY_RECIPE = """
name = "tiny"
title = "A few short records"
seed = 7
[signal]
rate_hz = 32768
duration_s = 0.05
[store]
records_per_shard = 2
clean = true
cage_angle = true
contact_force = "first_of_each"
[[part]]
name = "gearbox"
records = 8
records_per_machine = 2
machine.rig = "gearbox"
background.white_rms_m_s2 = 0.01
[part.defect]
condition = {choice = ["healthy", "line", "extended"]}
depth_um = 10
line.extent_deg = 2
extended.extent_deg = 40
[[part]]
name = "fan"
records = 6
machine.rig = "fan"
[part.defect]
condition = "line"
race = {choice = ["outer", "inner"]}
depth_um = 10
extent_deg = 2.6
"""


@pytest.fixture(scope="session")
def tiny_recipe(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """File of a recipe of 14 short records on both rigs, in shards of two."""
    path = tmp_path_factory.mktemp("recipe") / "tiny.toml"
    path.write_text(TINY_RECIPE)
    return path


@pytest.fixture(scope="session")
def tiny(tiny_recipe: Path) -> Recipe:
    """The recipe itself."""
    return load_recipe(tiny_recipe)


@pytest.fixture(scope="session")
def tiny_corpus(tiny: Recipe, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The whole corpus of the tiny recipe, made without interruption in this process; tests only read it."""
    folder = tmp_path_factory.mktemp("corpus") / "tiny"
    assert generate(tiny, folder, engine=Engine(workers=1)).complete
    return folder


@pytest.fixture
def short_records_are_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    """The records of the tiny corpus are quick to make, and shorter than any that is judged otherwise."""
    monkeypatch.setattr("datagen.benchmark.fitness.SHORTEST", 0.0)
    monkeypatch.setattr("datagen.benchmark.fitness.FEWEST_TURNS", 0.0)


@pytest.fixture(scope="session")
def load_script() -> Callable[..., ModuleType]:
    """A function that loads a script of the folder `docs`, or another `folder`, by its name, without running it."""

    def load(name: str, folder: str = "docs") -> ModuleType:
        spec = spec_from_file_location(name, Path(__file__).parents[2] / folder / f"{name}.py")
        assert spec is not None
        assert spec.loader is not None
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


@pytest.fixture(scope="session")
def small_chart() -> Chart:
    """A chart of one method and one model over 0.12 s."""
    subject = find_subject("F1")
    subject = replace(subject, scene=subject.lasting(0.12))
    named = [one for one in contestants(subject.scene, quick=True) if one.name in ("exponential_rk4", "impulse train")]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("datagen.charts.measure.contestants", lambda scene, quick: named)
        return measure(subject, quick=True, rounds=1, step=lambda what: None)


@pytest.fixture(scope="session")
def made_scores() -> Callable[..., Scores]:
    """A function that gives the Scores of a model that was asked of nothing, but for the fields given."""
    none = Interval(math.nan, math.nan, math.nan)
    nothing = Scores(
        none, none, none, none, 0, 0, none, 0, 0, 0, 0, Confusion(("none",), ("none",), [[1]]), None, None, None, {}
    )
    return lambda **fields: replace(nothing, **fields)


Contents = Callable[[Path], dict[int, str]]


@pytest.fixture(scope="session")
def contents() -> Contents:
    """A function that gives the hash of the decoded arrays of every finished shard of a folder."""
    return lambda folder: {sidecar.shard: sidecar.content for sidecar in finished_shards(folder)}


@pytest.fixture
def copy(tiny_corpus: Path, tmp_path: Path) -> Path:
    """A copy of the tiny corpus that a test may damage."""
    return Path(shutil.copytree(tiny_corpus, tmp_path / "copy"))


@pytest.fixture(scope="session")
def expected(tiny_corpus: Path, contents: Contents) -> dict[int, str]:
    """Hash of the decoded arrays of every shard of the tiny corpus."""
    return contents(tiny_corpus)


@pytest.fixture
def record_3_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    """The record 3 of any recipe cannot be simulated; the others can."""

    def failing(scenario: Scenario, stored: tuple[str, ...]) -> Record:
        if scenario.record == 3:
            raise SimulationFailed(Outcome.NOT_FINITE, "the response stopped being finite")
        return make_record(scenario, stored)

    monkeypatch.setattr("datagen.runs.task.make_record", failing)


def plain_labels(index: int, spall: Spall | None) -> dict[str, Any]:
    """A value for every label of the schema, consistent for a healthy record or one with `spall`."""
    empty: dict[str, Any] = {"str": "word", "float64": 0.5, "int64": 3, "bool": False}
    labels = {label.name: empty[label.dtype] for label in LABELS} | {
        "record": index,
        "split": "train",
        "bearing_id": f"b{index // 2}",
        "condition": "line" if spall else "healthy",
        "location": spall.race if spall else "none",
        "profile": "tukey" if spall else "none",
        "contact_law": "paper",
        "speed_basis": "set",
        "spalls": 1 if spall else 0,
        "extent": spall.extent if spall else 0.0,
        "extent_spacing": 0.3 if spall else 0.0,
        "rate_hz": RATE,
        "duration_s": SAMPLES / RATE,
        "snr_db": math.nan if index % 2 else 12.5,
        "envelope_band": (100.0, 200.0),
        "snr_band": (100.0, 200.0),
        "background_rms": (0.1,) * len(LAYERS),
        "validity": "",
    }
    return labels


def plain_passes(count: int, start: float) -> PassTable:
    """A table of `count` complete passes that begin at `start` (s)."""
    one, time = np.ones(count, np.int16), np.full(count, start)
    truth, gone = np.ones(count, np.bool_), np.full(count, np.nan)
    begun, over = time + 0.005, time + 0.015
    return PassTable(one, one, one - 1, time, time + 0.01, time + 0.02, begun, over, truth, truth, gone, gone)


@pytest.fixture
def make_plain_record() -> Callable[..., Record]:
    """A function that gives a record of random numbers; the defect is on the outer race, or there is none."""

    def make(index: int, healthy: bool = False, full: bool = False) -> Record:
        generator = np.random.default_rng(index)
        spall = None if healthy else Spall("outer", 1, 4.7, 0.05, 1e-5)
        noise = generator.standard_normal((SAMPLES, 2)).astype(np.float32)
        record = Record(
            index=index,
            time=np.arange(SAMPLES) / RATE,
            stiffness_time=np.linspace(0.0, SAMPLES / RATE, 7),
            acceleration=noise,
            envelope=np.abs(noise[:, 1]),
            stiffness=generator.uniform(5e7, 9e7, (3, 7)).astype(np.float32),
            passes=plain_passes(0 if healthy else 1, 0.01 * index),
            spalls=() if spall is None else (spall,),
            labels=plain_labels(index, spall),
            scenario=f'{{"record": {index}, "umlaut": "ü"}}',
        )
        if not full:
            return record
        return replace(
            record,
            acceleration_clean=noise / 2.0,
            acceleration_sensor=noise / 2.0,
            background=generator.standard_normal((len(LAYERS), SAMPLES, 2)).astype(np.float32),
            cage_angle=np.cumsum(generator.random(SAMPLES)),
            profile_depth=np.zeros((ROWS, 64), np.float32),
            contact_force=generator.random((SAMPLES, ROWS, BALLS)).astype(np.float32),
        )

    return make
