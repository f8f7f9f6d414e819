"""Records of machines that run already when they begin."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.records.record import Record, make_record
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from datagen.scenarios.scenario_text import scenario_of
from physics.request import LeadIn
from physics.sensor.chain import SensorChain, sensed
from physics.sensor.mode import SensorMode
from physics.sensor.mounting import Mounting
from physics.simulate import simulate
from physics.trace import Kept

RATE, DURATION, SETTLE = 32768.0, 0.1, 0.1
STORED = ("acceleration_clean", "acceleration_sensor", "cage_angle", "contact_force")
PART: dict[str, Any] = {
    "name": "p",
    "records": 4,
    "machine": {"rig": "fan"},
    "operation": {"slip_deviation": 0.01},
    "defect": {"condition": "line", "extent_deg": 2.6, "depth_um": 12, "race": "inner"},
    "background": {"white_rms_m_s2": 1.0, "snr_db": 20},
}


def recipe_with(**signal: Any) -> Recipe:
    content = {"name": "r", "seed": 3, "signal": {"rate_hz": RATE, "duration_s": DURATION} | signal, "part": [PART]}
    return parse_recipe(content, Path("recipe.toml"))


def level(signal: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(signal, dtype=float))))


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return draw_scenario(recipe_with(settle_s=SETTLE), 0)


@pytest.fixture(scope="module")
def record(scenario: Scenario) -> Record:
    return make_record(scenario, STORED)


def test_a_recipe_says_how_long_machines_run_before_their_records_begin(scenario: Scenario) -> None:
    assert scenario.settle == round(SETTLE * RATE) / RATE
    assert scenario.scene.cage.knot_start <= -scenario.settle
    assert scenario.samples == round(DURATION * RATE)
    assert draw_scenario(recipe_with(), 0).settle == 0.0


@pytest.mark.parametrize("settle", [-0.1, 61.0, math.inf, "long"])
def test_a_time_that_no_machine_settles_in_is_refused(settle: object) -> None:
    with pytest.raises(BadInput, match=r"signal\.settle_s"):
        recipe_with(settle_s=settle)


def test_a_settled_record_begins_at_its_first_sample_in_motion(scenario: Scenario, record: Record) -> None:
    assert record.acceleration_clean is not None
    assert record.contact_force is not None
    assert record.cage_angle is not None
    assert record.time[0] == 0.0
    assert record.acceleration.shape == (scenario.samples, 2)
    assert record.contact_force.shape[0] == scenario.samples
    assert np.array_equal(record.cage_angle, scenario.scene.cage.angle(record.time))
    at_rest = make_record(replace(scenario, settle=0.0), ("acceleration_clean",)).acceleration_clean
    assert at_rest is not None
    usual = level(record.acceleration_clean)
    assert level(at_rest[0]) < 1e-3 * usual  # nothing but what the filter brings from later
    assert level(record.acceleration_clean[0]) > 0.05 * usual


def test_the_simulation_is_that_of_the_scene_with_a_lead_in(scenario: Scenario, record: Record) -> None:
    trace = simulate(scenario.scene, scenario.rate, keep=Kept(force=True), lead_in=LeadIn(scenario.settle))
    assert np.array_equal(record.acceleration_clean, trace.acceleration.astype(np.float32))
    assert record.labels["error_estimate"] == trace.error_estimate <= 1e-3


def test_release_and_regain_are_where_the_force_of_the_ball_is_lost_and_found(record: Record) -> None:
    assert record.contact_force is not None
    passes, seen = record.passes, 0
    assert passes.exit_time.min() >= 0.0
    assert passes.entry_time.max() <= DURATION
    for k in np.flatnonzero(passes.complete & np.isfinite(passes.release_time)):
        force = record.contact_force[:, passes.row[k] - 1, passes.ball[k] - 1]
        lost, found = np.searchsorted(record.time, [passes.release_time[k], passes.regain_time[k]])
        assert force[lost - 1] != 0.0
        assert force[lost] == 0.0
        assert force[found] != 0.0
        seen += 1
    assert seen > 3


def test_the_ratio_of_signal_to_noise_is_that_of_the_running_machine(record: Record) -> None:
    assert record.acceleration_sensor is not None
    noise = (record.acceleration.astype(float) - record.acceleration_sensor)[:, 1]
    assert 20.0 * math.log10(np.std(record.acceleration_sensor[:, 1]) / np.std(noise)) == pytest.approx(20.0, abs=0.01)


def test_the_chain_has_settled_too(scenario: Scenario) -> None:
    chain = SensorChain((SensorMode(900.0, 0.003),), 0.5, Mounting(8000.0))
    record = make_record(replace(scenario, chain=chain), ("acceleration_sensor",))
    longer = simulate(
        scenario.scene, RATE, keep=Kept(outer=True, fastest_path=900.0), lead_in=LeadIn(scenario.settle, kept=True)
    )
    expected = sensed(chain, longer)[-scenario.samples :]
    np.testing.assert_array_equal(record.acceleration_sensor, expected.astype(np.float32))


def test_the_text_of_a_settled_record_gives_it_again_bit_for_bit(record: Record) -> None:
    again = make_record(scenario_of(record.scenario), STORED)
    assert np.array_equal(again.acceleration, record.acceleration)
    assert np.array_equal(again.passes.release_time, record.passes.release_time, equal_nan=True)
    assert str(again.labels) == str(record.labels)


def test_a_longer_run_before_the_record_changes_nothing_of_a_machine_without_slip() -> None:
    scenario = draw_scenario(recipe_with(settle_s=0.5), 0)
    steady = replace(scenario, scene=replace(scenario.scene, cage=replace(scenario.scene.cage, knot_values=())))
    short, long = (
        make_record(replace(steady, settle=settle), ("acceleration_clean",)).acceleration_clean
        for settle in (0.25, 0.5)
    )
    assert short is not None
    assert long is not None
    assert level(short - long) < 2e-3 * level(long)
