"""Balanced settings: exact counts in every block, crossed with one another, kept by redraws, the same in any order."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from datagen.distributions.kinds import Balanced
from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.scenarios.turns import Turn, Turns

DEFECT = {
    "condition": {"balanced": ["healthy", "line", "extended"], "weights": [1, 2, 2]},
    "race": {"balanced": ["outer", "inner"]},
    "depth_um": 10,
    "line": {"extent_spacing": {"uniform": [0.05, 0.2]}},
    "extended": {"extent_spacing": 1.5},
}


def recipe_of(records: int, **settings: Any) -> Recipe:
    """A recipe of one part with balanced conditions."""
    part = {"name": "p", "records": records, "machine": {"rig": "gearbox"}, "defect": DEFECT} | settings
    content = {"name": "r", "seed": 3, "signal": {"rate_hz": 65536, "duration_s": 0.05}, "part": [part]}
    return parse_recipe(content, Path("recipe.toml"))


def draw_all(recipe: Recipe) -> list[Scenario]:
    return [draw_scenario(recipe, record) for record in range(recipe.count)]


def blocks(words: list[str], length: int) -> list[Counter[str]]:
    return [Counter(words[k : k + length]) for k in range(0, len(words), length)]


@pytest.mark.parametrize("kind", ["random", "sobol"])
def test_every_block_has_exactly_the_stated_counts(kind: str) -> None:
    conditions = [scenario.condition for scenario in draw_all(recipe_of(60, design=kind))]
    assert blocks(conditions, 5) == [Counter(healthy=1, line=2, extended=2)] * 12
    assert len({tuple(conditions[k : k + 5]) for k in range(0, 60, 5)}) > 3  # each block in an order of its own


def test_locations_are_exact_within_every_condition() -> None:
    scenarios = draw_all(recipe_of(60))
    for condition in ("line", "extended"):
        races = [scenario.location for scenario in scenarios if scenario.condition == condition]
        assert blocks(races, 2) == [Counter(outer=1, inner=1)] * 12


def test_a_machine_may_run_at_each_of_several_speeds_exactly_once() -> None:
    operation = {"speed_rpm": {"balanced": [300, 600, 900]}}
    scenarios = draw_all(recipe_of(30, records_per_machine=3, operation=operation))
    speeds = [f"{scenario.scene.operation.shaft_speed * 9.549296585513721:.0f}" for scenario in scenarios]
    assert blocks(speeds, 3) == [Counter(["300", "600", "900"])] * 10


def test_balanced_rigs_go_by_machine_and_are_exact_over_blocks_of_machines() -> None:
    rigs = {"rig": {"balanced": ["gearbox", "fan", "cwru"]}}
    scenarios = draw_all(recipe_of(36, records_per_machine=2, machine=rigs, defect=None))
    by_machine = [scenario.rig for scenario in scenarios[::2]]
    assert [scenario.rig for scenario in scenarios[1::2]] == by_machine
    assert blocks(by_machine, 3) == [Counter(gearbox=1, fan=1, cwru=1)] * 6


def test_a_balanced_record_is_remade_alone() -> None:
    forward = draw_all(recipe_of(20))
    assert draw_scenario(recipe_of(20), 13) == forward[13]


def test_redraws_keep_the_balanced_values() -> None:
    wide = DEFECT | {"line": {"extent_spacing": {"uniform": [0.5, 1.5]}}}
    scenarios = draw_all(recipe_of(60, defect=wide))
    assert any(scenario.redraws for scenario in scenarios)
    assert blocks([scenario.condition for scenario in scenarios], 5) == [Counter(healthy=1, line=2, extended=2)] * 12
    free = wide | {"condition": {"choice": ["healthy", "line", "extended"], "weights": [1, 2, 2]}}
    assert Counter(s.condition for s in draw_all(recipe_of(60, defect=free))) != Counter(
        healthy=12, line=24, extended=24
    )


def test_all_records_of_a_machine_may_share_its_spall_at_their_own_speeds_and_loads() -> None:
    scenarios = draw_all(
        recipe_of(
            24,
            records_per_machine=4,
            defect=DEFECT | {"drawn_for": "machine"},
            operation={"speed_of_rated": {"uniform": [0.5, 1.5]}, "load_of_rated": {"uniform": [0.5, 1.5]}},
        )
    )
    machines = [scenarios[k : k + 4] for k in range(0, 24, 4)]
    for machine in machines:
        assert len({scenario.scene.spalls for scenario in machine}) == 1
        assert len({scenario.scene.operation.shaft_speed for scenario in machine}) == 4
    assert len({machine[0].scene.spalls for machine in machines}) >= 5
    assert Counter(machine[0].condition for machine in machines[:5]) == Counter(healthy=1, line=2, extended=2)


def test_spalls_of_machines_are_balanced_within_each_balanced_rig() -> None:
    rigs = {"rig": {"balanced": ["gearbox", "fan"]}}
    often_refused = DEFECT | {"line": {"extent_spacing": {"uniform": [0.5, 1.5]}}, "drawn_for": "machine"}
    scenarios = draw_all(recipe_of(40, machine=rigs, defect=often_refused))
    assert {redraw.scope for scenario in scenarios for redraw in scenario.redraws} == {"machine"}
    for rig in ("gearbox", "fan"):
        conditions = [scenario.condition for scenario in scenarios if scenario.rig == rig]
        assert blocks(conditions, 5) == [Counter(healthy=1, line=2, extended=2)] * 4


def test_what_is_balanced_about_the_spalls_of_machines_is_exact_within_each_of_their_kinds() -> None:
    depths = {"condition": "line", "extent_deg": 2, "depth_um": {"balanced": [10, 20]}, "drawn_for": "machine"}
    rigs = {"rig": {"balanced": ["gearbox", "fan"]}}
    defect = depths | {"race": DEFECT["race"]}
    scenarios = draw_all(recipe_of(64, records_per_machine=2, machine=rigs, defect=defect))
    of_machines = scenarios[::2]
    assert [scenario.scene.spalls for scenario in scenarios[1::2]] == [one.scene.spalls for one in of_machines]
    for rig in ("gearbox", "fan"):
        for race in ("outer", "inner"):
            alike = [one.scene.spalls[0].depth for one in of_machines if (one.rig, one.location) == (rig, race)]
            assert blocks([f"{depth:g}" for depth in alike], 2) == [Counter({"1e-05": 1, "2e-05": 1})] * 4


def test_the_first_records_of_a_machine_may_be_from_before_its_damage() -> None:
    defect = {"condition": "line", "extent_deg": {"uniform": [1, 3]}, "depth_um": 10, "roughness_um": 1}
    whole = draw_all(recipe_of(12, records_per_machine=3, defect=defect | {"drawn_for": "machine"}))
    partly = draw_all(
        recipe_of(12, records_per_machine=3, defect=defect | {"drawn_for": "machine", "healthy_records": 1})
    )
    assert [scenario.condition for scenario in partly] == ["healthy", "line", "line"] * 4
    for before, after in zip(whole, partly, strict=True):
        assert after.scene.spalls in ((), before.scene.spalls)
        assert (after.bearing_id, after.background, after.split) == (before.bearing_id, before.background, before.split)


def test_a_spall_of_a_machine_that_cannot_be_is_redrawn_with_its_machine() -> None:
    defect = {"condition": "line", "extent_deg": {"uniform": [20, 40]}, "depth_um": 10, "drawn_for": "machine"}
    scenarios = draw_all(recipe_of(40, records_per_machine=2, defect=defect))
    assert {redraw.scope for scenario in scenarios for redraw in scenario.redraws} == {"machine"}
    assert all(
        one.scene.spalls == other.scene.spalls for one, other in zip(scenarios[::2], scenarios[1::2], strict=True)
    )


def test_spalls_of_a_machine_that_lie_on_one_another_are_redrawn_with_their_machine() -> None:
    defect = {"condition": "line", "extent_deg": 20, "depth_um": 10, "count": 4, "drawn_for": "machine"}
    scenarios = draw_all(recipe_of(40, records_per_machine=2, defect=defect))
    redraws = {(redraw.scope, redraw.field) for scenario in scenarios for redraw in scenario.redraws}
    assert redraws == {("machine", "angle")}
    assert all(len(scenario.scene.spalls) == 4 for scenario in scenarios)


def test_a_spall_on_any_row_lies_on_each_row_that_the_bearing_has() -> None:
    line = {"condition": "line", "extent_deg": 2, "depth_um": 10, "row": "any"}
    assert {s.scene.spalls[0].row for s in draw_all(recipe_of(12, defect=line))} == {1, 2}
    even = draw_all(recipe_of(12, defect=line, design="latin_hypercube"))
    assert Counter(scenario.scene.spalls[0].row for scenario in even) == {1: 6, 2: 6}  # a record to each twelfth
    single = draw_all(recipe_of(12, defect=line, machine={"rig": "cwru"}))
    assert {(s.scene.spalls[0].row, len(s.redraws)) for s in single} == {(1, 0)}


def test_the_streams_of_a_block_are_numbered_as_in_every_corpus_made_so_far() -> None:
    opened: list[tuple[int, int]] = []

    def open_block(block: int, path: int) -> np.random.Generator:
        opened.append((block, path))
        return np.random.default_rng(5)

    three, two = (Balanced(options, (1.0,) * len(options)) for options in (("a", "b", "c"), ("p", "q")))
    turns = Turns(Turn(7), open_block)
    first = three.options.index(turns.take(three))
    second = two.options.index(turns.take(two))
    turns.take(two)
    assert (first, second) == (2, 1)  # the number of an option counts, which would not show in the first one's, 0
    code = 1024 + first + 1
    # The eighth comes in the third block of three, after two of its own option: in the second block of two.
    assert opened == [(2, 1), (1, code), (0, (1024 * code + second + 1) % 2**32)]
