"""The recipes that come with spallgen: the reference scenes first, then what the dataset promises."""

from __future__ import annotations

import math
import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import load_recipe
from datagen.recipes.recipe_files import shipped_recipes
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from physics import catalog
from physics.spall import Spall

REFERENCES = ["0", "1", "1s", "1p", "2", *["2r"] * 10]


PAGE = (Path(__file__).parents[2] / "datasets" / "README.md").read_text(encoding="utf-8")


def scenarios(name: str) -> list[Scenario]:
    """Every scenario of a dataset."""
    recipe = load_recipe(name)
    return [draw_scenario(recipe, record) for record in range(recipe.count)]


def test_the_promised_datasets_are_shipped() -> None:
    promised = {"corpus", "fan_rig", "gearbox_rig", "quickstart", "transfer"}
    assert promised | {"size_ladder", "size_training", "size_imperfect"} <= set(shipped_recipes())


@pytest.mark.parametrize(
    ("name", "rig", "letter", "line_deg", "speed", "load", "clearance"),
    [
        ("gearbox_rig", "gearbox", "G", 2.0, 2 * math.pi * 7, 346.0, 0.0),
        ("fan_rig", "fan", "F", 2.6, 2 * math.pi * 800 / 60, 100.0, 3e-6),
    ],
)
def test_a_rigs_dataset_starts_with_the_reference_scenes(
    name: str, rig: str, letter: str, line_deg: float, speed: float, load: float, clearance: float
) -> None:
    drawn = scenarios(name)[: len(REFERENCES)]
    assert [scenario.part for scenario in drawn] == [letter + label for label in REFERENCES]
    for scenario in drawn:
        scene = scenario.scene
        assert scene.rig == catalog.rig(rig)
        assert scene.rig.bearing.clearance == clearance
        assert (scene.operation.shaft_speed, scene.operation.load) == (pytest.approx(speed, rel=1e-15), load)
        assert (scene.operation.unbalance_force, scene.operation.load_fluctuation) == (0.0, 0.0)
        assert (scene.cage.knot_values, scene.cage.mean_slip, scene.cage.start_angle) == ((), 0.0, 0.0)
        assert (scenario.rate, scenario.duration, scenario.background.white_rms) == (65536.0, 0.5, 0.0)
        assert scene.imperfections.waviness == scene.imperfections.ball_deviation == ()
        assert scene.contact_law == "paper"
    healthy, *defective = (scenario.scene.spalls for scenario in drawn)
    assert healthy == ()
    line, arc, taper = math.radians(line_deg), math.radians(40), math.radians(0.3)
    for spalls, expected in zip(
        defective,
        [
            (line, 12e-6, taper, taper, "tukey"),
            (line, 12e-6, 0.9 * line, 0.1 * line, "tukey"),
            (line, 200e-6, 0.0, 0.0, "ball_path"),
            (arc, 4e-6, math.radians(1), math.radians(1), "tukey"),
            *[(arc, 6e-6, math.radians(1), math.radians(1), "tukey")] * 10,
        ],
        strict=True,
    ):
        (spall,) = spalls
        assert (spall.race, spall.row, spall.angle) == ("outer", 1, math.radians(270))
        assert (spall.extent, spall.depth, spall.entry_taper, spall.exit_taper, spall.profile) == expected
    rough = [spalls[0] for spalls in defective[4:]]
    assert all(spall.roughness == 2e-6 for spall in rough)
    assert len({spall.roughness_values for spall in rough}) == 10
    assert all(spalls[0].roughness_values == () for spalls in defective[:4])


@pytest.mark.parametrize("name", ["gearbox_rig", "fan_rig"])
def test_a_rigs_dataset_goes_on_with_all_conditions_both_races_and_both_profiles(name: str) -> None:
    drawn = scenarios(name)[len(REFERENCES) :]
    assert 180 <= len(drawn) <= 220
    classes = Counter((scenario.condition, scenario.location) for scenario in drawn)
    assert min(classes.values()) >= 20
    assert set(classes) == {("healthy", "none"), *((c, r) for c in ("line", "extended") for r in ("outer", "inner"))}
    spalls = [spall for scenario in drawn for spall in scenario.scene.spalls]
    assert {spall.profile for spall in spalls} == {"tukey", "ball_path"}
    assert all(scenario.background.white_rms > 0.0 for scenario in drawn)
    machines = Counter(scenario.bearing_id for scenario in drawn)
    assert set(machines.values()) == {5}


@pytest.mark.parametrize("name", ["quickstart", "gearbox_rig", "fan_rig"])
def test_drawn_sizes_leave_a_clear_gap_between_line_and_extended(name: str) -> None:
    for scenario in scenarios(name):
        shares = [spall.extent / scenario.scene.rig.bearing.spacing for spall in scenario.scene.spalls]
        assert all(0.02 <= share <= 0.31 or share >= 1.0 for share in shares)


def test_the_quick_start_holds_sixty_records_of_both_rigs_with_every_class_in_every_split() -> None:
    drawn = scenarios("quickstart")
    assert len(drawn) == 60
    classes = Counter((scenario.rig, scenario.condition, scenario.location) for scenario in drawn)
    assert len(classes) == 10
    assert min(classes.values()) >= 5
    assert len({(scenario.split, scenario.condition) for scenario in drawn}) == 9
    store = load_recipe("quickstart").store
    assert (store.clean, store.cage_angle, store.profile, store.contact_force) == (True, True, True, "first_of_each")


def test_outer_spalls_of_the_datasets_lie_near_the_load_zone() -> None:
    spalls: list[Spall] = [s.scene.spalls[0] for s in scenarios("quickstart") if s.location == "outer"]
    assert all(math.radians(225) <= spall.angle <= math.radians(315) for spall in spalls)


def test_the_size_ladder_spans_lengths_tapers_loads_speeds_and_noises_in_the_shares_it_states() -> None:
    recipe = load_recipe("size_ladder")
    # Every fifth record of the parts with spalls shorter than the spacing: enough for shares, quick to draw.
    drawn = [draw_scenario(recipe, record) for record in range(0, 1200, 5)]
    spalls = [scenario.scene.spalls[0] for scenario in drawn]
    spacings = [s.extent / scenario.scene.rig.bearing.spacing for s, scenario in zip(spalls, drawn, strict=True)]
    lengths = [spall.length(scenario.scene.rig.bearing) for spall, scenario in zip(spalls, drawn, strict=True)]
    assert min(lengths) >= 0.3e-3 * (1.0 - 1e-12)
    assert max(spacings) <= 0.9 + 1e-3  # 0.9 spacings are stated in mm, rounded to 0.01 mm
    # Log-uniform: about half lie below the geometric mean of the ends (1.7 mm or so); 5 standard deviations of 240.
    assert abs(sum(length < 1.75e-3 for length in lengths) / len(lengths) - 0.5) < 0.17
    shares = [(spall.entry_taper / spall.extent, spall.exit_taper / spall.extent) for spall in spalls]
    assert all(0.05 <= entry <= 0.9 and 0.02 <= leave <= 0.2 for entry, leave in shares)
    loads = [scenario.scene.operation.load / scenario.scene.rig.rated_load for scenario in drawn]
    speeds = [scenario.scene.operation.shaft_speed * 30.0 / math.pi for scenario in drawn]
    assert (min(loads) >= 0.2, max(loads) <= 5.0, min(speeds) >= 300.0, max(speeds) <= 3000.0) == (True,) * 4
    noises = Counter(scenario.noise_target.ratio_db for scenario in drawn if scenario.noise_target is not None)
    assert set(noises) == {200.0, 20.0, 10.0, 5.0, 0.0}
    assert all(0.1 < count / len(drawn) < 0.3 for count in noises.values())  # equal shares, 4 deviations of 240 records
    assert {spall.race for spall in spalls} == {"outer", "inner"}
    assert {spall.profile for spall in spalls} == {"tukey", "ball_path"}
    longest = [draw_scenario(recipe, record) for record in range(1200, 1344, 6)]
    extents = [scenario.scene.spalls[0].extent / scenario.scene.rig.bearing.spacing for scenario in longest]
    assert (min(extents) >= 0.9, max(extents) <= 2.0, max(extents) > 1.5) == (True, True, True)


def test_the_size_training_is_for_training_only_and_shares_no_machine_with_the_ladder() -> None:
    recipe, ladder = load_recipe("size_training"), load_recipe("size_ladder")
    drawn = [draw_scenario(recipe, record) for record in range(0, recipe.count, 40)]
    assert {scenario.split for scenario in drawn} == {"train"}
    assert recipe.seed != ladder.seed
    theirs = [draw_scenario(ladder, record) for record in range(0, ladder.count, 40)]
    rigs = [{scenario.scene.rig for scenario in scenarios} for scenarios in (drawn, theirs)]
    assert not rigs[0] & rigs[1]
    wide = [s.scene.spalls[0].extent / s.scene.rig.bearing.spacing for s in drawn if s.part.endswith("wide")]
    assert len(wide) > 5
    assert all(0.4 <= share <= 0.9 for share in wide)


def test_the_imperfect_bearings_are_for_training_only_and_hold_spalls_of_every_size() -> None:
    recipe = load_recipe("size_imperfect")
    drawn = [draw_scenario(recipe, record) for record in range(0, recipe.count, 20)]
    assert {scenario.split for scenario in drawn} == {"train"}
    assert recipe.seed not in {load_recipe(name).seed for name in ("size_ladder", "size_training")}
    assert all(scenario.scene.imperfections.waviness for scenario in drawn)
    spalls = [(spall, scenario.scene.rig.bearing) for scenario in drawn for spall in scenario.scene.spalls]
    shares = np.array([spall.extent / bearing.spacing for spall, bearing in spalls])
    assert (shares.min() < 0.04, shares.max() > 1.0) == (True, True)
    assert 0.3 < np.mean(shares < 0.15) < 0.7  # log-uniform: half of the line spalls, and few are extended


def test_all_of_the_recipe_in_the_page_but_its_defect_must_be_given(tmp_path: Path) -> None:
    (recipe,) = re.findall(r"^```toml\n(name = .*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    path, lines = tmp_path / "recipe.toml", recipe.splitlines()
    path.write_text(recipe)
    draw_scenario(load_recipe(path), 0)
    spared = []
    for line in filter(str.strip, lines):
        path.write_text("\n".join(one for one in lines if one != line))
        try:
            load_recipe(path)
        except BadInput:
            continue
        spared.append(line.split(" = ")[0])
    assert spared == ["defect"]
