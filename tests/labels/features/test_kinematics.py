"""Orders of a bearing from its geometry, against published values."""

import math

import pytest

from labels.features.kinematics import Kinematics, bearing_kinematics


def test_orders_are_those_that_cwru_publishes_for_its_6205():
    known = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 29.95)
    # Published to four decimals from dimensions in inches; ours are rounded to 0.01 mm, which moves the fourth.
    assert known.bpfo == pytest.approx(3.5848, abs=5e-4)
    assert known.bpfi == pytest.approx(5.4152, abs=5e-4)
    assert known.ftf == pytest.approx(0.39828, abs=1e-4)
    assert 2.0 * known.ball_spin == pytest.approx(4.7135, abs=5e-4)


def test_the_contact_angle_brings_orders_to_those_published_with_the_za_2115_of_ims():
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, math.radians(15.17), 2000.0 / 60.0)
    # Published in Hz at 2000 rpm, with one decimal; at 0 degrees BPFO would be 235.3 Hz.
    assert known.bpfo * known.shaft_hz == pytest.approx(236.4, abs=0.05)
    assert known.bpfi * known.shaft_hz == pytest.approx(296.9, abs=0.05)


def test_balls_pass_outer_and_inner_race_as_often_together_as_there_are_balls():
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, 0.2648, 33.3)
    assert known.bpfo + known.bpfi == pytest.approx(16.0, rel=1e-12)  # an identity, up to rounding


@pytest.mark.parametrize(("balls", "ratio", "speed"), [(2, 0.2, 25.0), (9, 1.2, 25.0), (9, 0.2, 0.0)])
def test_impossible_numbers_are_refused(balls, ratio, speed):
    with pytest.raises(ValueError, match="allowed"):
        Kinematics(balls, ratio, 2.3, speed)


def test_a_ball_larger_than_the_pitch_circle_is_refused():
    with pytest.raises(ValueError, match="ball_diameter"):
        bearing_kinematics(9, 7e-3, 8e-3, 0.0, 25.0)
