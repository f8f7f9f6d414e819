"""Chain and background made again from a scenario's text alone, by code that imports nothing of the packages."""

import dataclasses
import json
import math

import numpy as np
import pytest
import sensor
from scipy.signal import butter, lfilter

from datagen.records.record import make_record
from datagen.scenarios.background import Background, NoiseTarget, Stretch
from datagen.scenarios.scenario import Scenario, Seeds
from datagen.scenarios.scenario_text import scenario_json
from physics.backgrounds.gear_mesh import GearMesh
from physics.backgrounds.impulses import Impulses, Resonance
from physics.backgrounds.mains_hum import MainsHum
from physics.backgrounds.pink import PinkNoise
from physics.backgrounds.shaft_harmonics import ShaftHarmonics
from physics.cage import CagePath
from physics.catalog import rig
from physics.operation import Operation
from physics.scene import Scene
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode
from physics.sensor.mounting import Mounting
from physics.sensor.recorder import Recorder
from physics.spall import Spall

RATE, SAMPLES = 65536.0, 2000
MODES = (SensorMode(2100.0, 0.02, 0.8), SensorMode(6400.0, 0.05, 1.7), SensorMode(14500.0, 0.01, 0.4))


@pytest.fixture(scope="module")
def scenario():
    machine, duration = rig("gearbox"), SAMPLES / RATE
    spall = Spall("outer", 1, math.radians(270.0), 0.035, 12e-6, 0.005, 0.005)
    cage = CagePath(machine.bearing.cage_speed(machine.rated_speed), duration, 0.2)
    stretch = np.random.default_rng(3).standard_normal((SAMPLES, 2)).astype("<f4")
    return Scenario(
        scene=Scene(machine, Operation(machine.rated_speed, machine.rated_load), cage, (spall,)),
        rate=RATE,
        seeds=Seeds(recipe=7, record=4, record_attempt=1, machine=2, machine_attempt=0),
        part="reference",
        bearing_id="B0",
        split="train",
        envelope_band=(9e3, 10e3),
        chain=SensorChain(MODES, 1.2, Mounting(11000.0, 6), Recorder(6.0, 12)),
        background=Background(
            white_rms=0.1,
            pink=PinkNoise(0.2, 35.0, 1.2),
            shaft_harmonics=ShaftHarmonics((0.3, 0.1), 2),
            gear_mesh=GearMesh(32, (0.4, 0.2), 49, 0.3, 0.2, 2),
            mains_hum=MainsHum(50.0, (0.1, 0.05, 0.02)),
            impulses=Impulses(200.0, 1.0, 0.5, (Resonance(3000.0, 0.03), Resonance(900.0, 0.05))),
            recording_gain=0.05,
        ),
        stretch=Stretch("healthy.npy", "0" * 64, (5, 9), stretch.tobytes()),
        noise_target=NoiseTarget(3.0, False),
    )


@pytest.fixture(scope="module")
def made(scenario):
    return make_record(scenario, ("acceleration_sensor", "background"))


@pytest.fixture(scope="module")
def plain_layers(scenario):
    """The layers (L, T, 2) in their absolute levels."""
    return make_record(dataclasses.replace(scenario, noise_target=None), ("background",)).background


@pytest.fixture(scope="module")
def text(scenario):
    return json.loads(scenario_json(scenario))


@pytest.fixture(scope="module")
def again(text):
    return sensor.sensor_signal(text)


def test_the_sensor_signal_made_again_from_the_text_agrees(made, again):
    # The replay's own error at 16 substeps is up to 4e-3 of the resonator's signal.
    error = np.sqrt(np.mean((made.acceleration_sensor - again) ** 2) / np.mean(again**2))
    assert error < 0.01


def test_the_sensor_signal_of_a_machine_that_has_run_before_agrees_from_the_first_sample_on(scenario):
    settled = dataclasses.replace(scenario, settle=1500 / RATE)
    made = make_record(settled, ("acceleration_sensor",)).acceleration_sensor
    again = sensor.sensor_signal(json.loads(scenario_json(settled)))
    assert made.shape == again.shape == (SAMPLES, 2)
    assert np.sqrt(np.mean((made - again) ** 2) / np.mean(again**2)) < 0.01
    first = np.sqrt(np.mean((made - again)[:50] ** 2) / np.mean(again[:50] ** 2))
    assert first < 0.05


def test_the_mounting_of_a_machine_that_has_run_before_has_filtered_what_came_before(scenario):
    low = dataclasses.replace(scenario, settle=1500 / RATE, chain=SensorChain((), 1.0, Mounting(500.0, 6), None))
    record = make_record(low, ("acceleration_sensor", "acceleration_clean"))
    made, clean = record.acceleration_sensor, record.acceleration_clean
    again = sensor.sensor_signal(json.loads(scenario_json(low)))
    assert np.sqrt(np.mean((made - again) ** 2) / np.mean(made**2)) < 0.01  # the replay's own error
    from_rest = lfilter(*butter(6, 500.0 / (RATE / 2.0)), clean, axis=0)
    # Had it been at rest at t = 0, its ringing in would be missing: several samples of a cutoff at 500 Hz.
    assert np.sqrt(np.mean((made - from_rest) ** 2) / np.mean(made**2)) > 0.1


@pytest.mark.parametrize("name", sensor.MAKERS)
def test_each_layer_made_again_from_the_text_is_the_same(plain_layers, text, name):
    found, expected = sensor.layers(text)[name], plain_layers[list(sensor.MAKERS).index(name)]
    # float32 of what is stored; the area under the pink density by trapezoids
    assert found == pytest.approx(expected, abs=1e-6 * float(np.abs(expected).max()))


def test_the_background_is_scaled_to_the_ratio_and_the_sum_is_rounded_and_clipped(made, text):
    layers = sensor.scaled(text, made.acceleration_sensor.astype(float), sensor.layers(text))
    assert np.stack(list(layers.values())) == pytest.approx(
        made.background, abs=2e-6 * float(np.abs(made.background).max())
    )
    record = sensor.recorder(text, made.acceleration_sensor + sum(layers.values()))
    step = 12.0 / 2.0**12
    assert np.abs(record - made.acceleration).max() <= step * 1.001  # a float32 next to a half goes either way
    assert np.mean(record != made.acceleration) < 1e-3
    assert 0.0 < made.labels["clipped_share"] < 0.2
