import math

import numpy as np
import pytest

from physics.angular_speed import RPM, in_hertz, in_rpm


def test_one_turn_a_second_is_60_rpm_and_1_hz():
    assert in_rpm(2.0 * math.pi) == 60.0
    assert in_hertz(2.0 * math.pi) == 1.0


@pytest.mark.parametrize("rpm", [0.001, 800.0, 1499.5, 1797.0, 1e6])
def test_there_and_back_is_the_same_speed(rpm):
    assert in_rpm(rpm * RPM) == rpm
    assert in_hertz(rpm * RPM) == pytest.approx(rpm / 60.0, rel=4e-16)  # two roundings


def test_whole_speeds_come_back_as_they_were_stated():
    stated = np.arange(1.0, 30_001.0)
    assert [in_rpm(speed) for speed in stated * RPM] == stated.tolist()
