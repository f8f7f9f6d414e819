from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe
from datagen.records.profile_grid import PROFILE_POINTS
from datagen.records.record import Record, make_record
from datagen.scenarios.background import Background
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.scenarios.scenario_text import scenario_of
from labels.envelope import band_envelope
from labels.schema import LABELS
from physics.paths.profile import race_depth
from physics.simulate import simulate

EVERYTHING = (
    "acceleration_clean",
    "acceleration_sensor",
    "background",
    "cage_angle",
    "profile_depth",
    "contact_force",
)


@pytest.fixture(scope="module")
def scenario(tiny: Recipe) -> Scenario:
    """A line spall on the gearbox rig, with background."""
    drawn = (draw_scenario(tiny, record) for record in range(8))
    return next(one for one in drawn if one.condition == "line")


@pytest.fixture(scope="module")
def record(scenario: Scenario) -> Record:
    return make_record(scenario, EVERYTHING)


@pytest.mark.parametrize("stored", [("clean",), ("background", "clean"), "clean"])
def test_a_signal_that_no_record_has_is_refused_before_anything_is_simulated(
    stored: tuple[str, ...], scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.records.record.simulate", None)
    with pytest.raises(BadInput, match=r"stored = .*allowed: acceleration_clean, .*, contact_force"):
        make_record(scenario, stored)


def test_the_clean_acceleration_is_the_simulated_one_rounded(scenario: Scenario, record: Record) -> None:
    trace = simulate(scenario.scene, scenario.rate)
    assert record.acceleration_clean is not None
    assert np.array_equal(record.acceleration_clean, trace.acceleration.astype(np.float32))
    assert np.array_equal(record.time, np.arange(scenario.samples) / scenario.rate)


def test_the_background_has_the_floor_of_its_machine_on_each_axis(scenario: Scenario, record: Record) -> None:
    assert record.acceleration_clean is not None
    noise = record.acceleration.astype(float) - record.acceleration_clean
    expected = scenario.background.white_rms
    # 1638 samples: the deviation of a sample standard deviation is 1/sqrt(2 · 1638) = 1.7 %; four of them
    assert noise.std(axis=0) == pytest.approx([expected, expected], rel=0.07)
    assert abs(np.corrcoef(noise.T)[0, 1]) < 0.1  # independent axes: 1/sqrt(1638) = 0.025, four of them


def test_two_records_of_one_machine_have_different_noise_of_the_same_floor(tiny: Recipe) -> None:
    first, second = (draw_scenario(tiny, record) for record in (0, 1))
    assert first.bearing_id == second.bearing_id
    assert first.background == second.background
    draws = [one.generator("white_noise").standard_normal(100) for one in (first, second)]
    assert abs(np.corrcoef(draws)[0, 1]) < 0.5


def test_the_snr_label_is_that_of_the_y_axis(record: Record) -> None:
    assert record.acceleration_clean is not None
    clean, noise = record.acceleration_clean[:, 1], (record.acceleration - record.acceleration_clean)[:, 1]
    expected = 10.0 * math.log10(np.var(clean, dtype=float) / np.var(noise, dtype=float))
    assert record.labels["snr_db"] == pytest.approx(expected, abs=1e-3)  # float32 rounding of what is stored


def test_without_background_the_sensor_shows_the_clean_signal(scenario: Scenario) -> None:
    silent = make_record(replace(scenario, background=Background(white_rms=0.0)), ("acceleration_clean",))
    assert silent.acceleration_clean is not None
    assert np.array_equal(silent.acceleration, silent.acceleration_clean)
    assert math.isnan(silent.labels["snr_db"])


def test_the_envelope_follows_from_the_stored_acceleration_and_band(record: Record) -> None:
    again = band_envelope(record.acceleration[:, 1], record.labels["rate_hz"], record.labels["envelope_band"])
    assert np.array_equal(record.envelope, again.astype(np.float32))


def test_the_optional_signals_are_those_of_the_scene(scenario: Scenario, record: Record) -> None:
    scene = scenario.scene
    assert record.cage_angle is not None
    assert record.cage_angle.dtype == np.float64
    assert np.array_equal(record.cage_angle, scene.cage.angle(record.time))
    assert record.profile_depth is not None
    assert record.profile_depth.shape == (2, PROFILE_POINTS)
    angle = np.array([scene.spalls[0].angle])
    column = round((math.remainder(angle[0], 2.0 * math.pi) + math.pi) / (2.0 * math.pi) * PROFILE_POINTS)
    assert record.profile_depth[0, column] == pytest.approx(race_depth(scene, 1, angle)[0], rel=1e-5)  # half a cell
    assert record.contact_force is not None
    assert record.contact_force.shape == (scenario.samples, 2, 12)


def test_what_is_not_asked_for_is_absent(scenario: Scenario) -> None:
    plain = make_record(scenario)
    assert [getattr(plain, name) for name in EVERYTHING] == [None] * len(EVERYTHING)


def test_every_label_of_the_schema_has_a_value_of_its_type(record: Record) -> None:
    kinds = {"str": str, "float64": float, "int64": int, "bool": bool}
    assert list(record.labels) == [label.name for label in LABELS]
    for label in LABELS:
        values = record.labels[label.name] if label.components else (record.labels[label.name],)
        for value in values:
            assert isinstance(value, kinds[label.dtype]), label.name
            assert label.values is None or value in label.values
            assert label.missing or label.dtype != "float64" or math.isfinite(value), label.name


def test_the_text_of_a_scenario_gives_its_record_again_bit_for_bit(record: Record) -> None:
    again = make_record(scenario_of(record.scenario), EVERYTHING)
    assert np.array_equal(again.acceleration, record.acceleration)
    assert np.array_equal(again.stiffness, record.stiffness)
    assert np.array_equal(again.passes.release_time, record.passes.release_time, equal_nan=True)
    assert str(again.labels) == str(record.labels)


def test_the_stored_profile_read_by_linear_interpolation_gives_the_path_of_the_ball(
    scenario: Scenario, record: Record
) -> None:
    assert record.profile_depth is not None
    angles = np.random.default_rng(1).uniform(-math.pi, math.pi, 20_000)
    grid = np.linspace(-math.pi, math.pi, PROFILE_POINTS + 1)
    stored = np.append(record.profile_depth[0], record.profile_depth[0, 0])
    path = race_depth(scenario.scene, 1, angles)
    # a cell is 2.4e-5 rad; on a taper of 0.2° the curvature gives depth · (pi/taper)²/2 · cell²/8 = 3e-5 of the depth
    assert np.abs(np.interp(angles, grid, stored) - path).max() < 1e-4 * path.max()
