"""The error a record may have: its share of the signal, or what its own noise hides."""

from dataclasses import replace

import pytest

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.accuracy import Accuracy
from datagen.scenarios.allowed_error import allowed_error
from datagen.scenarios.background import Background, NoiseTarget
from datagen.scenarios.sampling import draw_scenario
from datagen.scenarios.scenario_text import scenario_json, scenario_of
from physics.sensor.chain import SensorChain
from physics.sensor.mode import SensorMode


@pytest.fixture(scope="module")
def scenario():
    plain = replace(draw_scenario(load_recipe("gearbox_rig"), 0), noise_target=None)
    return replace(plain, background=Background(white_rms=0.4), chain=SensorChain(), accuracy=Accuracy(2e-3, 20.0))


def test_without_noise_only_the_share_of_the_signal_counts(scenario):
    assert allowed_error(replace(scenario, background=Background())) == (2e-3, 0.0)
    assert allowed_error(replace(scenario, accuracy=Accuracy(2e-3))) == (2e-3, 0.0)


def test_twenty_decibels_below_the_noise_is_a_tenth_of_it(scenario):
    assert allowed_error(scenario) == (2e-3, pytest.approx(0.04))


def test_what_the_chain_makes_of_an_error_is_allowed_for(scenario):
    chain = SensorChain(resonator_gain=2.0, modes=(SensorMode(3000.0, 0.02, 3.0),))
    assert allowed_error(replace(scenario, chain=chain)) == (2e-3, pytest.approx(0.4 / 50.0))


@pytest.mark.parametrize(("ratio", "share"), [(40.0, 2e-3), (20.0, 1e-2), (0.0, 3e-2)])
def test_a_signal_to_noise_ratio_allows_a_share_of_the_signal_up_to_three_per_cent(scenario, ratio, share):
    target = NoiseTarget(ratio, whole=True)
    assert allowed_error(replace(scenario, noise_target=target)) == (pytest.approx(share), 0.0)


def test_a_ratio_over_a_band_or_of_tones_alone_allows_nothing(scenario):
    assert allowed_error(replace(scenario, noise_target=NoiseTarget(0.0, whole=False))) == (2e-3, 0.0)
    silent = replace(scenario, noise_target=NoiseTarget(0.0, whole=True), background=Background())
    assert allowed_error(silent) == (2e-3, 0.0)


def test_the_accuracy_is_part_of_the_scenarios_text_and_older_texts_mean_the_usual_one(scenario):
    text = scenario_json(scenario)
    assert scenario_of(text).accuracy == Accuracy(2e-3, 20.0)
    older = text.replace('"accuracy":{"relative":0.002,"below_noise_db":20.0},', "")
    assert older != text
    assert scenario_of(older).accuracy == Accuracy()
