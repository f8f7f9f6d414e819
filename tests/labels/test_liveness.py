"""A stopped machine is told from a running one, without a look at the scale of what it shakes."""

import numpy as np

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.liveness import STOPPED, is_dead, liveness

RATE = 20_000.0
TIME = np.arange(20_000) / RATE
KNOWN = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 2000.0 / 60.0)


def found(signal):
    return liveness(analyse(signal, RATE, KNOWN), signal.size)


def test_sensor_noise_and_mains_hum_are_a_stopped_machine():
    noise = 5e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    # 240 Hz lies 1.5 % from this bearing's BPFO, 300 Hz on the ninth multiple of its shaft.
    hum = sum(0.01 / k * np.cos(2.0 * np.pi * 60.0 * k * TIME) for k in range(1, 17))
    assert found(noise + hum).reason == STOPPED


def test_a_quiet_shaft_that_turns_is_not_stopped():
    noise = 1e-4 * np.random.default_rng(1).standard_normal(TIME.size)
    turning = sum(2e-3 * np.cos(2.0 * np.pi * KNOWN.shaft_hz * k * TIME) for k in range(1, 7))
    assert found(noise + turning).reason == ""


def test_in_a_few_turns_nothing_says_that_a_machine_stands_still():
    noise = 5e-3 * np.random.default_rng(0).standard_normal(TIME.size)
    slow = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 7.0)
    assert found(noise).reason == STOPPED
    assert liveness(analyse(noise, RATE, slow), noise.size).reason == ""


def test_a_machine_that_shakes_is_not_stopped_whatever_its_lines():
    noise = np.random.default_rng(2).standard_normal(TIME.size)
    assert found(noise).reason == ""


def test_the_velocity_of_a_tone_is_its_acceleration_over_its_frequency():
    signal = 0.5 * np.cos(2.0 * np.pi * 100.0 * TIME) + 1e-6 * np.random.default_rng(3).standard_normal(TIME.size)
    # RMS of 0.5 / (2π 100) m/s; the noise adds less than 1e-4 of it.
    assert abs(found(signal).velocity / (0.5 / (2.0 * np.pi * 100.0) / np.sqrt(2.0)) - 1.0) < 1e-3


def test_a_sensor_without_signal_is_dead():
    assert is_dead(np.zeros(5000))
    assert is_dead(np.full(5000, np.nan))
    noise = np.random.default_rng(4).standard_normal(5000)
    assert not is_dead(noise)
    assert not is_dead(np.concatenate([np.zeros(5000), noise]))
    assert is_dead(np.concatenate([noise, [np.nan]]))
