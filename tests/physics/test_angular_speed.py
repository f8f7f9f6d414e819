import math

import pytest

from physics.angular_speed import RPM, in_hertz, in_rpm


def test_one_turn_a_second_is_60_rpm_and_1_hz():
    assert in_rpm(2.0 * math.pi) == pytest.approx(60.0, rel=1e-15)
    assert in_hertz(2.0 * math.pi) == 1.0


@pytest.mark.parametrize("rpm", [0.001, 800.0, 1797.0, 1e6])
def test_there_and_back_is_the_same_speed(rpm):
    assert in_rpm(rpm * RPM) == pytest.approx(rpm, rel=4e-16)  # two roundings
    assert in_hertz(rpm * RPM) == pytest.approx(rpm / 60.0, rel=4e-16)
