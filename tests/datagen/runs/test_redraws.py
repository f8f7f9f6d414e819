"""Planning says what was often impossible, and refuses what a recipe wants and can never have."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import run

from datagen.recipes.recipe import Recipe, load_recipe
from datagen.runs.plan import plan_shards
from datagen.scenarios.sampling import draw_scenario

TEXT = """name = "a"
seed = 1
[signal]
rate_hz = 32768
duration_s = 0.05
[[part]]
name = "p"
records = 40
records_per_machine = 2
machine.rig = "gearbox"
[part.defect]
condition = {choice = ["healthy", "line"]}
extent_deg = EXTENT
depth_um = 10
"""


def recipe_of(folder: Path, extent: str, machine: str = '"gearbox"') -> Recipe:
    """The recipe with that extent, degrees, and rig; balls of the gearbox rig are 30 degrees apart."""
    path = folder / "recipe.toml"
    path.write_text(TEXT.replace("EXTENT", extent).replace('"gearbox"', machine))
    return load_recipe(path)


def said_of(recipe: Recipe) -> list[str]:
    """What is said while the whole recipe is planned."""
    said: list[str] = []
    plan_shards(recipe, recipe.count, said.append)
    return said


def test_a_plan_that_drew_many_records_again_says_how_many_and_why(tmp_path: Path) -> None:
    recipe = recipe_of(tmp_path, "{uniform = [10, 50]}")
    redraws = [draw_scenario(recipe, record).redraws for record in range(40)]
    count, again = sum(map(len, redraws)), sum(map(bool, redraws))
    assert again > 4
    (sentence,) = said_of(recipe)
    assert sentence.startswith(
        f"{count} draws for {again} of 40 records were impossible and were drawn again (record: extent {count}; for "
        "example: condition = line, but the spall of "
    )
    assert sentence.endswith("what is impossible is missing; condition, race and profile keep their shares")


@pytest.mark.parametrize(("extent", "few"), [("2", 0), ("{uniform = [10, 32]}", 1)])
def test_a_plan_that_drew_few_records_again_says_nothing(extent: str, few: int, tmp_path: Path) -> None:
    recipe = recipe_of(tmp_path, extent)
    assert few <= sum(bool(draw_scenario(recipe, record).redraws) for record in range(40)) < 4
    assert said_of(recipe) == []


def test_what_was_refused_of_a_machine_counts_once_for_all_its_records(tmp_path: Path) -> None:
    path = tmp_path / "recipe.toml"
    drawn = 'machine.rig = "gearbox"\nmachine.ball_diameter_mm = {uniform = [8, 12]}'
    path.write_text(TEXT.replace('machine.rig = "gearbox"', drawn).replace("EXTENT", "2"))
    recipe = load_recipe(path)
    count = sum(len(draw_scenario(recipe, record).redraws) for record in range(0, 40, 2))
    assert f"(machine: ball_diameter {count}; " in said_of(recipe)[0]


def test_a_condition_that_can_never_be_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    recipe_of(tmp_path, "{uniform = [31, 39]}", '{choice = ["gearbox", "cwru"]}')
    code, printed, message = run("generate", tmp_path / "recipe.toml", "--out", tmp_path / "out")
    assert (code, printed) == (2, "")
    assert [path.name for path in tmp_path.iterdir()] == ["recipe.toml"]
    assert message.count("\n") == 1
    assert "recipe.toml, line 13: part[1].defect.extent_deg = {uniform = [31.0, 39.0]}: record " in message
    assert "meant to be line (outer race, profile tukey): 200 draws in a row were impossible" in message
    assert "allowed: below 30 degrees (this also follows from part[1].defect.condition = {choice = " in message
    assert 'part[1].machine.rig = {choice = ["gearbox", "cwru"]})' in message
