"""The vibration as velocity, its cepstrum and its length."""

import numpy as np
import pytest

from labels.features.analysis import Analysis, analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.orders import measure, rahmonics, velocity_power

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


def noise(seconds: float) -> Analysis:
    return analyse(np.random.default_rng(0).standard_normal(round(20_000.0 * seconds)), 20_000.0, KNOWN)


def test_the_velocity_of_a_tone_is_its_acceleration_over_its_frequency():
    rate, size = 20_000.0, 20_000
    time = np.arange(size) / rate
    tones = sum(np.cos(2.0 * np.pi * frequency * time) for frequency in (110.0, 440.0))
    analysis = analyse(tones + 1e-4 * np.random.default_rng(0).standard_normal(size), rate, KNOWN)
    power = velocity_power(analysis)
    low, high = (power[round(frequency / analysis.record.step)] for frequency in (110.0, 440.0))
    assert low / high == pytest.approx(16.0, rel=1e-3)  # (440 / 110)²; the noise adds some 1e-6
    assert power[: int(0.5 * 25.0 / analysis.record.step)].max() == 0.0


def test_rahmonics_are_read_at_one_and_at_two_periods():
    analysis = noise(1.0)
    cepstrum = np.tile([0.1, -0.1], 10_000)
    rate = cepstrum.size * analysis.record.step
    for period, height in ((1, 4.0), (2, 2.0)):
        cepstrum[round(period * rate / 80.0)] = height
    # The scatter of a normal distribution is 1.4826 times its median size; the mean height of both is 3.
    assert rahmonics(analysis, cepstrum, 80.0) == pytest.approx(np.log1p(3.0 / 0.14826), rel=1e-9)


@pytest.mark.parametrize("seconds", [0.5, 2.0])
def test_a_longer_record_holds_more_turns(seconds):
    # The speed may be refined by up to 2.2 %.
    assert measure(noise(seconds))["turns"] == pytest.approx(np.log(25.0 * seconds), abs=0.023)


def test_the_share_of_the_shaft_counts_its_first_eight_orders():
    turn = 2.0 * np.pi * 25.0 * np.arange(40_000) / 20_000.0
    quiet = 1e-4 * np.random.default_rng(0).standard_normal(40_000)
    share = {order: measure(analyse(quiet + np.cos(order * turn), 20_000.0, KNOWN)) for order in (6, 9)}
    assert share[6]["shaft_velocity"] == pytest.approx(0.0, abs=0.05)  # all of it, as a logarithm
    assert share[9]["shaft_velocity"] < -1.0


def test_each_race_has_a_cepstrum_of_its_own(impulse_train):
    for race, other in (("outer", "inner"), ("inner", "outer")):
        order = KNOWN.bpfo if race == "outer" else KNOWN.bpfi
        found = measure(analyse(impulse_train(order, duration=2.0, snr_db=20.0), 20_000.0, KNOWN))
        assert found[f"{race}_cepstrum"] > found[f"{other}_cepstrum"] + 0.3
