"""Where the lines of a race may lie, and what of a record is looked at."""

import math

import numpy as np
import pytest

from labels.features.analysis import Analysis, analyse
from labels.features.kinematics import bearing_kinematics

RATE, SHAFT = 20_000.0, 25.0
KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, SHAFT)


def noise(loud: float) -> Analysis:
    """Two seconds of noise and, as loud as stated, harmonics of the shaft, which show its speed."""
    turn = 2.0 * np.pi * SHAFT * np.arange(40_000) / RATE
    shaft = loud * sum(np.cos(k * turn + k) for k in (1, 2, 4, 5, 6, 8))
    return analyse(np.random.default_rng(0).standard_normal(turn.size) + shaft, RATE, KNOWN)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_the_lines_of_a_race_may_lie_where_slip_and_a_contact_angle_move_them(race):
    centre, tolerance = noise(0.5).race_window(race)
    low, high = (centre * (1.0 + side * tolerance) / (KNOWN.pass_order(race) * SHAFT) for side in (-1.0, 1.0))
    tilted = bearing_kinematics(9, 39.04e-3, 7.94e-3, math.radians(15.0), SHAFT)
    # A slipping cage passes fewer balls over the outer race and more over the inner one; a tilt does the opposite.
    slipping = 0.98 if race == "outer" else 1.015
    for moved in (1.0, slipping, tilted.pass_order(race) / KNOWN.pass_order(race)):
        assert low < moved < high
    assert not low < 2.0 - slipping < high


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_where_no_line_of_the_shaft_shows_its_speed_they_may_lie_as_far_off_to_both_sides(race):
    centre, tolerance = noise(0.0).race_window(race)
    # Slip and a speed that is 2 % off, as labels say it may be.
    assert tolerance > max(0.02, noise(0.5).race_window(race)[1])
    assert centre == pytest.approx(KNOWN.pass_order(race) * noise(0.0).speed.shaft_hz)
