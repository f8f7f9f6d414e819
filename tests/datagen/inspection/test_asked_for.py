"""What the weights of a recipe ask for is told beside what was made of it."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from rich.console import Console

from datagen.cards.card import card_text
from datagen.cards.facts import corpus_facts
from datagen.commands.tables import info_tables
from datagen.inspection.asked_for import asked_by_condition
from datagen.inspection.info import corpus_info
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine

TEXT = """name = "a"
seed = 1
order = "interleaved"
[signal]
rate_hz = 32768
duration_s = 0.02
[[part]]
name = "weighted"
records = 16
records_per_machine = 4
machine.rig = "gearbox"
[part.defect]
condition = {choice = ["line", "extended", "healthy"], weights = [5, 3, 0]}
extent_spacing = {choice = [0.1, 1.5]}
depth_um = 10
healthy_records = 1
[[part]]
name = "sound"
records = 4
machine.rig = "fan"
"""


@pytest.fixture
def recipe(tmp_path: Path) -> Recipe:
    """16 records on machines whose first one is healthy, five of eight of the others with a line spall; 4 healthy."""
    (tmp_path / "recipe.toml").write_text(TEXT)
    return load_recipe(tmp_path / "recipe.toml")


def test_the_records_asked_for_are_those_of_the_weights_and_of_the_time_before_the_damage(recipe: Recipe) -> None:
    assert asked_by_condition(recipe, [(0, 20)]) == pytest.approx({"healthy": 8.0, "line": 7.5, "extended": 4.5})
    # Machine by machine in turns: of the first six records two are of the part without defects.
    first = asked_by_condition(recipe, [(0, 3), (3, 6)])
    assert sum(first.values()) == pytest.approx(6.0)
    assert first["line"] / first["extended"] == pytest.approx(5.0 / 3.0)


def test_a_corpus_shows_what_it_was_asked_for_beside_what_was_made(
    tiny: Recipe, tmp_path: Path, record_3_fails: None
) -> None:
    assert not generate(tiny, tmp_path / "out", limit=10, engine=Engine(workers=1)).complete
    info = corpus_info(tmp_path / "out")
    third = 8 / 3  # eight records of three conditions, then two of one
    assert info.asked_by_condition == pytest.approx({"healthy": third, "line": third + 2, "extended": third})
    assert sum(info.counts["condition"].values()) == 9
    shown = io.StringIO()
    for table in info_tables(info):
        Console(file=shown, width=200).print(table)
    rows = [line.replace("│", " ").split() for line in shown.getvalue().splitlines()]
    made = info.counts["condition"]["line"]
    assert ["line", "4.7", "46.7%", str(made), f"{made / 9:.1%}"] in rows
    card = card_text(corpus_facts(tmp_path / "out"), "", {})
    assert "The weights of the recipe ask for these of 10 records on average:" in card
    assert f"| line | 4.7 | {made} |" in card


def test_a_corpus_whose_recipe_can_no_longer_be_read_is_shown_without(copy: Path) -> None:
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest["recipe"]["part"][0]["defect"]["condition"] = "tired"
    (copy / "manifest.json").write_text(json.dumps(manifest))
    info = corpus_info(copy)
    assert info.asked_by_condition == {}
    assert not any("asked for" in str(column.header) for table in info_tables(info) for column in table.columns)
