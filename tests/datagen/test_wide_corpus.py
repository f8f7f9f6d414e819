"""The wide corpus keeps what its page says: ranges, balance, splits by machine, diversity from the first record on."""

from __future__ import annotations

import math
import re
import tomllib
from collections import Counter, defaultdict
from itertools import pairwise
from typing import Any

import pytest
from drawn_settings import as_written, drawn_settings, stated_values

from datagen.recipes.recipe import Recipe, load_recipe
from datagen.recipes.recipe_files import shipped_recipes
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from physics import catalog

FILE = shipped_recipes()["corpus"]
PAGE = (FILE.parent / "README.md").read_text(encoding="utf-8")
TASTE = 160


@pytest.fixture(scope="module")
def recipe() -> Recipe:
    return load_recipe("corpus")


@pytest.fixture(scope="module")
def taste(recipe: Recipe) -> list[Scenario]:
    """The first records."""
    return [draw_scenario(recipe, record) for record in range(TASTE)]


def test_the_page_gives_every_drawn_setting_its_range_its_reason_and_whether_it_is_sourced() -> None:
    rows = {row[0]: row[1:] for row in re.findall(r"^\| `([\w.]+)` \| (.+?) \| (.+?) \| (\w+) \|$", PAGE, re.MULTILINE)}
    ranges: dict[str, list[Any]] = defaultdict(list)
    for name, drawn in drawn_settings(tomllib.loads(FILE.read_text(encoding="utf-8"))):
        ranges[name] += stated_values(drawn)
    assert set(rows) == set(ranges)
    for name, values in ranges.items():
        stated, reason, status = rows[name]
        words = set(re.findall(r"[\w.-]+", stated))
        assert set(map(as_written, values)) <= words
        assert reason
        assert status in ("sourced", "assumed")


def test_it_holds_thousands_of_records_of_machines_that_are_each_run_four_times(recipe: Recipe) -> None:
    assert recipe.count == 6000
    assert sum(part.machines for part in recipe.part) == 1500
    assert {part.records_per_machine for part in recipe.part} == {4}
    for part in recipe.part:
        assert f"| {part.name} | {part.records} |" in PAGE


def test_a_taste_is_of_all_parts_rigs_conditions_races_and_profiles(taste: list[Scenario]) -> None:
    assert len({scenario.part for scenario in taste}) == 4
    assert {scenario.rig for scenario in taste} == {*catalog.RIGS, "drawn"}
    assert {scenario.bearing for scenario in taste} == {*(rig.bearing for rig in catalog.RIGS.values()), "drawn"}
    classes = Counter((scenario.condition, scenario.location) for scenario in taste)
    assert len(classes) == 5
    assert min(classes.values()) >= 10
    assert {spall.profile for scenario in taste for spall in scenario.scene.spalls} == {"tukey", "ball_path"}
    assert {scenario.scene.contact_law for scenario in taste} == {"paper", "no_tension"}
    assert {scenario.split for scenario in taste} == {"train", "validation", "test"}
    speeds = [scenario.scene.operation.shaft_speed * 30 / math.pi for scenario in taste]
    assert min(speeds) < 110
    assert max(speeds) > 2700


def test_speeds_loads_and_slip_stay_within_what_the_page_says(taste: list[Scenario]) -> None:
    for scenario in taste:
        run, rig = scenario.scene.operation, scenario.scene.rig
        assert 100 <= run.shaft_speed * 30 / math.pi <= 3000.0001  # rounding of the unit
        assert 0.1 <= run.load / rig.rated_load <= 5.0001
        assert 0.0 <= scenario.scene.cage.mean_slip <= 0.02
        assert scenario.scene.imperfections.waviness
        assert scenario.scene.imperfections.ball_deviation
        assert scenario.background.white_rms > 0.0


def test_a_machine_is_first_healthy_and_then_has_one_damage_at_other_speeds_and_loads(taste: list[Scenario]) -> None:
    machines = [taste[k : k + 4] for k in range(0, TASTE, 4)]
    for machine in machines:
        assert len({(s.bearing_id, s.split, s.background, s.chain, s.scene.rig) for s in machine}) == 1
        assert machine[0].condition == "healthy"
        assert len({scenario.condition for scenario in machine[1:]}) == 1
        assert len({scenario.scene.operation.shaft_speed for scenario in machine}) == 4
        for one, other in pairwise(machine[1:]):
            assert [spall.extent for spall in one.scene.spalls] == [spall.extent for spall in other.scene.spalls]


def test_draws_are_seldom_impossible(taste: list[Scenario]) -> None:
    assert sum(1 for scenario in taste if scenario.redraws) < 0.1 * TASTE
