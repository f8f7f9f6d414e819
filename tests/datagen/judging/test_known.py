"""What a classifier may know of a record, from its labels."""

import math

import pytest

from datagen.judging.known import known_kinematics, what_is_missing

GEOMETRY = {"balls": 9, "pitch_diameter": 39.04e-3, "ball_diameter": 7.94e-3, "contact_angle": 0.0}
UNKNOWN = dict.fromkeys(GEOMETRY, math.nan)


def test_geometry_and_orders_say_the_same():
    by_geometry = known_kinematics(GEOMETRY | {"speed_rpm": 1800.0})
    by_orders = known_kinematics(UNKNOWN | {"balls": 9, "bpfo": by_geometry.bpfo, "bsf": math.nan, "speed_rpm": 1800.0})
    assert by_orders.bpfi == pytest.approx(by_geometry.bpfi)
    # For a contact angle of 0 the spin follows from the diameter ratio.
    assert by_orders.ball_spin == pytest.approx(by_geometry.ball_spin)
    assert by_geometry.shaft_hz == 30.0


def test_both_ball_pass_orders_tell_the_number_of_balls():
    assert known_kinematics(UNKNOWN | {"bpfo": 3.585, "bpfi": 5.415, "speed_rpm": 1800.0}).balls == 9


def test_the_orders_of_cage_and_outer_race_tell_the_number_of_balls():
    # Of SKF 6205, as its maker rounds them: 3.585 / 0.398 is 9.008.
    known = known_kinematics(UNKNOWN | {"bpfo": 3.585, "bpfi": math.nan, "ftf": 0.398, "speed_rpm": 1800.0})
    assert known.balls == 9
    assert (known.bpfo, known.bpfi) == (pytest.approx(3.585), pytest.approx(5.415))


@pytest.mark.parametrize(
    "orders", [{"ftf": 0.398}, {"bpfo": 3.585}, {"bpfo": 3.585, "ftf": 0.0}, {"bpfo": 3.6, "ftf": 0.9}]
)
def test_an_order_alone_or_one_of_no_bearing_tells_nothing(orders):
    assert known_kinematics(UNKNOWN | {"speed_rpm": 1800.0} | orders) is None


@pytest.mark.parametrize("labels", [GEOMETRY, GEOMETRY | {"speed_rpm": math.nan}, UNKNOWN | {"speed_rpm": 1800.0}])
def test_without_speed_or_geometry_nothing_is_known(labels):
    assert known_kinematics(labels) is None


@pytest.mark.parametrize(
    "change",
    [{"balls": 2.0}, {"balls": 0.0}, {"pitch_diameter": 0.0}, {"ball_diameter": 1.0}, {"contact_angle": 9.0}],
)
def test_a_geometry_that_no_bearing_has_tells_nothing_and_is_called_so(change):
    labels = GEOMETRY | {"speed_rpm": 1800.0} | change
    assert known_kinematics(labels) is None
    assert what_is_missing(labels) == "no bearing has this geometry"
    assert what_is_missing(UNKNOWN | {"speed_rpm": 1800.0}) == "geometry unknown"


@pytest.mark.parametrize("orders", [(0.8, 1.2), (5.415, 3.585), (4.5, 4.5), (-1.0, 10.0), (0.0, 9.0)])
def test_orders_of_no_bearing_tell_nothing(orders):
    outer, inner = orders
    assert known_kinematics(UNKNOWN | {"bpfo": outer, "bpfi": inner, "speed_rpm": 1800.0}) is None


def test_an_unknown_contact_angle_is_taken_as_none():
    with_angle = GEOMETRY | {"speed_rpm": 1800.0}
    without = known_kinematics(with_angle | {"contact_angle": math.nan})
    assert without == known_kinematics(with_angle)
    # 9 / 2 (1 − 7.94 / 39.04)
    assert without.bpfo == pytest.approx(3.5848, abs=1e-4)


def test_the_order_of_one_race_and_the_number_of_balls_give_that_of_the_other():
    for said in ({"bpfi": 5.4152}, {"bpfo": 3.5848}):
        known = known_kinematics({"speed_rpm": 1800.0, "balls": 9} | said)
        assert known is not None
        assert (known.bpfo, known.bpfi) == (pytest.approx(3.5848), pytest.approx(5.4152))  # 9 together


@pytest.mark.parametrize(("basis", "within"), [("measured", 0.022), ("tach", 0.022), ("nominal", 0.05), (None, 0.022)])
def test_a_nominal_speed_may_be_off_by_more_than_one_that_was_measured(basis: str | None, within: float) -> None:
    said = {} if basis is None else {"speed_basis": basis}
    known = known_kinematics(GEOMETRY | {"speed_rpm": 1800.0} | said)
    assert known is not None
    assert known.speed_within == within


def test_orders_that_were_rounded_tell_a_whole_number_of_balls() -> None:
    assert known_kinematics(UNKNOWN | {"bpfo": 3.245, "bpfi": 4.7546, "speed_rpm": 1500.0}).balls == 8


def test_three_balls_are_the_fewest() -> None:
    known = known_kinematics(UNKNOWN | {"balls": 3, "bpfo": 1.2, "speed_rpm": 1800.0})
    assert (known.balls, known.bpfi) == (3, pytest.approx(1.8))


def test_a_stated_order_of_ball_spin_is_taken() -> None:
    stated = {"balls": 9, "bpfo": 3.585, "bsf": 2.357, "speed_rpm": 1500.0}
    assert known_kinematics(UNKNOWN | stated).ball_spin == 2.357


@pytest.mark.parametrize("speed", ["fast", None, 0.0, -1800.0])
def test_a_speed_that_is_no_number_or_not_above_0_tells_nothing(speed: object) -> None:
    for known in (GEOMETRY, UNKNOWN | {"balls": 9, "bpfo": 3.585}):
        assert known_kinematics(known | {"speed_rpm": speed}) is None
