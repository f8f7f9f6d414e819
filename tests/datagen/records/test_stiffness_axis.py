"""The stored stiffness: as coarse in time as its accuracy allows and no coarser."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from datagen.recipes.recipe import parse_recipe
from datagen.records.record import make_record
from datagen.records.stiffness_axis import ACCURACY, interpolation_error, shard_key, stiffness_axis, stiffness_divisor
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario
from physics.statics.load_distribution import require_equilibrium

SPALL = {"condition": "line", "extent_deg": 2, "depth_um": 12}


def draw(records: int = 1, rate: float = 65536, duration: float = 0.2, **settings: Any) -> list[Scenario]:
    """Healthy scenarios of the gearbox rig unless the settings say otherwise."""
    part = {"name": "p", "records": records, "machine": {"rig": "gearbox"}} | settings
    signal = {"rate_hz": rate, "duration_s": duration}
    recipe = parse_recipe({"name": "r", "seed": 8, "signal": signal, "part": [part]}, Path("recipe.toml"))
    return [draw_scenario(recipe, record) for record in range(records)]


def measured_error(scenario: Scenario, axis: np.ndarray) -> float:
    """Largest RMS error of interpolating each component from `axis` onto the samples, over the mean of kyy."""
    time = np.arange(scenario.samples) / scenario.rate
    exact, coarse = (
        require_equilibrium(scenario.scene, time).stiffness,
        require_equilibrium(scenario.scene, axis).stiffness,
    )
    missed = [np.interp(time, axis, coarse[:, k]) - exact[:, k] for k in range(3)]
    return max(float(np.sqrt(np.mean(part**2))) for part in missed) / float(exact[:, 1].mean())


@pytest.mark.parametrize("rig", ["gearbox", "fan", "cwru", "mfpt"])
def test_the_axis_of_a_healthy_bearing_keeps_the_accuracy_and_is_not_needlessly_fine(rig: str) -> None:
    scenarios = draw(
        16,
        duration=0.4,
        machine={"rig": rig, "clearance_um": {"uniform": [0, 15]}},
        operation={"speed_rpm": {"log_uniform": [100, 500]}, "load_of_rated": {"log_uniform": [0.3, 5]}},
        imperfections={"ball_deviation_um": {"normal": [0, 0.3]}},
    )
    coarse = [scenario for scenario in scenarios if stiffness_divisor(scenario) > 1]
    assert len(coarse) >= 4
    errors = [measured_error(scenario, stiffness_axis(scenario)) for scenario in coarse]
    assert max(errors) <= ACCURACY
    assert float(np.median(errors)) > ACCURACY / 8  # a power of two down, and a machine worse than the median


@pytest.mark.parametrize(
    "settings",
    [
        {"defect": SPALL},
        {"imperfections": {"waviness": [{"race": "outer", "orders": [5, 5], "amplitude_um": 1}]}},
        {"machine": {"rig": "ims"}},
        {"machine": {"rig": "gearbox", "elements": "rollers"}},
        {"operation": {"load_n": 0}},
    ],
)
def test_spalls_waviness_and_rollers_are_solved_at_every_sample(settings: dict[str, Any]) -> None:
    (scenario,) = draw(**settings)
    assert stiffness_divisor(scenario) == 1
    np.testing.assert_array_equal(stiffness_axis(scenario), np.arange(scenario.samples) / scenario.rate)


def test_a_spalled_trace_at_every_other_sample_would_miss_the_accuracy() -> None:
    (scenario,) = draw(defect=SPALL)
    assert measured_error(scenario, stiffness_axis(scenario)[::2]) > ACCURACY


def test_the_axis_covers_the_record_in_equal_steps_from_zero() -> None:
    for samples in (66, 67, 68, 69, 6554):
        (scenario,) = draw(duration=samples / 65536, operation={"speed_of_rated": 0.1})
        divisor, axis = stiffness_divisor(scenario), stiffness_axis(scenario)
        assert divisor > 1
        assert axis[0] == 0.0
        assert 0.0 <= axis[-1] - (samples - 1) / 65536 < divisor / 65536
        np.testing.assert_allclose(np.diff(axis), divisor / 65536, rtol=1e-9)  # differences of rounded times


def test_the_divisor_follows_rate_over_speed() -> None:
    slow, usual = {"speed_of_rated": 0.25}, {"speed_of_rated": 1.0}
    assert stiffness_divisor(draw(operation=slow)[0]) == 4 * stiffness_divisor(draw(operation=usual)[0])
    assert stiffness_divisor(draw(rate=262144, operation=usual)[0]) == stiffness_divisor(draw(operation=slow)[0])


def test_the_estimated_error_is_near_the_measured_one_and_zero_where_every_sample_is_solved() -> None:
    (scenario,) = draw(duration=0.5, operation={"speed_of_rated": 0.5})
    axis = stiffness_axis(scenario)
    estimate = interpolation_error(scenario, require_equilibrium(scenario.scene, axis).stiffness.T)
    # the measured error of one record scatters by about a third around its mean over the nodes' phases
    assert estimate == pytest.approx(measured_error(scenario, axis), rel=0.5)
    (spalled,) = draw(defect=SPALL)
    assert interpolation_error(spalled, require_equilibrium(spalled.scene, stiffness_axis(spalled)).stiffness.T) == 0.0


def test_a_shard_holds_records_of_one_rate_duration_bearing_size_and_axis() -> None:
    (scenario,) = draw(defect=SPALL)
    assert shard_key(scenario) == (65536.0, 13107 / 65536, 12, 2, 1)
    (healthy,) = draw()
    assert shard_key(healthy)[-1] == stiffness_divisor(healthy) == 2
    assert math.isclose(shard_key(healthy)[1], 0.2, abs_tol=1 / 65536)  # rounded to whole samples


def test_an_unbalance_that_nearly_lifts_the_shaft_asks_for_a_finer_axis_where_there_is_clearance() -> None:
    loose = {"rig": "gearbox", "clearance_um": 15}
    run = {"speed_of_rated": 0.25, "load_n": 2000}
    still, lifted = (draw(machine=loose, operation=run | {"unbalance_n": force})[0] for force in (0, 1900))
    assert 1 < stiffness_divisor(lifted) < stiffness_divisor(still)
    assert measured_error(lifted, stiffness_axis(lifted)) <= ACCURACY


@pytest.mark.parametrize(
    "loads",
    [
        {"load_fluctuation": 2},  # through zero twice a turn
        {"load_n": 346, "unbalance_n": 345},
        {"load_n": 346, "unbalance_n": 300, "load_fluctuation": 0.5},
        {"load_n": 346, "unbalance_n": 320},
    ],
)
def test_a_load_that_all_but_vanishes_on_its_way_round_keeps_the_accuracy(loads: dict[str, float]) -> None:
    (scenario,) = draw(duration=0.5, operation={"speed_of_rated": 0.3} | loads)
    axis = stiffness_axis(scenario)
    measured = measured_error(scenario, axis)
    assert measured <= ACCURACY
    stated = interpolation_error(scenario, require_equilibrium(scenario.scene, axis).stiffness.T)
    # No less than it is, but for some scatter; twice as much where not corners but a fast turn of the load is missed.
    assert 0.95 * measured <= stated <= 2.0 * measured


def test_the_label_tells_what_interpolation_misses() -> None:
    (scenario,) = draw(duration=0.1, operation={"speed_of_rated": 0.5})
    assert stiffness_divisor(scenario) > 1
    label = make_record(scenario).labels["stiffness_error"]
    assert label == pytest.approx(measured_error(scenario, stiffness_axis(scenario)), rel=0.5)  # as above
