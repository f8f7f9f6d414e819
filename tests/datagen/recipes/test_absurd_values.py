"""Values that no machine has, and that end in overflow, endless work or nonsense, are refused by their key."""

from pathlib import Path
from typing import Any

import pytest

from datagen.distributions.kinds import Fixed
from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.angular_speed import RPM

WAVE = {"race": "outer", "orders": [1, 20]}
TONE = {"amplitude_m_s2": 1e300}
RING = {"frequency_hz": 4000, "damping": 0.01}


def recipe_of(table: str, settings: dict[str, Any]) -> Recipe:
    """A recipe of one healthy part on the gearbox rig with these settings in one table."""
    part: dict[str, Any] = {"name": "p", "records": 1, "machine": {"rig": "gearbox"}}
    part[table] = part.get(table, {}) | settings
    content = {"name": "r", "seed": 5, "signal": {"rate_hz": 65536, "duration_s": 0.1}, "part": [part]}
    return parse_recipe(content, Path("recipe.toml"))


def speed_of(rated_rpm: float, times: float) -> float:
    """The shaft speed (rpm) of a machine that runs at a multiple of its rated speed."""
    part = {
        "name": "p",
        "records": 1,
        "machine": {"rig": "gearbox", "rated_speed_rpm": rated_rpm},
        "operation": {"speed_of_rated": times, "slip_deviation": 0},
    }
    content = {"name": "r", "seed": 5, "signal": {"rate_hz": 65536, "duration_s": 0.1}, "part": [part]}
    return draw_scenario(parse_recipe(content, Path("recipe.toml")), 0).scene.operation.shaft_speed


@pytest.mark.parametrize(
    ("table", "settings", "message"),
    [
        (
            "imperfections",
            {"waviness": [WAVE | {"amplitude_um": 1e15}]},
            "waviness[1].amplitude_um = 1000000000000000.0; allowed",
        ),
        (
            "imperfections",
            {"waviness_scale": 1e15},
            "waviness_scale = 1000000000000000.0; allowed: a number from 0 to 1000",
        ),
        (
            "imperfections",
            {"ball_deviation_scale": 1e15},
            "scale = 1000000000000000.0; allowed: a number from 0 to 1000",
        ),
        (
            "machine",
            {"rated_speed_rpm": 1e15},
            "rated_speed_rpm = 1000000000000000.0; allowed: a number from 0.001 to 1e+06",
        ),
        ("machine", {"rated_load_n": 1e15}, "rated_load_n = 1000000000000000.0; allowed: a number from 1e-06 to 1e+07"),
        (
            "machine",
            {"film_damping_n_s_per_m": 1e15},
            "film_damping_n_s_per_m = 1000000000000000.0; allowed: a number from 0 to 1",
        ),
        ("machine", {"support_stiffness_y_n_per_m": 1e-9}, "allowed: a number from 1 to 1e+13"),
        ("machine", {"load_deflection_n_per_m_to_n": 1e15}, "allowed: a number from 1000 to 1e+13"),
        ("machine", {"row_offset_deg": 1e300}, "row_offset_deg = 1e+300; allowed: a number from -1e+06 to 1e+06"),
        (
            "machine",
            {"factors": {"clearance": 1e15}},
            "factors.clearance = 1000000000000000.0; allowed: a number from 0 to 1e+06",
        ),
        (
            "operation",
            {"cage_angle_deg": {"normal": [1, 1e308]}},
            "the standard deviation must be at most 1e+06; allowed: a number from -1e+06 to 1e+06",
        ),
        ("operation", {"speed_rpm": 1e-300}, "speed_rpm = 1e-300; allowed: a number from 0.001 to 1e+06"),
        ("operation", {"speed_of_rated": 1e-300}, "speed_of_rated = 1e-300; allowed: a number from 1e-06 to 1000"),
        ("chain", {"resonator_gain": 1e300}, "resonator_gain = 1e+300; allowed: a number from 0 to 1e+06"),
        ("chain", {"modes": [RING | {"gain": 1e300}]}, "modes[1].gain = 1e+300; allowed: a number from 0 to 1e+06"),
        ("chain", {"modes": [RING | {"frequency_hz": 1e-300}]}, "frequency_hz = 1e-300; allowed: a number from 0.001"),
        ("chain", {"mounting_cutoff_hz": 1e-9}, "mounting_cutoff_hz = 1e-09; allowed: a number from 0.001 to 1e+07"),
        ("chain", {"recorder_range_m_s2": 1e-300}, "allowed: a number from 1e-06 to 1e+09"),
        ("background", {"white_rms_m_s2": 1e300}, "white_rms_m_s2 = 1e+300; allowed: a number from 0 to 1e+06"),
        ("background", {"pink": {"rms_m_s2": 1e300}}, "pink.rms_m_s2 = 1e+300; allowed: a number from 0 to 1e+06"),
        ("background", {"pink": {"rms_m_s2": 1, "lowest_hz": 1e-300}}, "lowest_hz = 1e-300; allowed: a number from"),
        ("background", {"shaft_harmonics": TONE}, "shaft_harmonics.amplitude_m_s2 = 1e+300; allowed: a number from 0"),
        ("background", {"gear_mesh": TONE | {"teeth": 9}}, "gear_mesh.amplitude_m_s2 = 1e+300; allowed: a number from"),
        ("background", {"mains_hum": TONE}, "mains_hum.amplitude_m_s2 = 1e+300; allowed: a number from 0 to 1e+06"),
        (
            "background",
            {"impulses": TONE | RING | {"per_second": 9}},
            "impulses.amplitude_m_s2 = 1e+300; allowed: a nu",
        ),
    ],
)
def test_a_value_that_no_machine_has_is_refused_by_its_key(table: str, settings: dict[str, Any], message: str) -> None:
    with pytest.raises(BadInput) as refused:
        recipe_of(table, settings)
    assert message in str(refused.value)


def test_a_wave_that_no_race_has_is_refused_whatever_made_it_so_high() -> None:
    recipe = recipe_of("imperfections", {"waviness": [WAVE | {"amplitude_um": 1, "decay": -4}], "waviness_scale": 9})
    with pytest.raises(
        BadInput, match=r"of order 6 = 0\.0116.* m; allowed: above 0, up to 0\.01 m \(.*waviness_scale = 9"
    ) as refused:
        draw_scenario(recipe, 0)
    assert "part[1].imperfections.waviness[1].amplitude_um = 1.0: machine 0 of part" in str(refused.value)


def test_a_slip_of_more_knots_than_can_be_drawn_is_refused_with_what_makes_them_so_many() -> None:
    recipe = recipe_of("operation", {"speed_rpm": 1e6, "slip_correlation_passes": 0.1})
    long = recipe.model_copy(update={"signal": recipe.signal.model_copy(update={"duration_s": Fixed(60.0)})})
    with pytest.raises(
        BadInput, match=r"the slip needs 1\.96e\+08 knots.*allowed: up to 1e\+07.*speed_rpm = 1000000"
    ) as refused:
        draw_scenario(long, 0)
    assert "part[1].operation.slip_correlation_passes = 0.1: record 0 of part" in str(refused.value)


@pytest.mark.parametrize(("rated", "times"), [(1e6, 1.001), (0.001, 0.999)])
def test_a_multiple_of_the_rated_speed_must_be_a_speed(rated: float, times: float) -> None:
    with pytest.raises(BadInput, match=r"speed_of_rated = .*the shaft speed = .* rpm; allowed: 0\.001 to 1e\+06 rpm"):
        speed_of(rated, times)
    assert speed_of(rated, 1.0) == pytest.approx(rated * RPM, rel=1e-12)
