"""The expected.json of each dataset is what its recipe draws today."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from datagen.recipes.recipe import Recipe, load_recipe, parse_recipe

DATASETS = Path(__file__).resolve().parents[2] / "datasets"
EVERY = sorted(path.parent.name for path in DATASETS.glob("*/recipe.toml"))
LONG = ("corpus", "size_imperfect", "size_training", "transfer")  # seven seconds and more each
ROUNDING = 1e-6
Drawn = Callable[[Recipe], dict[str, Any]]


@pytest.fixture
def drawn(load_script: Callable[..., ModuleType]) -> Drawn:
    """What the script says of a recipe."""
    expected: Drawn = load_script("make_expected", "datasets").expected
    return expected


def stored(name: str) -> dict[str, Any]:
    """What the dataset's file says."""
    content: dict[str, Any] = json.loads((DATASETS / name / "expected.json").read_text())
    return content


@pytest.mark.parametrize("name", EVERY)
def test_every_dataset_has_statistics_of_the_recipe_as_it_is(name: str) -> None:
    recipe, said = load_recipe(name), stored(name)
    assert (said["recipe_hash"], said["records"]) == (recipe.hash, recipe.count)
    for counted in ("condition", "location", "split"):
        assert sum(said[counted].values()) == recipe.count


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.slow if n in LONG else ()) for n in EVERY])
def test_the_statistics_are_those_of_the_scenarios_that_are_drawn(name: str, drawn: Drawn) -> None:
    said, found = stored(name), drawn(load_recipe(name))
    assert said.keys() == found.keys()
    for key, value in found.items():
        numbers = key in ("speed_rpm", "load_n", "extent_mm", "snr_target_db") and value is not None
        assert said[key] == (pytest.approx(value, rel=ROUNDING) if numbers else value), key


def test_fixed_settings_have_the_counts_and_quantiles_that_they_say(drawn: Drawn) -> None:
    part = {
        "machine": {"rig": "gearbox"},
        "operation": {"speed_rpm": 900, "load_n": 200},
        "background": {"snr_db": 12, "white_rms_m_s2": 1},
    }
    gap = {"condition": "line", "race": "inner", "extent_mm": 1.5, "depth_um": 9}
    content = {"name": "n", "seed": 1, "signal": {"rate_hz": 32768, "duration_s": 0.1}}
    parts = [part | {"name": "a", "records": 3, "defect": gap}, part | {"name": "b", "records": 2}]
    found = drawn(parse_recipe(content | {"part": parts}, Path("recipe.toml")))
    assert (found["records"], found["condition"]) == (5, {"healthy": 2, "line": 3})
    assert found["location"] == {"inner": 3, "none": 2}
    shares = ("0", "0.25", "0.5", "0.75", "1")
    for name, value in (("speed_rpm", 900.0), ("load_n", 200.0), ("extent_mm", 1.5), ("snr_target_db", 12.0)):
        assert found[name] == pytest.approx(dict.fromkeys(shares, value), rel=1e-7)
