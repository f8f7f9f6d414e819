"""Records that say too little to be judged are known from others by their labels and their length alone."""

import pytest

from datagen.benchmark.fitness import TOO_FAST, TOO_SHORT, unfit
from datagen.judging.known import NO_ROTATION, UNKNOWN_GEOMETRY, UNKNOWN_SPEED, known_kinematics

RATE = 12_000.0
GEOMETRY = {"balls": 9, "pitch_diameter": 39.04e-3, "ball_diameter": 7.94e-3, "contact_angle": 0.0}


def why_unfit(seconds, rpm, bandwidth=20_000.0, **changes):
    labels = GEOMETRY | {"speed_rpm": rpm} | changes
    return unfit(labels, known_kinematics(labels), int(seconds * RATE), RATE, bandwidth)


def test_a_second_of_a_turning_shaft_can_be_judged():
    assert why_unfit(1.0, 1800.0) == ""


@pytest.mark.parametrize("rpm", [0.0, -1800.0])
def test_a_shaft_that_does_not_turn_is_no_running_machine(rpm):
    assert why_unfit(1.0, rpm) == NO_ROTATION


def test_what_is_unknown_is_said_to_be_unknown():
    assert why_unfit(1.0, float("nan")) == UNKNOWN_SPEED == "speed unknown"
    assert why_unfit(1.0, 1800.0, pitch_diameter=float("nan")) == UNKNOWN_GEOMETRY == "geometry unknown"


# 120 rpm are 2 turns a second; 6000 rpm turn 9 times in 0.09 s, which is too short nevertheless.
@pytest.mark.parametrize(
    ("seconds", "rpm", "reason"),
    [(0.49, 120.0, TOO_SHORT), (0.51, 120.0, ""), (0.09, 6000.0, TOO_SHORT), (0.1, 6000.0, "")],
)
def test_less_than_a_turn_or_a_tenth_of_a_second_is_too_short(seconds, rpm, reason):
    assert why_unfit(seconds, rpm) == reason


def test_ball_passes_above_what_an_envelope_can_show_are_too_fast():
    # BPFI is 5.415 orders; 0.45 of 0.95 of 6 kHz is 2565 Hz, that is 28 420 rpm.
    assert why_unfit(1.0, 28_300.0) == ""
    assert why_unfit(1.0, 28_500.0) == TOO_FAST
    assert why_unfit(1.0, 1e6) == TOO_FAST
    assert why_unfit(1.0, 1800.0, bandwidth=300.0) == TOO_FAST
