"""Orders of a bearing from its geometry, against published values."""

import math

import pytest

from labels.features.kinematics import NOMINAL_WITHIN, Kinematics, bearing_kinematics


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


def test_a_ball_rolls_on_the_inner_race_without_slip_whatever_its_contact_angle():
    known = bearing_kinematics(16, 71.5e-3, 8.407e-3, math.radians(15.17), 2000.0 / 60.0)
    # Seen from the cage, the race at its contact is as fast as the ball's skin; r = (Dp - Db cos a) / 2 from the axis.
    contact = 0.5 * (71.5 - 8.407 * math.cos(math.radians(15.17)))
    assert known.ball_spin * 0.5 * 8.407 == pytest.approx((1.0 - known.ftf) * contact, rel=1e-12)


def test_each_race_has_its_own_order():
    known = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 29.95)
    assert (known.pass_order("outer"), known.pass_order("inner")) == (known.bpfo, known.bpfi)
    assert known.bpfo < 4.5 < known.bpfi  # half of nine balls


def test_at_another_speed_all_else_is_the_same():
    nominal = Kinematics(9, 0.2, 2.3, 25.0, NOMINAL_WITHIN)
    assert nominal.at(30.0) == Kinematics(9, 0.2, 2.3, 30.0, NOMINAL_WITHIN)


@pytest.mark.parametrize(
    "wrong",
    [
        {"balls": 2},
        {"diameter_ratio": 0.0},
        {"diameter_ratio": 1.0},
        {"diameter_ratio": 1.2},
        {"ball_spin": 0.0},
        {"shaft_hz": 0.0},
        {"shaft_hz": math.inf},
        {"shaft_hz": math.nan},
        {"speed_within": 0.0},
        {"speed_within": -0.1},
        {"speed_within": 1.0},
    ],
)
def test_impossible_numbers_are_refused_by_their_name(wrong):
    possible = {"balls": 3, "diameter_ratio": 0.2, "ball_spin": 2.3, "shaft_hz": 25.0, "speed_within": 0.05}
    assert Kinematics(**possible).balls == 3
    with pytest.raises(ValueError, match=f"^{next(iter(wrong))} = .*; allowed"):
        Kinematics(**possible | wrong)


@pytest.mark.parametrize("ball_diameter", [0.0, -1e-3, 7e-3, 8e-3])
def test_a_ball_as_large_as_the_pitch_circle_or_none_is_refused(ball_diameter):
    with pytest.raises(ValueError, match="ball_diameter"):
        bearing_kinematics(9, 7e-3, ball_diameter, 0.0, 25.0)


@pytest.mark.parametrize("balls", [9.5, math.nan, math.inf])
def test_a_number_of_balls_that_is_not_whole_is_refused(balls):
    with pytest.raises(ValueError, match=rf"balls = {balls}; allowed: whole numbers"):
        bearing_kinematics(balls, 39.04e-3, 7.94e-3, 0.0, 29.95)
