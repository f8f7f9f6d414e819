"""The features of one array, without a corpus."""

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.signal_features import signal_features
from labels.features.table import FEATURE_NAMES, feature_values
from labels.features.turning import Turning

KNOWN = bearing_kinematics(9, 39.04e-3, 11.0e-3, 0.0, 25.0)
RATE = 20_000.0


@pytest.mark.parametrize(("race", "other"), [("outer", "inner"), ("inner", "outer")])
def test_they_come_by_name_and_show_the_race(impulse_train, race, other):
    order = KNOWN.bpfo if race == "outer" else KNOWN.bpfi
    found = signal_features(impulse_train(order), RATE, KNOWN)
    assert tuple(found) == FEATURE_NAMES
    assert found[f"{race}_evidence"] > found[f"{other}_evidence"] + 0.5


def test_without_anything_to_mend_they_are_those_of_the_analysis(impulse_train):
    signal = impulse_train(KNOWN.bpfo)
    expected = feature_values(analyse(signal, RATE, KNOWN, 8000.0)).tolist()
    assert list(signal_features(signal, RATE, KNOWN, 8000.0).values()) == expected


def test_a_jump_of_the_bias_is_levelled_first(impulse_train):
    signal = impulse_train(KNOWN.bpfo)
    jumped = signal + np.where(np.arange(signal.size) > 9000, 40.0, 0.0)
    found, sound, raw = (
        signal_features(jumped, RATE, KNOWN),
        signal_features(signal, RATE, KNOWN),
        dict(zip(FEATURE_NAMES, feature_values(analyse(jumped, RATE, KNOWN)), strict=True)),
    )
    assert found["kurtosis"] == pytest.approx(sound["kurtosis"], abs=0.05)
    assert found["outer_velocity"] == pytest.approx(sound["outer_velocity"], abs=0.2)
    assert abs(raw["outer_velocity"] - sound["outer_velocity"]) > 0.5  # what a jump does where it stays


@pytest.mark.parametrize(
    ("signal", "rate", "shaft_hz", "message"),
    [
        (np.zeros(2000), RATE, 25.0, "fewer than 4 different values"),
        (np.arange(2000.0) % 2, RATE, 25.0, "fewer than 4 different values"),
        (np.arange(63.0), RATE, 25.0, "at least 64 samples"),
        (np.ones((2000, 2)), RATE, 25.0, "of one axis"),
        (np.append(np.arange(2000.0), np.nan), RATE, 25.0, "not finite"),
        (np.arange(2000.0), 0.0, 25.0, "at 0 Hz"),
        (np.arange(2000.0), RATE, 5.0, "the shaft makes 0.5 turns in the signal; features need 1 or more"),
        # 5.768 passes a turn of 25 Hz; features see 0.45 · 0.95 · 150 Hz.
        (np.arange(2000.0), 300.0, 25.0, "balls pass the inner race at 144.2 Hz; at 300 Hz features see 64.12 Hz"),
    ],
)
def test_what_has_no_features_is_refused(signal, rate, shaft_hz, message):
    with pytest.raises(ValueError, match=message):
        signal_features(signal, rate, KNOWN.at(shaft_hz))


@pytest.mark.parametrize("samples", [10_000, 40_000])
def test_angles_of_another_number_than_the_samples_are_refused(impulse_train, samples):
    signal = impulse_train(KNOWN.bpfo)
    with pytest.raises(ValueError, match=f"{samples} angles of the shaft for 20000 samples"):
        signal_features(signal, RATE, KNOWN, turning=Turning(np.linspace(0.0, 150.0, samples)))


@pytest.mark.parametrize("stated_hz", [0.1, 24.0, 2000.0])
def test_the_angle_alone_says_how_fast_the_shaft_turns(impulse_train, stated_hz):
    signal = impulse_train(KNOWN.bpfo)
    turning = Turning(2.0 * np.pi * 25.0 * np.arange(signal.size) / RATE)
    found = signal_features(signal, RATE, KNOWN.at(stated_hz), turning=turning)
    assert found == signal_features(signal, RATE, KNOWN, turning=turning)


def test_a_signal_that_repeats_itself_has_finite_features():
    signal = np.tile(np.random.default_rng(0).standard_normal(5000), 4)
    assert np.isfinite(list(signal_features(signal, RATE, KNOWN).values())).all()
