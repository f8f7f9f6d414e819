"""Drift is taken out where the ends of a record do not meet, so that a settling sensor does not look like blows."""

import numpy as np
import pytest

from labels.features.drift import without_drift
from labels.features.kinematics import bearing_kinematics
from labels.features.signal_features import signal_features
from labels.features.whole_turns import FEWEST_TURNS

RATE, TURNS = 12_000.0, 50.0
TIME = np.arange(24_000) / RATE
NOISE = np.random.default_rng(0).standard_normal(TIME.size)
DRIFTS = {
    "trend": 5.0 * TIME,
    "settling": 200.0 * np.exp(-TIME / 0.7),
    "swing": 10.0 * np.sin(2.0 * np.pi * 0.3 * TIME),
}


@pytest.mark.parametrize("drift", DRIFTS.values(), ids=DRIFTS)
def test_drift_whose_ends_do_not_meet_is_taken_out(drift):
    found = without_drift(NOISE + drift, TURNS)
    # Means of a turn, 480 samples, have a standard deviation of 0.05; straight on to the ends that is 0.08. A course
    # that bends by 200 · (0.04 s / 0.7 s)² / 8 within a turn is met to that.
    assert np.abs(found - NOISE).max() < 0.5
    assert abs(found[-480:].mean() - found[:480].mean()) < 0.1


@pytest.mark.parametrize("kept", [np.zeros(TIME.size), 3.0 * np.sin(2.0 * np.pi * 0.5 * TIME), 0.3 * TIME])
def test_a_record_whose_ends_meet_is_left_as_it_is(kept):
    signal = NOISE + kept
    assert without_drift(signal, TURNS) is signal


def test_what_happens_once_a_turn_is_no_drift():
    turning = 20.0 * np.sin(2.0 * np.pi * TURNS / TIME[-1] * TIME + 1.0)
    signal = NOISE + turning
    assert without_drift(signal, TURNS) is signal


def test_in_too_few_turns_nothing_tells_drift_from_motion():
    signal = NOISE + DRIFTS["trend"]
    assert without_drift(signal, FEWEST_TURNS - 0.5) is signal
    assert np.ptp(without_drift(signal, FEWEST_TURNS)) < np.ptp(signal) - 5.0


@pytest.mark.parametrize("drift", DRIFTS.values(), ids=DRIFTS)
def test_a_drifting_sensor_is_no_blow(drift):
    """The step from the end to the beginning was one: of a trend the kurtosis of the loudest band rose from 0 to 5."""
    bearing = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)
    steady, found = (signal_features(signal, RATE, bearing) for signal in (NOISE, NOISE + drift))
    for name in ("band_kurtosis", "flat_kurtosis"):
        assert found[name] == pytest.approx(steady[name], abs=0.15)


@pytest.mark.parametrize(("apart", "taken_out"), [(0.98, False), (1.02, True), (-1.02, True)])
def test_ends_may_lie_a_standard_deviation_within_a_turn_apart(apart, taken_out):
    # Samples of ±1 deviate by 1. Levels of 50 turns, straight on to the ends, lie 50 of their steps apart.
    turn = TIME.size // 50
    signal = np.tile([1.0, -1.0], TIME.size // 2) + np.repeat(np.arange(50.0) * apart / 50.0, turn)
    found = without_drift(signal, TURNS)
    assert (found is not signal) == taken_out
    assert abs(found[-turn:].mean() - found[:turn].mean()) == pytest.approx(0.0 if taken_out else 0.98 * 0.98, abs=0.03)
