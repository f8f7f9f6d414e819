"""Drawn rigs and bearings: K by Hertz, stiffness from frequency and mass, deviations of the catalogue, refusals."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import parse_recipe
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.scenarios.scenario_text import scenario_json, scenario_of
from physics import catalog
from physics.hertz import load_deflection_factor, roller_load_deflection_factor
from physics.modes import modes, rated_matrices
from physics.rating import static_load_rating
from physics.rig import Rig

BEARING = {
    "bearing": "drawn",
    "rows": {"choice": [1, 2]},
    "pitch_diameter_mm": {"log_uniform": [30, 100]},
    "ball_diameter_of_pitch": {"uniform": [0.15, 0.25]},
    "fill": {"uniform": [0.7, 1.0]},
    "clearance_um": {"uniform": [0, 10]},
    "inner_conformity": {"uniform": [0.505, 0.53]},
    "outer_conformity": {"uniform": [0.51, 0.54]},
}
RIG = {
    "rig": "drawn",
    "inner_mass_kg": {"log_uniform": [0.5, 20]},
    "outer_mass_kg": {"log_uniform": [2, 20]},
    "resonator_mass_kg": {"log_uniform": [0.05, 0.5]},
    "support_frequency_hz": {"log_uniform": [200, 1500]},
    "support_stiffness_x_over_y": {"uniform": [0.5, 2]},
    "support_damping_ratio": {"uniform": [0.01, 0.05]},
    "resonator_frequency_hz": {"uniform": [4000, 12000]},
    "resonator_damping_ratio": {"uniform": [0.005, 0.03]},
    "film_damping_us": {"log_uniform": [2.5, 25]},
    "rated_speed_rpm": 1500,
    "rated_load_of_static_rating": {"log_uniform": [0.005, 0.05]},
}


def draw(records: int = 1, **machine: Any) -> list[Scenario]:
    """Healthy scenarios on machines with these settings."""
    part = {"name": "p", "records": records, "machine": machine}
    content = {"name": "r", "seed": 4, "signal": {"rate_hz": 65536, "duration_s": 0.05}, "part": [part]}
    recipe = parse_recipe(content, Path("recipe.toml"))
    return [draw_scenario(recipe, record) for record in range(records)]


def rigs(records: int = 1, **machine: Any) -> list[Rig]:
    return [scenario.scene.rig for scenario in draw(records, **machine)]


def test_a_drawn_machine_takes_every_number_from_the_recipe() -> None:
    for scenario in draw(30, **BEARING, **RIG):
        rig, bearing = scenario.scene.rig, scenario.scene.rig.bearing
        assert (scenario.rig, scenario.bearing) == ("drawn", "drawn")
        assert 0.03 <= bearing.pitch_diameter <= 0.1
        assert 0.15 <= bearing.ball_diameter / bearing.pitch_diameter <= 0.25
        assert 0.505 <= bearing.inner_conformity <= 0.53
        most = math.pi / math.asin(bearing.ball_diameter / bearing.pitch_diameter)
        assert 0.7 * most - 1 < bearing.balls <= most
        assert bearing.stagger == math.pi / bearing.balls
        assert rig.rated_speed == pytest.approx(50 * math.pi, rel=1e-15)  # one rounding
        assert 0.005 <= rig.rated_load / static_load_rating(bearing) <= 0.05
        assert scenario.scene.operation.load == rig.rated_load


def test_the_machine_of_ones_own_on_the_datasets_page_has_what_must_be_given_and_no_more() -> None:
    page = (Path(__file__).parents[3] / "datasets" / "README.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```toml\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    table = next(block for block in blocks if 'rig = "drawn"' in block)
    machine = tomllib.loads(table)["part"]["machine"]
    assert rigs(**machine)[0].bearing.balls == 8
    for key in machine:
        with pytest.raises(BadInput):
            draw(**{name: value for name, value in machine.items() if name != key})


@pytest.mark.parametrize("what", ["support_stiffness_{}_n_per_m", "support_damping_{}_n_s_per_m"])
@pytest.mark.parametrize("axis", "xy")
def test_a_drawn_rig_needs_the_number_of_the_other_axis_too(what: str, axis: str) -> None:
    shared = "support_frequency_hz" if "stiffness" in what else "support_damping_ratio"
    others = {name: value for name, value in RIG.items() if name != shared}
    both = {what.format("x"): 1e7, what.format("y"): 1e7}
    assert draw(**BEARING, **others, **both)
    one = what.format("y" if axis == "x" else "x")
    with pytest.raises(BadInput, match=f"one of {what.format(axis)}, {shared}"):
        draw(**BEARING, **others, **{one: 1e7})
    with pytest.raises(BadInput, match="set the same thing twice"):
        draw(**BEARING, **RIG, **{one: 1e7})


def test_k_of_a_drawn_bearing_is_hertzs() -> None:
    for rig in rigs(5, **BEARING, **RIG):
        b = rig.bearing
        expected = load_deflection_factor(
            b.pitch_diameter, b.ball_diameter, b.contact_angle, b.inner_conformity, b.outer_conformity
        )
        assert (b.load_deflection, b.exponent) == (expected, 1.5)


def test_drawn_rollers_touch_along_lines_of_their_length() -> None:
    rollers = BEARING | {"elements": "rollers", "roller_length_of_diameter": 1.25}
    (rig,) = rigs(1, **rollers, **RIG)
    assert rig.bearing.exponent == 10 / 9
    assert rig.bearing.load_deflection == roller_load_deflection_factor(1.25 * rig.bearing.ball_diameter)


def test_the_support_and_the_resonator_have_the_frequency_and_damping_that_were_drawn() -> None:
    fixed = {"support_frequency_hz": 300, "support_damping_ratio": 0.03, "support_stiffness_x_over_y": 0.25}
    fixed |= {"resonator_frequency_hz": 9000, "resonator_damping_ratio": 0.01}
    nothing = np.zeros((2, 2))
    for rig in rigs(5, **BEARING, **(RIG | fixed)):
        # each mass alone on its spring: the other two are made weightless or loose
        support = Rig(**{**vars(rig), "resonator_mass": 1e-6 * rig.outer_mass, "resonator_damping": 0.0})
        found = modes(support, nothing, nothing)
        assert found.frequency_hz[2:4] == pytest.approx([150.0, 300.0], rel=1e-5)  # the other mass is 1e-6 of it
        assert found.damping_ratio[2:4] == pytest.approx(
            [0.03, 0.03], rel=1e-4
        )  # light: the eigenvalues are ill conditioned
        ground = Rig(**{**vars(rig), "outer_mass": 1e6, "support_damping_x": 0.0, "support_damping_y": 0.0})
        found = modes(ground, nothing, nothing)
        assert found.frequency_hz[4:] == pytest.approx([9000.0, 9000.0], rel=1e-5)  # the ground weighs 1e6 kg
        assert found.damping_ratio[4:] == pytest.approx([0.01, 0.01], rel=1e-4)  # as above


def test_the_film_damps_the_bearing_in_proportion_to_its_stiffness_at_the_rated_load() -> None:
    for rig in rigs(5, **BEARING, **(RIG | {"film_damping_us": 10})):
        stiffness, damping = rated_matrices(rig)
        assert damping[1, 1] / stiffness[1, 1] == pytest.approx(10e-6, rel=1e-12)  # a few roundings


def test_factors_of_one_change_nothing_and_others_multiply_the_number_of_the_catalogue() -> None:
    gearbox = catalog.rig("gearbox")
    names = ("inner_mass", "outer_mass", "resonator_mass", "resonator_stiffness", "resonator_damping", "film_damping")
    factors = dict.fromkeys((*names, "support_stiffness", "support_damping"), 1.0)
    factors |= dict.fromkeys(("pitch_diameter", "ball_diameter", "clearance", "load_deflection"), 1.0)
    assert rigs(1, rig="gearbox", factors=factors) == [gearbox]
    (rig,) = rigs(1, rig="gearbox", factors=dict.fromkeys((*names, "support_stiffness", "support_damping"), 1.5))
    for name in (*names, "support_stiffness_x", "support_stiffness_y", "support_damping_x", "support_damping_y"):
        assert getattr(rig, name) == 1.5 * getattr(gearbox, name)


def test_deviations_are_drawn_anew_for_each_machine() -> None:
    drawn = rigs(20, rig={"choice": ["gearbox", "fan"]}, factors={"inner_mass": {"uniform": [0.8, 1.25]}})
    shares = [rig.inner_mass / catalog.rig(rig.name).inner_mass for rig in drawn]
    assert len(set(shares)) == 20
    assert 0.8 <= min(shares) < max(shares) <= 1.25


def test_a_factor_on_a_number_that_was_given_multiplies_it() -> None:
    (rig,) = rigs(1, rig="fan", clearance_um=4, factors={"clearance": 0.5})
    assert rig.bearing.clearance == 2e-6
    factors = {"load_deflection": 0.5, "film_damping": 3}
    (rig,) = rigs(1, rig="fan", load_deflection_n_per_m_to_n=6e9, film_damping_us=10, factors=factors)
    assert rig.bearing.load_deflection == 3e9
    stiffness, damping = rated_matrices(rig)
    assert damping[1, 1] / stiffness[1, 1] == pytest.approx(30e-6)


def test_altered_geometry_scales_the_catalogues_k_as_hertz_scales_his() -> None:
    koyo = catalog.bearing("koyo_1205")
    (rig,) = rigs(1, rig="gearbox", ball_diameter_mm=7.5, outer_conformity=0.6)
    ratio = load_deflection_factor(koyo.pitch_diameter, 7.5e-3, 0.0, 0.52, 0.6) / load_deflection_factor(
        koyo.pitch_diameter, koyo.ball_diameter, 0.0, 0.52, koyo.outer_conformity
    )
    assert rig.bearing.load_deflection == pytest.approx(koyo.load_deflection * ratio, rel=1e-14)  # two roundings
    (given,) = rigs(1, rig="gearbox", ball_diameter_mm=7.5, load_deflection_n_per_m_to_n=6e9)
    assert given.bearing.load_deflection == 6e9
    (other,) = rigs(1, rig="ims", pitch_diameter_mm=75)
    assert other.bearing.load_deflection == catalog.bearing("rexnord_za2115").load_deflection


@pytest.mark.parametrize(
    "altered",
    [
        {"inner_conformity": 0.53},
        {"outer_conformity": 0.55},
        {"contact_angle_deg": 10},
        {"pitch_diameter_mm": 45},
        {"ball_diameter_mm": 6.5},
    ],
)
def test_k_follows_every_number_of_the_geometry_by_itself(altered: dict[str, float]) -> None:
    koyo = catalog.bearing("koyo_1205")
    (rig,) = rigs(1, rig="gearbox", **altered)
    factors = [
        load_deflection_factor(
            b.pitch_diameter, b.ball_diameter, b.contact_angle, b.inner_conformity, b.outer_conformity
        )
        for b in (rig.bearing, koyo)
    ]
    assert factors[0] != factors[1]
    assert rig.bearing.load_deflection == pytest.approx(koyo.load_deflection * factors[0] / factors[1], rel=1e-14)


def test_a_drawn_frequency_and_damping_ratio_hold_whatever_the_factors_of_the_masses() -> None:
    stated = {"support_frequency_hz": 300, "support_damping_ratio": 0.03, "resonator_frequency_hz": 9000}
    stated |= {"resonator_damping_ratio": 0.01, "factors": {"outer_mass": 1.5, "resonator_mass": 0.5}}
    (rig,) = rigs(1, rig="gearbox", **stated)
    assert rig.outer_mass == 1.5 * catalog.rig("gearbox").outer_mass
    assert math.sqrt(rig.support_stiffness_y / rig.outer_mass) == pytest.approx(300 * 2 * math.pi)
    assert math.sqrt(rig.resonator_stiffness / rig.resonator_mass) == pytest.approx(9000 * 2 * math.pi)
    assert rig.support_damping_y == pytest.approx(2 * 0.03 * 300 * 2 * math.pi * rig.outer_mass)
    assert rig.resonator_damping == pytest.approx(2 * 0.01 * 9000 * 2 * math.pi * rig.resonator_mass)


def test_a_factor_of_the_support_s_stiffness_shifts_a_drawn_frequency_and_keeps_a_drawn_damping_ratio() -> None:
    stated = {"support_frequency_hz": 300, "support_stiffness_x_over_y": 4, "support_damping_ratio": 0.03}
    (rig,) = rigs(1, rig="gearbox", **stated, factors={"support_stiffness": 1.44})
    for along, hertz in (("x", 720.0), ("y", 360.0)):
        stiffness, damping = (getattr(rig, f"support_{what}_{along}") for what in ("stiffness", "damping"))
        assert math.sqrt(stiffness / rig.outer_mass) == pytest.approx(2 * math.pi * hertz)
        assert damping / (2.0 * math.sqrt(stiffness * rig.outer_mass)) == pytest.approx(0.03)


def test_a_catalogue_bearing_in_a_drawn_rig_keeps_its_numbers() -> None:
    drawn = rigs(8, **RIG, bearing={"choice": ["koyo_1205", "skf_6205"]})
    assert {rig.bearing.name for rig in drawn} == {"koyo_1205", "skf_6205"}
    assert all(rig.bearing == catalog.bearing(rig.bearing.name) for rig in drawn)


def test_drawn_balls_that_do_not_fit_are_redrawn_and_counted() -> None:
    free = {key: value for key, value in BEARING.items() if key != "fill"} | {"balls": {"choice": [10, 14, 18]}}
    scenarios = draw(40, **free, **RIG)
    redraws = [redraw for scenario in scenarios for redraw in scenario.redraws]
    assert {redraw.field for redraw in redraws} == {"ball_diameter"}
    assert "do not fit" in redraws[0].reason
    assert {scenario.scene.rig.bearing.balls for scenario in scenarios} == {10, 14, 18}


def test_a_drawn_machine_comes_back_from_the_text_of_its_scenario() -> None:
    (scenario,) = draw(1, **BEARING, **RIG)
    assert scenario_of(scenario_json(scenario)) == scenario


def test_factors_of_the_diameters_scale_those_of_the_catalogue() -> None:
    (rig,) = rigs(rig="gearbox", factors={"pitch_diameter": 1.1, "ball_diameter": 0.9})
    assert rig.bearing.pitch_diameter == pytest.approx(1.1 * 38.75e-3)  # of the Koyo 1205
    assert rig.bearing.ball_diameter == pytest.approx(0.9 * 7.12e-3)


def test_balls_that_are_a_share_of_the_pitch_diameter_grow_with_its_factor_and_with_their_own() -> None:
    (rig,) = rigs(rig="gearbox", ball_diameter_of_pitch=0.2, factors={"pitch_diameter": 1.1, "ball_diameter": 0.9})
    assert rig.bearing.ball_diameter == pytest.approx(0.9 * 0.2 * 1.1 * 38.75e-3)


def test_balls_in_place_of_the_rollers_of_a_catalogue_bearing_have_their_own_law_of_contact() -> None:
    (rig,) = rigs(rig="ims", elements="balls", inner_conformity=0.52, outer_conformity=0.53)
    b = rig.bearing
    assert catalog.rig("ims").bearing.exponent != b.exponent == 1.5
    expected = load_deflection_factor(b.pitch_diameter, b.ball_diameter, b.contact_angle, 0.52, 0.53)
    assert b.load_deflection == pytest.approx(expected)
    (rig,) = rigs(rig="gearbox", elements="rollers", roller_length_of_diameter=1.25)
    assert rig.bearing.exponent == 10 / 9
    assert rig.bearing.load_deflection == roller_load_deflection_factor(1.25 * rig.bearing.ball_diameter)


def test_a_bearing_too_soft_for_its_rated_load_has_no_film_that_could_damp_it() -> None:
    with pytest.raises(BadInput, match=r"film_damping_us = 10.*no ball carries the rated load, so no film can damp it"):
        draw(rig="gearbox", rated_load_n=1e5, load_deflection_n_per_m_to_n=1e5, film_damping_us=10)


def test_a_full_bearing_holds_as_many_balls_as_fit_side_by_side() -> None:
    # Balls of a fifth of the pitch diameter: pi / asin(0.2) = 15.6; of 0.9 of them there is room for 14.04.
    for fill, balls in ((1.0, 15), (0.9, 14), (0.95, 14)):
        (rig,) = rigs(**(BEARING | {"ball_diameter_of_pitch": 0.2, "fill": fill}), **RIG)
        assert rig.bearing.balls == balls
    # Six circles fit round one of their own size, so half of them are three, though pi / asin(0.5) is a rounding below.
    (rig,) = rigs(**(BEARING | {"ball_diameter_of_pitch": 0.5, "fill": 0.5}), **RIG)
    assert rig.bearing.balls == 3


def test_support_and_resonator_have_a_factor_of_damping_each() -> None:
    own = catalog.rig("gearbox")
    (rig,) = rigs(rig="gearbox", factors={"resonator_damping": 2, "support_damping": 3})
    assert rig.resonator_damping == pytest.approx(2.0 * own.resonator_damping)
    assert rig.support_damping_x == pytest.approx(3.0 * own.support_damping_x)
    assert rig.support_damping_y == pytest.approx(3.0 * own.support_damping_y)
