"""Designs fill the space of the settings, remake any record alone, and leave what a redraw needs free."""

from __future__ import annotations

import multiprocessing
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.stats import qmc

from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.scenarios import design
from datagen.scenarios.design import BLOCK, DIMENSIONS, TOTAL, Design, dimension_of
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario

OPERATION = {"speed_rpm": {"uniform": [100, 3000]}, "load_of_rated": {"log_uniform": [0.1, 5]}}
MACHINE = {"rig": "gearbox", "clearance_um": {"uniform": [0, 10]}}
DESIGNS = ("latin_hypercube", "sobol")


def recipe_of(kind: str, records: int, **settings: Any) -> Recipe:
    """A recipe of one designed part."""
    part = {"name": "p", "records": records, "design": kind, "machine": MACHINE, "operation": OPERATION} | settings
    content = {"name": "r", "seed": 11, "signal": {"rate_hz": 65536, "duration_s": 0.05}, "part": [part]}
    return parse_recipe(content, Path("recipe.toml"))


def draw_all(recipe: Recipe) -> list[Scenario]:
    return [draw_scenario(recipe, record) for record in range(recipe.count)]


def drawn_elsewhere(recipe: Recipe, records: Iterable[int]) -> list[Scenario]:
    """Scenarios drawn in that order by a process that remembers none."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return list(pool.map(partial(draw_scenario, recipe), records))


def unit_cube(scenarios: list[Scenario]) -> np.ndarray:
    """Speed, load and clearance of the scenarios as the numbers in [0, 1) they were drawn from."""
    rows = []
    for scenario in scenarios:
        run, rig = scenario.scene.operation, scenario.scene.rig
        speed = (run.shaft_speed * 30 / np.pi - 100) / 2900
        load = np.log(run.load / rig.rated_load / 0.1) / np.log(50)
        rows.append((speed, load, rig.bearing.clearance * 1e5))
    return np.clip(np.array(rows), 0.0, 1.0 - 1e-12)


@pytest.mark.parametrize("kind", DESIGNS)
def test_each_setting_alone_takes_one_value_from_every_stratum(kind: str) -> None:
    numbers = unit_cube(draw_all(recipe_of(kind, 64)))
    for column in numbers.T:
        assert sorted(np.floor(column * 64).astype(int)) == list(range(64))


def test_a_latin_hypercube_is_exact_for_a_number_of_records_that_is_no_power_of_two() -> None:
    numbers = unit_cube(draw_all(recipe_of("latin_hypercube", 45)))
    for column in numbers.T:
        assert sorted(np.floor(column * 45).astype(int)) == list(range(45))


def test_the_strata_of_different_settings_are_shuffled_apart() -> None:
    numbers = unit_cube(draw_all(recipe_of("latin_hypercube", 64)))
    correlation = np.corrcoef(numbers.T)[np.triu_indices(3, 1)]
    assert np.all(np.abs(correlation) < 0.5)  # four standard deviations, 1/√63 each


@pytest.mark.parametrize("kind", DESIGNS)
def test_the_spalls_of_the_machines_of_a_later_part_are_stratified_among_themselves(kind: str) -> None:
    defect = {"condition": "line", "extent_deg": {"uniform": [1, 3]}, "depth_um": 10, "drawn_for": "machine"}
    first = {"name": "first", "records": 3, "machine": MACHINE}
    later = first | {"name": "later", "records": 32, "records_per_machine": 2, "design": kind, "defect": defect}
    content = {"name": "r", "seed": 11, "signal": {"rate_hz": 65536, "duration_s": 0.05}, "part": [first, later]}
    scenarios = draw_all(parse_recipe(content, Path("recipe.toml")))[3:]
    extents = np.degrees([scenario.scene.spalls[0].extent for scenario in scenarios[::2]])
    assert sorted(np.floor((extents - 1.0) / 2.0 * 16).astype(int)) == list(range(16))


def test_machines_and_records_are_stratified_each_among_themselves() -> None:
    scenarios = draw_all(recipe_of("sobol", 128, records_per_machine=4))
    numbers = unit_cube(scenarios)
    assert sorted(np.floor(numbers[:, 0] * 128).astype(int)) == list(range(128))
    assert sorted(np.floor(numbers[::4, 2] * 32).astype(int)) == list(range(32))
    assert len({scenario.bearing_id for scenario in scenarios}) == 32
    # within a machine, four neighbouring points of a Sobol sequence fall into four quarters of each setting
    for speeds in numbers[:, 0].reshape(32, 4):
        assert sorted(np.floor(speeds * 4).astype(int)) == [0, 1, 2, 3]


def test_a_latin_hypercube_puts_one_machine_into_each_of_as_many_strata_as_there_are_machines() -> None:
    clearances = unit_cube(draw_all(recipe_of("latin_hypercube", 64, records_per_machine=5)))[::5, 2]
    assert sorted(np.floor(clearances * 13).astype(int)) == list(range(13))


def test_a_sobol_design_fills_the_joint_space_more_evenly_than_random_draws() -> None:
    found = qmc.discrepancy(unit_cube(draw_all(recipe_of("sobol", 128))))
    free = [qmc.discrepancy(np.random.default_rng(seed).random((128, 3))) for seed in range(50)]
    assert found < min(free)


def test_all_pairs_of_dimensions_are_more_even_than_random_ones() -> None:
    points = design.sobol_block(3, 0, 0)[:256]
    generator = np.random.default_rng(0)
    pairs = [generator.choice(TOTAL, 2, replace=False) for _ in range(60)]
    found = np.array([qmc.discrepancy(points[:, pair]) for pair in pairs])
    free = np.array([qmc.discrepancy(generator.random((256, 2))) for _ in pairs])
    assert np.median(found) < 0.2 * np.median(free)  # measured 0.06


def test_the_first_records_of_a_sobol_design_are_already_spread() -> None:
    numbers = unit_cube([draw_scenario(recipe_of("sobol", 4096), record) for record in range(16)])
    for column in numbers.T:
        assert sorted(np.floor(column * 16).astype(int)) == list(range(16))


@pytest.mark.parametrize("kind", [pytest.param(k, marks=pytest.mark.slow if k != "sobol" else ()) for k in DESIGNS])
def test_a_designed_record_is_remade_alone_and_in_any_order(kind: str) -> None:
    recipe = recipe_of(kind, 12, records_per_machine=3)
    forward = draw_all(recipe)
    assert drawn_elsewhere(recipe, [7]) == [forward[7]]
    assert drawn_elsewhere(recipe, range(11, -1, -1)) == forward[::-1]


def test_a_sobol_design_goes_on_unchanged_when_records_are_added() -> None:
    assert draw_scenario(recipe_of("sobol", 5000), 3) == draw_scenario(recipe_of("sobol", 8), 3)


def test_a_point_beyond_the_first_block_is_that_of_the_whole_sequence() -> None:
    sobol = Design("sobol", 5, 2)
    whole = np.vstack([design.sobol_block(5, 2, 0), design.sobol_block(5, 2, 1)])
    assert sobol.refine(7, BLOCK + 3, 10_000, 0.0) == whole[BLOCK + 3, 7]
    for column in whole.T:
        assert np.array_equal(np.bincount(np.floor(column * 2048).astype(int), minlength=2048), np.ones(2048))


@pytest.mark.parametrize("kind", DESIGNS)
def test_parts_of_one_recipe_have_designs_of_their_own(kind: str) -> None:
    assert Design(kind, 1, 0).refine(0, 0, 100, 0.5) != Design(kind, 1, 1).refine(0, 0, 100, 0.5)


@pytest.mark.parametrize("kind", DESIGNS)
def test_the_number_of_the_stream_places_the_value_inside_its_cell(kind: str) -> None:
    low, high = (Design(kind, 1, 0).refine(0, 0, 100, number) for number in (0.0, 1.0 - 2.0**-53))
    assert 0.0 <= low < high < 1.0
    assert high - low <= (0.01 if kind == "latin_hypercube" else 2.0**-30) * (1 + 1e-9)  # rounding of the two numbers


def test_only_the_first_numbers_of_the_listed_streams_are_dimensions() -> None:
    first = {purpose: dimension_of(purpose, item, 0) for purpose, item, _ in DIMENSIONS}
    assert sorted(first.values()) == [sum(count for _, _, count in DIMENSIONS[:k]) for k in range(len(DIMENSIONS))]
    assert dimension_of("operation", 0, 23) == dimension_of("operation", 0, 0) + 23
    assert dimension_of("operation", 0, 24) is None
    assert dimension_of("spall", 1, 0) is None
    assert dimension_of("slip", 0, 0) is None


def test_redraws_leave_the_design_and_are_possible_for_every_record() -> None:
    defect = {"condition": "line", "extent_deg": {"uniform": [20, 40]}, "depth_um": 12}
    scenarios = draw_all(recipe_of("sobol", 64, defect=defect))
    redrawn = [scenario for scenario in scenarios if scenario.redraws]
    assert 20 <= len(redrawn) <= 44  # a third of the extents reaches the ball spacing of 30 degrees... half of them do
    assert all(scenario.condition == "line" for scenario in scenarios)


def test_split_shares_of_a_designed_part_are_exact_to_one_machine() -> None:
    splits = [scenario.split for scenario in draw_all(recipe_of("latin_hypercube", 60))]
    for name, count in (("train", 42), ("validation", 9), ("test", 9)):
        assert abs(splits.count(name) - count) <= 1


def test_machines_that_were_drawn_again_keep_the_split_that_the_design_gives_them() -> None:
    fitting, tight = ({"rig": "gearbox", "ball_diameter_mm": balls} for balls in (7.5, {"uniform": [7.5, 13]}))
    alike, drawn_again = (draw_all(recipe_of("latin_hypercube", 40, machine=machine)) for machine in (fitting, tight))
    assert sum(bool(scenario.redraws) for scenario in drawn_again) > 10
    assert [scenario.split for scenario in drawn_again] == [scenario.split for scenario in alike]
