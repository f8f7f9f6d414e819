"""Drawn scenarios: pure, order-free, as the recipe says, redrawn where impossible, and never changed by accident."""

from __future__ import annotations

import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.machine_settings import MachineSettings
from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.scenarios.drawn_rig import BEARING_NUMBERS, CONFORMITIES, RATED_NUMBERS, RIG_NUMBERS, STREAM
from datagen.scenarios.redraw import MOST_ATTEMPTS
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.scenarios.scenario_text import scenario_json
from datagen.scenarios.streams import stream
from physics import catalog
from physics.bearing import Bearing
from physics.hertz import contact_width
from physics.paths.roughness import draw_roughness
from physics.rig import Rig

# Our own past: a change here moves every corpus and belongs into datasets/CHANGELOG.md.
PINNED = [
    6.144146194085545e-06,
    109.5902322956786,
    99.19706406828523,
    0.18736294634890868,
    0.006679785774,
    -6.705685407007667e-07,
    0.44830910877247093,
    0.5466750230497484,
    6.49002833446187e-06,
    2.271168762138318,
]
PINNED_WORDS = ("extended", "outer", "train")
HEALTHY: dict[str, Any] = {"name": "p", "records": 40, "machine": {"rig": "gearbox"}}
LINE = {"condition": "line", "extent_deg": 2, "depth_um": 12}
EXTENDED = {"condition": "extended", "extent_deg": 40, "depth_um": 6}
SHORT = {"condition": "line", "extent_mm": 1, "depth_um": 12}
LONG = {"condition": "extended", "extent_mm": 20, "depth_um": 12}
# Has one row at seed 5, but not always, so that nothing is refused beforehand.
ONE_ROW = {"rig": "cwru", "rows": {"choice": [1, 2], "weights": [1, 1e-9]}}


def recipe_of(*parts: dict[str, Any], seed: int = 5, **settings: Any) -> Recipe:
    """A recipe of these parts, 65 536 Hz, 0.1 s."""
    signal = {"rate_hz": 65536, "duration_s": 0.1}
    content = {"name": "r", "seed": seed, "signal": signal, "part": list(parts)} | settings
    return parse_recipe(content, Path("recipe.toml"))


def test_a_record_may_be_numbered_by_numpy() -> None:
    recipe = recipe_of(HEALTHY)
    assert scenario_json(draw_scenario(recipe, np.int64(3))) == scenario_json(draw_scenario(recipe, 3))


def draw(records: int = 1, **settings: Any) -> list[Scenario]:
    """The first scenarios of a part with these settings."""
    recipe = recipe_of(HEALTHY | settings)
    return [draw_scenario(recipe, record) for record in range(records)]


def test_a_scenario_depends_on_recipe_and_record_alone_not_on_order() -> None:
    recipe = recipe_of(HEALTHY | {"defect": EXTENDED | {"roughness_um": 1}, "records_per_machine": 2})
    forward = [draw_scenario(recipe, record) for record in range(6)]
    again = recipe_of(HEALTHY | {"defect": EXTENDED | {"roughness_um": 1}, "records_per_machine": 2})
    assert [draw_scenario(again, record) for record in reversed(range(6))][::-1] == forward


def test_another_seed_gives_other_scenarios() -> None:
    assert draw_scenario(recipe_of(HEALTHY, seed=1), 0).scene != draw_scenario(recipe_of(HEALTHY, seed=2), 0).scene


def test_numbers_left_out_are_the_rigs_and_no_defect_is_healthy() -> None:
    (scenario,) = draw()
    rig = catalog.rig("gearbox")
    assert scenario.scene.rig == rig
    assert scenario.scene.operation.shaft_speed == rig.rated_speed
    assert scenario.scene.operation.load == rig.rated_load
    assert (scenario.condition, scenario.location, scenario.scene.spalls) == ("healthy", "none", ())
    assert scenario.scene.contact_law == "paper"
    assert scenario.background.white_rms == 0.0


def test_a_fixed_spall_arrives_in_si_units() -> None:
    tapers = {"entry_taper_deg": 0.3, "exit_taper_share": 0.1}
    (scenario,) = draw(defect=LINE | tapers | {"race": "inner", "row": 2, "angle_deg": 630})
    (spall,) = scenario.scene.spalls
    assert (spall.race, spall.row, spall.profile) == ("inner", 2, "tukey")
    assert spall.extent == math.radians(2)
    assert spall.depth == 12e-6
    assert spall.entry_taper == math.radians(0.3)
    assert spall.exit_taper == pytest.approx(math.radians(0.2), rel=1e-15)  # one rounding
    assert spall.angle == pytest.approx(math.radians(270), rel=1e-14)  # 630 degrees less a turn
    assert (scenario.condition, scenario.location) == ("line", "inner")


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_the_size_may_be_an_arc_a_length_or_a_share_of_the_spacing(race: str) -> None:
    bearing = catalog.bearing("koyo_1205")
    base = {"condition": "line", "depth_um": 12, "race": race}
    sizes = {"extent_deg": 2.0, "extent_mm": math.radians(2) * bearing.raceway_radius(race) * 1e3}
    sizes["extent_spacing"] = math.radians(2) / bearing.spacing
    extents = [draw(defect=base | {key: value})[0].scene.spalls[0].extent for key, value in sizes.items()]
    assert extents == pytest.approx([math.radians(2)] * 3, rel=1e-14)  # a few roundings


def test_a_spall_on_both_rows_is_the_same_on_each() -> None:
    one, other = draw(defect=EXTENDED | {"row": "both", "roughness_um": 1})[0].scene.spalls
    assert (one.row, other.row) == (1, 2)
    assert (one.angle, one.extent, one.roughness_values) == (other.angle, other.extent, other.roughness_values)


def test_several_spalls_keep_their_separation_and_draw_their_own_size() -> None:
    defect = {"condition": "line", "extent_deg": {"uniform": [1, 3]}, "depth_um": 12, "count": 3, "separation_deg": 90}
    spalls = draw(defect=defect)[0].scene.spalls
    assert [math.degrees(spall.angle) for spall in spalls] == pytest.approx([270, 0, 90], abs=1e-9)  # sums of angles
    assert len({spall.extent for spall in spalls}) == 3


def test_each_further_spall_has_a_stream_and_a_roughness_of_its_own() -> None:
    sizes = {"extent_deg": {"uniform": [1, 3]}, "depth_um": 12, "roughness_um": 1, "profile": "ball_path"}
    (scenario,) = draw(defect={"condition": "line", "count": 3, "separation_deg": 90} | sizes)
    # After row, count and angle, which the first spall settles for all; after the separation, which the others have.
    for spall, item, place in zip(scenario.scene.spalls, range(3), (3, 1, 1), strict=True):
        number = stream(5, "record", 0, "spall", item=item).random(place + 1)[place]
        assert math.degrees(spall.extent) == pytest.approx(1.0 + 2.0 * number)
        generator = stream(5, "record", 0, "roughness", item=item)
        expected = draw_roughness(generator, scenario.scene.rig.bearing, "outer", spall.extent, 1e-6, None)
        assert spall.roughness_values == expected


def test_a_ball_spacing_in_degrees_may_be_rounded_down_in_its_last_figure() -> None:
    spacing = 32.7272727272727  # of 11 balls: 360 / 11, which is more
    assert spacing < 360 / 11
    (scenario,) = draw(machine={"rig": "gearbox", "balls": 11}, defect=EXTENDED | {"extent_deg": spacing})
    assert scenario.condition == "extended"


def test_of_several_spalls_the_largest_makes_a_record_extended() -> None:
    defect = {"condition": "extended", "count": 2, "separation_deg": 90, "extent_spacing": {"uniform": [0.5, 1.5]}}
    scenarios = draw(20, defect=defect | {"depth_um": 6})
    extents = np.array([[spall.extent for spall in scenario.scene.spalls] for scenario in scenarios])
    spacing = scenarios[0].scene.rig.bearing.spacing
    assert (extents.max(axis=1) >= spacing).all()
    assert (extents[:, 0] < spacing).any()


@pytest.mark.parametrize(("profile", "share"), [("tukey", 0.1), ("ball_path", 0.0)])
def test_tapers_left_out_are_a_tenth_of_the_spall_where_no_ball_is_rolled_over_it(profile: str, share: float) -> None:
    (spall,) = draw(defect=EXTENDED | {"profile": profile})[0].scene.spalls
    assert (spall.entry_taper, spall.exit_taper) == pytest.approx([share * math.radians(40)] * 2)


def test_tapers_that_meet_are_refused_for_no_rounding() -> None:
    arcs = {"extent_deg": {"uniform": [1, 3]}, "entry_taper_share": 0.9, "exit_taper_share": 0.1}
    scenarios = draw(40, defect=LINE | arcs)
    spalls = [scenario.scene.spalls[0] for scenario in scenarios]
    assert any(spall.entry_taper + spall.exit_taper > spall.extent for spall in spalls)
    assert not any(scenario.redraws for scenario in scenarios)


def test_a_spall_may_cover_half_a_turn_and_a_taper_the_whole_spall() -> None:
    half_turn = EXTENDED | {"extent_deg": 180, "entry_taper_deg": 180, "exit_taper_deg": 0}
    (scenario,) = draw(defect=half_turn)
    assert scenario.redraws == ()
    assert (scenario.scene.spalls[0].extent, scenario.scene.spalls[0].entry_taper) == (math.pi, math.pi)


def test_the_settings_of_the_operation_take_one_number_each_in_the_order_of_their_table() -> None:
    high = {"speed_of_rated": 1, "load_of_rated": 1, "unbalance_n": 1, "unbalance_phase_deg": 1, "load_fluctuation": 1}
    high |= {"fluctuation_phase_deg": 1, "cage_angle_deg": 1, "second_cage_angle_deg": 1}
    high |= {"mean_slip": 0.1, "slip_deviation": 0.05, "slip_correlation_passes": 1}
    low = {"speed_of_rated": 0.1, "slip_correlation_passes": 0.1}
    ranges = {name: {"uniform": [low.get(name, 0), end]} for name, end in high.items()}
    machine = {"rig": "gearbox", "separate_cages": True}
    scenario = draw(machine=machine, operation=ranges)[0]
    run, scene = scenario.scene.operation, scenario.scene
    rig, second = scene.rig, scene.second_cage
    assert second is not None
    passes = scenario.slip_correlation_time * scene.cage.nominal_speed / rig.bearing.spacing
    found = [run.shaft_speed / rig.rated_speed, run.load / rig.rated_load, run.unbalance_force]
    found += [math.degrees(run.unbalance_phase), run.load_fluctuation, math.degrees(run.fluctuation_phase)]
    found += [math.degrees(scene.cage.start_angle), math.degrees(second.start_angle)]
    found += [scene.cage.mean_slip, scenario.slip_deviation, passes]
    numbers = stream(5, "record", 0, "operation").random(len(high))
    expected = [
        low.get(name, 0) + number * (end - low.get(name, 0))
        for (name, end), number in zip(high.items(), numbers, strict=True)
    ]
    assert found == pytest.approx(expected)


def test_overlapping_spalls_are_drawn_again() -> None:
    scenarios = draw(20, defect=EXTENDED | {"count": 3})
    assert any(redraw.field == "angle" for scenario in scenarios for redraw in scenario.redraws)
    for scenario in scenarios:
        angles = sorted(spall.angle for spall in scenario.scene.spalls)
        gaps = [(b - a) % (2 * math.pi) for a, b in zip(angles, [*angles[1:], angles[0]], strict=True)]
        assert min(gaps) >= math.radians(40)


def test_a_measured_table_gives_its_own_extent_and_depth(tmp_path: Path) -> None:
    (tmp_path / "pit.csv").write_text("angle_deg,depth_um\n0,0\n1,30\n3,0\n")
    part = HEALTHY | {"defect": {"condition": "line", "profile": "table", "table": "pit.csv"}}
    content = {"name": "r", "seed": 1, "signal": {"rate_hz": 65536, "duration_s": 1}, "part": [part]}
    (spall,) = draw_scenario(parse_recipe(content, tmp_path / "recipe.toml"), 0).scene.spalls
    assert (spall.profile, spall.extent, spall.depth) == ("table", math.radians(3), 3e-5)
    assert spall.table_depth == (0.0, 3e-5, 0.0)


def test_roughness_is_low_passed_at_the_contact_width_only_where_no_ball_is_rolled_over_it() -> None:
    for profile in ("tukey", "ball_path"):
        (scenario,) = draw(defect=EXTENDED | {"profile": profile, "roughness_um": 2})
        (spall,) = scenario.scene.spalls
        bearing = scenario.scene.rig.bearing
        width = contact_width(bearing, "outer", bearing.stribeck_peak_load(346.0)) if profile == "tukey" else None
        expected = draw_roughness(scenario.generator("roughness"), bearing, "outer", spall.extent, 2e-6, width)
        assert spall.roughness_values == expected


def test_without_a_load_there_is_no_contact_width_to_smooth_the_roughness_of_a_hand_set_path_over() -> None:
    part = {"operation": {"load_n": 0}}
    with pytest.raises(BadInput, match=r"load_n = 0.*static load of 0 N .* profile tukey .* or profile ball_path"):
        draw(defect=EXTENDED | {"roughness_um": 2}, **part)
    (scenario,) = draw(defect=EXTENDED | {"roughness_um": 2, "profile": "ball_path"}, **part)
    assert scenario.scene.spalls[0].roughness_values


def test_records_of_one_machine_share_what_belongs_to_it_and_nothing_else() -> None:
    scenarios = draw(
        6,
        records_per_machine=3,
        machine={"rig": {"choice": ["gearbox", "fan"]}, "clearance_um": {"uniform": [0, 9]}},
        background={"white_rms_m_s2": {"log_uniform": [0.01, 1]}},
        imperfections={"ball_deviation_um": {"normal": [0, 0.5]}},
        operation={"speed_of_rated": {"uniform": [0.5, 1.5]}},
    )
    shared = [(s.bearing_id, s.split, s.scene.rig, s.background, s.scene.imperfections) for s in scenarios]
    assert shared[0] == shared[1] == shared[2]
    assert shared[3] == shared[4] == shared[5]
    assert all(a != b for a, b in zip(shared[0][2:], shared[3][2:], strict=True))
    assert len({scenario.scene.operation.shaft_speed for scenario in scenarios}) == 6
    assert len({scenario.scene.cage.knot_values for scenario in scenarios}) == 6


def test_fixing_a_setting_that_was_drawn_moves_no_other() -> None:
    load = {"load_of_rated": {"uniform": [0.5, 1.5]}}
    drawn = draw(operation={"speed_of_rated": {"uniform": [0.5, 1.5]}, **load})[0].scene
    fixed = draw(operation={"speed_of_rated": 1.25, **load})[0].scene
    assert drawn.operation.load == fixed.operation.load
    assert drawn.cage.start_angle == fixed.cage.start_angle
    assert drawn.operation.shaft_speed != fixed.operation.shaft_speed


def test_a_machine_that_is_drawn_again_keeps_its_split() -> None:
    """Otherwise machines that are often impossible would be rarer in one split than in another."""
    settings: dict[str, Any] = {"records": 24, "records_per_machine": 1}
    often = recipe_of(HEALTHY | settings | {"machine": {"rig": "gearbox", "balls": {"choice": [12, 40]}}})
    never = recipe_of(HEALTHY | settings | {"machine": {"rig": "gearbox", "balls": 12}})
    drawn = [draw_scenario(often, record) for record in range(24)]
    assert sum(scenario.seeds.machine_attempt > 0 for scenario in drawn) > 6  # 40 balls do not fit
    assert [scenario.split for scenario in drawn] == [draw_scenario(never, record).split for record in range(24)]
    assert len({scenario.split for scenario in drawn}) > 1


def test_that_the_load_is_carried_is_asked_where_the_simulation_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[float] = []
    monkeypatch.setattr("datagen.scenarios.sampling.require_equilibrium", lambda scene, start: asked.append(start))
    draw_scenario(recipe_of(HEALTHY, signal={"rate_hz": 65536, "duration_s": 0.1, "settle_s": 0.25}), 0)
    assert asked == [-0.25]


def test_splits_are_drawn_by_machine_in_the_stated_shares() -> None:
    part = HEALTHY | {"records": 2000, "operation": {"slip_deviation": 0}}
    recipe = recipe_of(part, split={"train": 0.5, "validation": 0.3, "test": 0.2})
    splits = [draw_scenario(recipe, record).split for record in range(2000)]
    for name, share in (("train", 0.5), ("validation", 0.3), ("test", 0.2)):
        # four standard deviations of a binomial share of 2000
        assert splits.count(name) / 2000 == pytest.approx(share, abs=4 * math.sqrt(share * (1 - share) / 2000))


def test_slip_is_off_at_zero_deviation_and_separate_cages_slip_apart() -> None:
    assert draw(operation={"slip_deviation": 0, "cage_angle_deg": 0})[0].scene.cage.knot_values == ()
    scene = draw(machine={"rig": "gearbox", "separate_cages": True})[0].scene
    assert scene.second_cage is not None
    assert scene.second_cage.knot_values != scene.cage.knot_values
    assert scene.second_cage.start_angle != scene.cage.start_angle
    assert draw(machine={"rig": "cwru", "separate_cages": True})[0].scene.second_cage is None


def test_the_cages_of_both_rows_start_at_the_angles_that_are_stated_for_them() -> None:
    operation = {"cage_angle_deg": 30, "second_cage_angle_deg": 90}
    scene = draw(machine={"rig": "gearbox", "separate_cages": True}, operation=operation)[0].scene
    assert scene.second_cage is not None
    assert scene.cage.start_angle == pytest.approx(math.pi / 6.0, rel=1e-15)  # one rounding
    assert scene.second_cage.start_angle == pytest.approx(math.pi / 2.0, rel=1e-15)


def test_an_unbalance_grade_gives_a_load_of_mass_times_grade_times_speed() -> None:
    operation = {"speed_rpm": {"uniform": [300, 3000]}, "unbalance_grade_mm_per_s": 6.3, "slip_deviation": 0}
    for scenario in draw(5, machine={"rig": "fan"}, operation=operation):
        run = scenario.scene.operation
        assert run.unbalance_force == pytest.approx(6.3e-3 * 2.0 * run.shaft_speed, rel=1e-14)  # m e ω² with e ω = G


def test_the_correlation_time_is_in_nominal_ball_passes() -> None:
    (scenario,) = draw(operation={"slip_correlation_passes": 2})
    bearing = scenario.scene.rig.bearing
    passes_per_second = bearing.bpfo * scenario.scene.operation.shaft_speed / (2 * math.pi)
    assert scenario.slip_correlation_time == pytest.approx(2 / passes_per_second, rel=1e-14)  # a few roundings


NUMBERS = (*BEARING_NUMBERS, *CONFORMITIES, *RIG_NUMBERS, *RATED_NUMBERS)


def test_every_number_of_rig_and_bearing_can_be_set() -> None:
    settable = {field for _, field, _ in NUMBERS} | {"balls", "rows", "bearing"}
    assert {field.name for owner in (Bearing, Rig) for field in fields(owner)} - settable == {"name"}
    assert sorted((*STREAM, "factors")) == sorted(MachineSettings.model_fields)


OVERRIDES = {
    "pitch_diameter_mm": (39.5, 0.0395),
    "ball_diameter_mm": (7.0, 0.007),
    "contact_angle_deg": (9.0, math.pi / 20),
    "row_offset_deg": (9.0, math.pi / 20),
    "load_deflection_n_per_m_to_n": (5.5e9, 5.5e9),
    "exponent": (1.4, 1.4),
    "clearance_um": (-2.5, -2.5e-6),
    "inner_mass_kg": (0.7, 0.7),
    "outer_mass_kg": (9.5, 9.5),
    "resonator_mass_kg": (0.4, 0.4),
    "support_stiffness_x_n_per_m": (1.1e7, 1.1e7),
    "support_stiffness_y_n_per_m": (1.2e7, 1.2e7),
    "resonator_stiffness_n_per_m": (1.9e9, 1.9e9),
    "support_damping_x_n_s_per_m": (601.0, 601.0),
    "support_damping_y_n_s_per_m": (602.0, 602.0),
    "resonator_damping_n_s_per_m": (303.0, 303.0),
    "film_damping_n_s_per_m": (90.0, 90.0),
    "inner_conformity": (0.51, 0.51),
    "outer_conformity": (0.53, 0.53),
    "rated_speed_rpm": (600.0, 20 * math.pi),
    "rated_load_n": (500.0, 500.0),
}


@pytest.mark.parametrize(("setting", "field"), [(setting, field) for setting, field, _ in NUMBERS])
def test_an_override_lands_in_its_field_in_si_units(setting: str, field: str) -> None:
    given, expected = OVERRIDES[setting]
    drawn = draw(machine={"rig": "gearbox", setting: given})[0].scene.rig
    owner = drawn if hasattr(drawn, field) else drawn.bearing
    assert getattr(owner, field) == pytest.approx(expected, rel=1e-15)  # one division


def test_another_number_of_balls_takes_half_its_own_spacing_as_stagger() -> None:
    bearing = draw(machine={"rig": "gearbox", "balls": 11})[0].scene.rig.bearing
    assert bearing.stagger == math.pi / 11
    bearing = draw(machine={"rig": "gearbox", "balls": 11, "row_offset_deg": 9})[0].scene.rig.bearing
    assert bearing.stagger == pytest.approx(math.pi / 20)


def test_a_catalogue_bearing_may_be_given_another_number_of_rows() -> None:
    assert [draw(machine={"rig": "gearbox", "rows": rows})[0].scene.rig.bearing.rows for rows in (1, 2)] == [1, 2]


def test_waviness_falls_with_its_order() -> None:
    wave = {"race": "inner", "orders": [2, 5], "amplitude_um": 0.4, "decay": 2}
    waves = draw(imperfections={"waviness": [wave]})[0].scene.imperfections.waviness
    assert [w.order for w in waves] == [2, 3, 4, 5]
    assert [w.amplitude for w in waves] == pytest.approx([0.4e-6 * (2 / k) ** 2 for k in (2, 3, 4, 5)])
    assert len({w.phase for w in waves}) == 4


def test_balls_and_waves_have_a_scale_of_their_own() -> None:
    waves = [{"race": "inner", "orders": [2, 2], "amplitude_um": 0.4}]
    scales = {"ball_deviation_scale": 3, "waviness_scale": 5}
    found = draw(imperfections={"ball_deviation_um": 0.1, "waviness": waves} | scales)[0].scene.imperfections
    assert [value for row in found.ball_deviation for value in row] == pytest.approx([0.3e-6] * 24)
    assert [wave.amplitude for wave in found.waviness] == pytest.approx([2e-6])


def test_waves_and_deviations_of_nothing_are_none() -> None:
    wave = {"race": "inner", "orders": [2, 9], "amplitude_um": {"choice": [0, 0.4]}}
    found = draw(imperfections={"ball_deviation_um": 0, "waviness": [wave]})[0].scene.imperfections
    assert found.ball_deviation == ()
    assert 0 < len(found.waviness) < 8
    assert all(wave.amplitude > 0.0 for wave in found.waviness)


def test_impossible_draws_are_redrawn_and_counted_with_their_reason() -> None:
    defect = {"condition": "line", "extent_deg": {"uniform": [20, 40]}, "depth_um": 12}
    scenarios = draw(40, defect=defect)
    redraws = [redraw for scenario in scenarios for redraw in scenario.redraws]
    assert {redraw.field for redraw in redraws} == {"extent"}
    assert "reaches the ball spacing of 30 degrees" in redraws[0].reason
    assert 15 < len(redraws) < 80  # half of all draws are impossible: 40 ± 4 standard deviations of √80
    for scenario in scenarios:
        assert scenario.seeds.record_attempt == len(scenario.redraws)
        assert scenario.condition == "line"


def test_a_spall_with_neither_depth_nor_roughness_is_drawn_again() -> None:
    scenarios = draw(40, defect=LINE | {"depth_um": {"choice": [0, 12]}, "roughness_um": {"choice": [0, 1]}})
    spalls = [spall for scenario in scenarios for spall in scenario.scene.spalls]
    assert {(spall.depth > 0.0, spall.roughness > 0.0) for spall in spalls} == {
        (True, True),
        (True, False),
        (False, True),
    }
    redraws = [redraw for scenario in scenarios for redraw in scenario.redraws]
    assert redraws
    assert all((redraw.field, "neither depth" in redraw.reason) == ("depth", True) for redraw in redraws)


def test_an_impossible_machine_is_redrawn_once_for_all_its_records() -> None:
    machine = {"rig": "gearbox", "ball_diameter_mm": {"uniform": [8, 12]}}
    scenarios = draw(20, machine=machine, records_per_machine=2)
    assert {redraw.scope for scenario in scenarios for redraw in scenario.redraws} == {"machine"}
    assert all(
        a.scene.rig == b.scene.rig and a.redraws == b.redraws for a, b in zip(*[iter(scenarios)] * 2, strict=True)
    )
    assert all("do not fit" in redraw.reason for scenario in scenarios for redraw in scenario.redraws)


@pytest.mark.parametrize(
    ("settings", "setting", "words"),
    [
        ({"machine": {"rig": "gearbox", "ball_diameter_mm": 20}}, "machine.ball_diameter_mm = 20.0", "do not fit"),
        ({"machine": {"rig": "gearbox", "balls": 60}}, "machine.balls = 60", "60 balls of 7.120 mm do not fit"),
        (
            {"defect": LONG | {"condition": "line"}},
            "defect.extent_mm = 20.0",
            "reaches the ball spacing of 30 degrees; allowed: below 30 degrees",
        ),
        ({"defect": SHORT | {"condition": "extended"}}, "defect.extent_mm = 1.0", "allowed: at least 30 degrees"),
        (
            {"defect": LONG | {"extent_mm": 100}},
            "defect.extent_mm = 100.0",
            "the spall covers 249.8 degrees; allowed: at most 180 degrees, on this raceway 72.05 mm or 6 ball spacings",
        ),
        (
            {"defect": SHORT | {"entry_taper_deg": 20}},
            "defect.entry_taper_deg = 20.0",
            "the entry taper of 20 degrees is longer than the spall of 2.498 degrees",
        ),
        (
            {"defect": SHORT | {"exit_taper_deg": 2, "entry_taper_share": 0.5}},
            "defect.entry_taper_share = 0.5",
            "entry and exit taper of 1.249 and 2 degrees are together longer than the spall of 2.498 degrees",
        ),
        (
            {"defect": SHORT | {"count": 2, "separation_deg": 1.5}},
            "defect.separation_deg = 1.5",
            "overlap: 1.5 degrees apart",
        ),
        ({"defect": LINE | {"row": 2}, "machine": ONE_ROW}, "defect.row = 2", "spall on row 2"),
        (
            {"operation": {"load_n": 1e7}, "machine": {"rig": "gearbox", "load_deflection_n_per_m_to_n": 1e4}},
            "operation.load_n = 10000000.0",
            "carries the load",
        ),
    ],
)
def test_what_can_never_be_drawn_is_given_up_with_its_setting_and_the_reason(
    settings: dict[str, Any], setting: str, words: str
) -> None:
    with pytest.raises(BadInput) as caught:
        draw(**settings)
    message = str(caught.value)
    assert message.startswith(f"recipe.toml: part[1].{setting}: ")
    assert f"all {MOST_ATTEMPTS} draws were impossible for the same reason: " in message
    assert words in message


def test_the_band_is_the_rigs_resonance_unless_the_recipe_says_otherwise() -> None:
    low, high = draw()[0].envelope_band
    assert low < 10548 < high  # the coupled resonator of the gearbox rig
    signal = {"rate_hz": 65536, "duration_s": 0.1, "envelope_band_hz": [1000, 2000]}
    assert draw_scenario(recipe_of(HEALTHY, signal=signal), 0).envelope_band == (1000.0, 2000.0)


def test_a_record_too_short_for_a_line_of_its_spectrum_in_the_resonance_is_refused() -> None:
    part = HEALTHY | {"machine": {"rig": "ims"}}  # the band from 4364 to 4824 Hz
    signal = {"rate_hz": 65536, "duration_s": 66 / 65536}  # lines at 3972 and 4965 Hz
    with pytest.raises(BadInput, match=r"4364 to 4824 Hz, holds none of the lines in the spectrum of 66 .* 992\.97"):
        draw_scenario(recipe_of(part, signal=signal), 0)
    signal = {"rate_hz": 65536, "duration_s": 70 / 65536}  # a line at 4681 Hz
    assert draw_scenario(recipe_of(part, signal=signal), 0).samples == 70


def test_a_resonance_that_is_not_recorded_needs_a_band_of_ones_own() -> None:
    slow = {"rate_hz": 16384, "duration_s": 0.1}
    altered = HEALTHY | {"machine": {"rig": "gearbox", "factors": {"resonator_mass": 1}}}
    with pytest.raises(BadInput, match="rings at 10548 Hz, too high for a sampling rate of 16384 Hz; allowed: rate_hz"):
        draw_scenario(recipe_of(altered, signal=slow), 0)
    assert draw_scenario(recipe_of(HEALTHY, signal=slow | {"envelope_band_hz": [500, 4000]}), 0).rate == 16384
    # Its band reaches 5 % to either side: to 11075 Hz, of which 10 500 Hz are recorded.
    with pytest.raises(BadInput, match=r"rings at 10548 Hz.*; allowed: rate_hz above 2215[01], or an"):
        draw_scenario(recipe_of(altered, signal={"rate_hz": 21000, "duration_s": 0.1}), 0)


def test_a_record_may_be_as_short_as_sixteen_samples() -> None:
    signal = {"rate_hz": 16000, "duration_s": 0.001, "envelope_band_hz": [1000, 7000]}
    assert draw_scenario(recipe_of(HEALTHY, signal=signal), 0).samples == 16


def test_the_duration_is_rounded_to_whole_samples() -> None:
    scenario = draw_scenario(recipe_of(HEALTHY, signal={"rate_hz": 65536, "duration_s": 0.4}), 0)
    assert scenario.samples == 26214
    assert scenario.duration == 26214 / 65536


def test_the_numbers_drawn_for_a_seed_never_change() -> None:
    (scenario,) = draw(
        machine={"rig": "fan", "clearance_um": {"uniform": [0, 9]}},
        operation={"speed_of_rated": {"uniform": [0.5, 1.5]}, "load_of_rated": {"normal": [1, 0.2]}},
        background={"white_rms_m_s2": {"log_uniform": [0.01, 1]}},
        imperfections={"ball_deviation_um": {"normal": [0, 0.5]}},
        defect={
            "condition": {"choice": ["line", "extended"]},
            "race": {"choice": ["outer", "inner"]},
            "extent_spacing": {"uniform": [0.1, 0.3]},
            "depth_um": {"uniform": [5, 10]},
            "extended": {"extent_spacing": {"uniform": [1, 2]}},
        },
    )
    scene = scenario.scene
    (spall,) = scene.spalls
    found = [
        scene.rig.bearing.clearance,
        scene.operation.shaft_speed,
        scene.operation.load,
        scene.cage.start_angle,
        scene.cage.knot_values[7],
        scene.imperfections.ball_deviation[1][3],
        scenario.background.white_rms,
        spall.extent,
        spall.depth,
        float(scenario.generator("white_noise").standard_normal()),
    ]
    assert found == pytest.approx(PINNED, rel=1e-12)  # elementary functions may differ in the last bits elsewhere
    assert (scenario.condition, scenario.location, scenario.split) == PINNED_WORDS
