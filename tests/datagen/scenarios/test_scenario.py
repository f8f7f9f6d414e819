"""Scenarios as text: exact, complete, and in the words that other people's code reads."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from datagen.errors import BadInput
from datagen.recipes.recipe import load_recipe
from datagen.scenarios.accuracy import Accuracy
from datagen.scenarios.background import Background, NoiseTarget, Stretch
from datagen.scenarios.refused import Redraw
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario import Scenario, Seeds
from datagen.scenarios.scenario_text import scenario_json, scenario_of
from datagen.scenarios.streams import PURPOSES, SCOPES
from physics.backgrounds.gear_mesh import GearMesh
from physics.backgrounds.impulses import Impulses, Resonance
from physics.backgrounds.mains_hum import MainsHum
from physics.backgrounds.pink import PinkNoise
from physics.backgrounds.shaft_harmonics import ShaftHarmonics
from physics.bearing import Bearing
from physics.cage import CagePath
from physics.imperfections import Imperfections, Waviness
from physics.operation import Operation
from physics.response.resampling import decimate
from physics.rig import Rig
from physics.scene import Scene
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode
from physics.sensor.mounting import Mounting
from physics.sensor.recorder import Recorder
from physics.spall import Spall

KEYS = (
    "Nb rows Dp Db alpha K n c phi_c0 row_offset m_i m_o m_r k_ox k_oy c_ox c_oy k_r c_r c_d omega_s W "
    "phi_f extent depth entry_taper exit_taper roughness "
    "unbalance_force unbalance_phase load_fluctuation fluctuation_phase"
)


def full_scenario() -> Scenario:
    """A scenario in which no number is zero, whole or a default."""
    bearing = Bearing("b", 11, 2, 0.0391, 0.0073, 5.3e9, 1.51, 0.11, 3.3e-6, 0.21, 0.523, 0.527)
    rig = Rig("r", bearing, 0.51, 10.3, 1.71e7, 1.72e7, 671.1, 672.2, 0.53, 2.1e9, 317.4, 101.3, 44.4, 347.1)
    spalls = (
        Spall("inner", 1, 0.3, 0.1, 1.3e-5, 0.01, 0.03, "tukey", 2e-6, (0.0, 1.1e-6, -2.3e-6, 0.0)),
        Spall("inner", 2, 2.3, 0.2, 1.7e-5, profile="table", table_angle=(-0.1, 0.1), table_depth=(1e-6, 1.7e-5)),
    )
    deviation = tuple(tuple(1e-7 * (r + 0.1 * j) for j in range(11)) for r in range(2))
    return Scenario(
        scene=Scene(
            rig=rig,
            operation=Operation(43.21, 345.6, 3.3, 0.7, 0.11, 1.9),
            cage=CagePath(17.3, 0.1, 0.41, 0.013, 0.06, -0.12, (0.001, -0.002, 0.003, 0.004, 0.1)),
            spalls=spalls,
            imperfections=Imperfections((Waviness("outer", 3, 1.7e-7, 0.9),), deviation),
            contact_law="no_tension",
            second_cage=CagePath(17.3, 0.1, 0.77, 0.013, 0.06, -0.12, (0.005, -0.003, 0.001, 0.002, 0.1)),
        ),
        rate=51200.0,
        seeds=Seeds(20, 3, 1, 2, 4),
        part="mixed",
        bearing_id="x-00002",
        split="validation",
        envelope_band=(9000.1, 9999.9),
        settle=0.05,
        slip_deviation=0.0123,
        slip_correlation_time=0.0345,
        chain=SensorChain(
            (SensorMode(4321.0, 0.023, 0.71), SensorMode(8765.4, 0.011, 1.3)),
            0.89,
            Mounting(10987.0, 5),
            Recorder(497.0, 14),
        ),
        background=Background(
            white_rms=0.0678,
            pink=PinkNoise(0.123, 2.3, 1.1),
            shaft_harmonics=ShaftHarmonics((0.31, 0.17), 2),
            gear_mesh=GearMesh(32, (0.41, 0.13), 49, 0.33, 0.27, 3),
            mains_hum=MainsHum(49.97, (0.21, 0.07)),
            impulses=Impulses(13.7, 5.1, 0.61, (Resonance(3210.0, 0.031),)),
            recording_gain=9.81,
        ),
        stretch=Stretch("healthy.wav", "ab" * 32, (17, 23), np.arange(6, dtype="<f4").tobytes()),
        noise_target=NoiseTarget(7.7, False),
        snr_band=(987.6, 5432.1),
        redraws=(Redraw("record", 0, "extent", "too long"),),
        accuracy=Accuracy(3e-3, 17.0),
    )


def leaves(value: Any, path: str = "") -> list[tuple[str, Any]]:
    """Every plain value inside nested dataclasses and tuples, with its path."""
    if dataclasses.is_dataclass(value):
        return [leaf for f in dataclasses.fields(value) for leaf in leaves(getattr(value, f.name), f"{path}.{f.name}")]
    if isinstance(value, tuple):
        return [leaf for k, inner in enumerate(value) for leaf in leaves(inner, f"{path}[{k}]")]
    return [(path, value)]


def test_a_scenario_with_every_field_set_comes_back_equal() -> None:
    scenario = full_scenario()
    again = scenario_of(scenario_json(scenario))
    assert dict(leaves(again)) == dict(leaves(scenario))
    assert again == scenario
    assert scenario_json(again) == scenario_json(scenario)


def test_no_field_of_the_full_scenario_is_left_at_its_default() -> None:
    def unset(value: Any, path: str) -> list[str]:
        found = [
            f"{path}.{f.name}"
            for f in dataclasses.fields(value)
            if f.default is not dataclasses.MISSING and getattr(value, f.name) == f.default
        ]
        inner = [getattr(value, f.name) for f in dataclasses.fields(value)]
        return found + [name for one in inner if dataclasses.is_dataclass(one) for name in unset(one, path + ".")]

    assert unset(full_scenario(), "scenario") == []


def test_a_missing_stagger_stays_missing_and_its_value_is_still_told() -> None:
    scenario = full_scenario()
    bearing = dataclasses.replace(scenario.scene.rig.bearing, row_offset=None)
    rig = dataclasses.replace(scenario.scene.rig, bearing=bearing)
    scenario = dataclasses.replace(scenario, scene=dataclasses.replace(scenario.scene, rig=rig, second_cage=None))
    assert scenario_of(scenario_json(scenario)) == scenario
    assert json.loads(scenario_json(scenario))["parameters"]["row_offset"] == math.pi / 11


def test_the_flat_parameters_carry_the_symbols_of_the_model_in_si_units() -> None:
    data = json.loads(scenario_json(full_scenario()))
    parameters = data["parameters"]
    assert set(parameters) == set(KEYS.split())
    assert (parameters["K"], parameters["W"], parameters["omega_s"], parameters["Nb"]) == (5.3e9, 345.6, 43.21, 11)
    assert (parameters["phi_c0"], parameters["c_d"], parameters["c"]) == (0.41, 101.3, 3.3e-6)


def test_the_flat_parameters_describe_the_largest_spall() -> None:
    parameters = json.loads(scenario_json(full_scenario()))["parameters"]
    assert (parameters["extent"], parameters["phi_f"], parameters["depth"]) == (0.2, 2.3, 1.7e-5)


def test_the_parameters_of_a_healthy_scenario_have_a_defect_of_zeros() -> None:
    scenario = full_scenario()
    healthy = dataclasses.replace(scenario, scene=dataclasses.replace(scenario.scene, spalls=()))
    data = json.loads(scenario_json(healthy))
    names = ("phi_f", "extent", "depth", "entry_taper", "exit_taper", "roughness")
    assert [data["parameters"][name] for name in names] == [0.0] * 6
    assert (data["condition"], data["location"], data["defects"]) == ("healthy", "none", [])


@pytest.mark.parametrize(
    ("rate", "modes", "factor"), [(51200.0, 2, 3), (20000.0, 2, 7), (20000.0, 0, 6), (51200.0, 0, 1)]
)
def test_the_text_tells_the_raised_rate_and_the_filter_that_lowers_it(rate: float, modes: int, factor: int) -> None:
    scenario = full_scenario()
    chain = dataclasses.replace(scenario.chain, modes=scenario.chain.modes[:modes], mounting=None)
    sampling = json.loads(scenario_json(dataclasses.replace(scenario, rate=rate, chain=chain)))["sampling"]
    assert sampling["oversampling"] == factor  # 14 times 8765.4 Hz, or ten times 10.3 kHz, over the rate; 3 with modes
    if factor == 1:
        assert sampling["lowering"] is None
        return
    lowering = sampling["lowering"]
    n = np.arange(-lowering["half_length"], lowering["half_length"] + 1)
    shape = np.i0(lowering["kaiser_beta"] * np.sqrt(1.0 - (n / lowering["half_length"]) ** 2)) * np.sinc(
        lowering["cutoff"] * n
    )
    impulse = np.zeros((2 * n.size * factor + 1, 1))
    impulse[n.size * factor] = 1.0
    found = decimate(impulse, factor)[:, 0]
    assert found.max() == pytest.approx(shape.max() / shape.sum(), rel=1e-12)
    assert found[n.size + 1] == pytest.approx(shape[n == factor].item() / shape.sum(), rel=1e-9)


def test_the_text_tells_how_to_remake_the_record() -> None:
    data = json.loads(scenario_json(full_scenario()))
    assert data["format"] == "spallgen scenario 2"
    assert data["sampling"]["samples"] == 5120
    assert data["sampling"]["settle_s"] == 0.05
    assert "t = -settle_s" in data["rules"]["start"]
    assert {"contact", "motion"} <= set(data["rules"])
    assert "bc_type='natural'" in data["slip"]["interpolation"]
    assert data["slip"]["knots"] == [0.001, -0.002, 0.003, 0.004, 0.1]
    assert data["second_cage"]["start_angle"] == 0.77
    assert ["cos(pi" in defect["rule"] for defect in data["defects"]] == [True, False]
    assert ["table_depth" in defect["rule"] for defect in data["defects"]] == [False, True]
    identity = {
        "record": 3,
        "part": "mixed",
        "split": "validation",
        "rig": "r",
        "bearing": "b",
        "bearing_id": "x-00002",
    }
    assert {key: data[key] for key in identity} == identity


def test_the_rule_of_a_tapered_spall_says_what_the_film_makes_of_a_step() -> None:
    rules = [defect["rule"] for defect in json.loads(scenario_json(full_scenario()))["defects"]]
    assert "a zero taper is a step of no slope: the film damping c_d feels nothing of it" in rules[0]


def test_the_rule_of_the_seeds_names_each_number_as_the_text_does() -> None:
    seeds = json.loads(scenario_json(full_scenario()))["seeds"]
    rule = seeds["rule"]
    assert "SeedSequence(recipe, spawn_key=(scope, index, purpose, attempt, item))" in rule
    for said in ("index record", "attempt record_attempt", "item 0", "scope 'record'", "places in the lists"):
        assert said in rule
    assert {"recipe", "record", "record_attempt", "scopes", "purposes"} <= set(seeds)


def test_no_rule_of_a_settled_record_lets_a_filter_begin_at_its_first_sample() -> None:
    text = json.loads(scenario_json(dataclasses.replace(full_scenario(), settle=0.01)))
    modes, mounting = text["chain"]["rules"]["modes"], text["chain"]["rules"]["mounting"]
    assert "at rest where the simulated instants begin (t = 0, or -settle_s" in modes
    assert "at rest where the simulated instants begin" in mounting
    assert "modes and the mounting of the chain are at rest then" in text["rules"]["start"]


def test_the_seeds_in_the_text_open_the_records_noise_without_our_code() -> None:
    scenario = full_scenario()
    seeds = json.loads(scenario_json(scenario))["seeds"]
    purpose = seeds["purposes"].index("white_noise")
    key = (seeds["scopes"].index("record"), seeds["record"], purpose, seeds["record_attempt"], 0)
    expected = np.random.default_rng(np.random.SeedSequence(seeds["recipe"], spawn_key=key)).standard_normal(4)
    np.testing.assert_array_equal(scenario.generator("white_noise").standard_normal(4), expected)
    assert (seeds["scopes"], seeds["purposes"]) == (list(SCOPES), list(PURPOSES))


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"format": "spallgen scenario 1"}', '{"format": "other"}'])
def test_a_text_that_is_no_scenario_is_refused(text: str) -> None:
    with pytest.raises(BadInput):
        scenario_of(text)


def recording(data: Any) -> Any:
    """The layer of a text's data that is a stretch of a recording."""
    return data["background"]["layers"]["recording"]


@pytest.mark.parametrize(
    "spoil",
    [
        lambda data: recording(data).update(content=recording(data)["content"][:16]),
        lambda data: recording(data).update(content=3),
        lambda data: recording(data).update(starts=[]),
        lambda data: data["background"].update(layers=[]),
        lambda data: data["background"].update(snr_band_hz=[1.0]),
        lambda data: data["sampling"].update(envelope_band_hz=[]),
    ],
    ids=["truncated content", "a number for content", "no starts", "layers in a list", "half a band", "empty band"],
)
def test_a_damaged_text_of_a_scenario_is_refused(spoil: Callable[[Any], None]) -> None:
    data = json.loads(scenario_json(full_scenario()))
    spoil(data)
    with pytest.raises(BadInput, match="not the text of a scenario"):
        scenario_of(json.dumps(data))


def test_a_format_of_the_future_is_refused_by_name() -> None:
    allowed = "spallgen scenario 1, spallgen scenario 2"
    with pytest.raises(BadInput, match=f'format = "spallgen scenario 3"; allowed: {allowed}'):
        scenario_of(scenario_json(full_scenario()).replace("scenario 2", "scenario 3"))


def test_the_text_of_a_record_that_begins_at_rest_is_of_the_first_format() -> None:
    data = json.loads(scenario_json(dataclasses.replace(full_scenario(), settle=0.0)))
    assert data["format"] == "spallgen scenario 1"
    assert "settle_s" not in data["sampling"]
    assert data["rules"]["start"].startswith("at rest in equilibrium under the load vector of t = 0, velocities zero")


@pytest.mark.parametrize("name", ["quickstart", "gearbox_rig", "fan_rig"])
def test_drawn_scenarios_come_back_equal(name: str) -> None:
    recipe = load_recipe(name)
    for record in range(0, recipe.count, 7):
        scenario = draw_scenario(recipe, record)
        assert scenario_of(scenario_json(scenario)) == scenario
