import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from physics.bearing import Bearing
from physics.checks import InvalidParameter

SIMPLE = Bearing("simple", 12, 2, 40e-3, 8e-3, 1e10)


@st.composite
def bearings(draw):
    balls = draw(st.integers(3, 60))
    pitch = draw(st.floats(5e-3, 2.0))
    ball = pitch * draw(st.floats(0.01, 0.999 * math.sin(math.pi / balls)))
    angle = draw(st.floats(0.0, math.radians(60)))
    return Bearing("drawn", balls, draw(st.integers(1, 2)), pitch, ball, 1e10, contact_angle=angle)


@given(bearings())
@settings(max_examples=100, deadline=None, derandomize=True)
def test_the_two_ball_pass_orders_add_up_to_the_number_of_balls(bearing):
    assert bearing.bpfo + bearing.bpfi == pytest.approx(bearing.balls, rel=1e-14)  # rounding
    assert bearing.bpfo < bearing.balls / 2 < bearing.bpfi


@given(bearings())
@settings(max_examples=100, deadline=None, derandomize=True)
def test_the_cage_turns_at_less_than_half_the_shaft_s_speed(bearing):
    assert 0.0 < bearing.ftf < 0.5
    assert bearing.cage_speed(100.0) == pytest.approx(100.0 * bearing.ftf, rel=1e-14)  # rounding
    assert bearing.bpfo == pytest.approx(bearing.balls * bearing.ftf, rel=1e-14)  # rounding


@given(bearings())
@settings(max_examples=100, deadline=None, derandomize=True)
def test_a_ball_rolls_without_slip_on_both_raceways(bearing):
    cage, spin = bearing.ftf, bearing.bsf
    rolling_radius = bearing.ball_diameter / 2
    outer_speed = cage * bearing.pitch_diameter / 2 * (1 + bearing.diameter_ratio)
    inner_speed = (1 - cage) * bearing.pitch_diameter / 2 * (1 - bearing.diameter_ratio)
    assert outer_speed == pytest.approx(inner_speed, rel=1e-9)  # rounding where the ratio nears 1
    assert spin * rolling_radius == pytest.approx(outer_speed, rel=1e-9)  # rounding where the ratio nears 1


@given(bearings())
@settings(max_examples=100, deadline=None, derandomize=True)
def test_the_raceways_lie_one_ball_apart_and_either_side_of_the_pitch_circle(bearing):
    outer, inner = bearing.raceway_radius("outer"), bearing.raceway_radius("inner")
    gap = bearing.ball_diameter * math.cos(bearing.contact_angle)
    assert 0.0 < inner < bearing.pitch_diameter / 2 < outer
    assert outer - inner == pytest.approx(gap, rel=1e-9)  # rounding of a small difference
    assert outer + inner == pytest.approx(bearing.pitch_diameter, rel=1e-14)  # rounding


@given(bearings(), st.floats(0.01, 100.0))
@settings(max_examples=50, deadline=None, derandomize=True)
def test_orders_do_not_change_with_size(bearing, scale):
    bigger = dataclasses.replace(
        bearing, pitch_diameter=scale * bearing.pitch_diameter, ball_diameter=scale * bearing.ball_diameter
    )
    for order in ("ftf", "bpfo", "bpfi", "bsf"):
        assert getattr(bigger, order) == pytest.approx(getattr(bearing, order), rel=1e-9)  # rounding


def test_tiny_balls_make_the_cage_follow_at_half_speed():
    tiny = dataclasses.replace(SIMPLE, ball_diameter=1e-8)
    assert tiny.ftf == pytest.approx(0.5, abs=2e-7)  # the diameter ratio is 2.5e-7
    assert tiny.bpfi - tiny.bpfo == pytest.approx(0.0, abs=1e-5)  # 12 times the diameter ratio


@pytest.mark.parametrize("exponent", [1.0, 10 / 9, 1.5, 2.0])
def test_the_stribeck_factor_is_the_inverse_load_integral(exponent):
    ring = dataclasses.replace(SIMPLE, exponent=exponent)
    integral, _ = quad(lambda angle: math.cos(angle) ** (exponent + 1), -math.pi / 2, math.pi / 2)
    assert ring.stribeck_factor == pytest.approx(2 * math.pi / integral, rel=1e-10)  # quadrature


def test_the_stribeck_factor_is_4_37_for_balls_and_4_08_for_rollers(authority):
    printed = authority("harris")["stribeck"]
    for kind, exponent in (("ball", 1.5), ("roller", 10 / 9)):
        factor = dataclasses.replace(SIMPLE, exponent=exponent).stribeck_factor
        assert factor == pytest.approx(printed[kind]["value"], abs=printed[kind]["tolerance"])  # digits printed


def test_the_peak_ball_load_of_the_gearbox_rig_is_63_newton(authority, gearbox):
    check = authority("independent_model")["statics"]["gearbox_stribeck_peak_n"]
    peak = gearbox.bearing.stribeck_peak_load(gearbox.rated_load)
    assert peak == pytest.approx(check["value"], abs=check["tolerance"])  # digits given


def test_the_sum_of_many_stribeck_loads_carries_the_load():
    balls, load = 200, 1000.0
    ring = Bearing("fine", balls, 1, 1.0, 5e-3, 1e10, contact_angle=0.3)
    angle = np.arange(balls) * ring.spacing
    normal = ring.stribeck_peak_load(load) * np.maximum(np.cos(angle), 0.0) ** 1.5
    assert np.sum(normal * np.cos(angle)) * math.cos(0.3) == pytest.approx(load, rel=1e-4)  # 200 balls for the integral


def test_rows_are_staggered_by_half_a_ball_spacing_unless_told_otherwise():
    assert SIMPLE.stagger == pytest.approx(math.pi / 12, rel=1e-15)
    for told in (0.1, 0.0):
        assert dataclasses.replace(SIMPLE, row_offset=told).stagger == told
    assert SIMPLE.spacing == pytest.approx(2 * math.pi / 12, rel=1e-15)


def test_each_race_has_its_own_conformity():
    ring = dataclasses.replace(SIMPLE, inner_conformity=0.515, outer_conformity=3.2)
    assert (ring.conformity("inner"), ring.conformity("outer")) == (0.515, 3.2)
    assert SIMPLE.conformity("inner") == SIMPLE.conformity("outer") == 0.52
    with pytest.raises(InvalidParameter, match='race = "cage"'):
        ring.conformity("cage")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"balls": 2}, "balls = 2; allowed: whole numbers 3 to 200"),
        ({"balls": 201, "ball_diameter": 1e-4}, "balls = 201; allowed: whole numbers 3 to 200"),
        ({"balls": 9.5}, "balls = 9.5; allowed: whole numbers"),
        ({"balls": True}, "balls = True; allowed: whole numbers"),
        ({"rows": 3}, "rows = 3; allowed: whole numbers 1 to 2"),
        ({"pitch_diameter": 0.0}, "pitch_diameter = 0.0 m; it must be above 0"),
        ({"ball_diameter": math.nan}, "ball_diameter = nan m; it must be above 0"),
        ({"ball_diameter": 11e-3}, "12 balls of 11.000 mm do not fit on a pitch circle of 40.000 mm"),
        ({"load_deflection": -1.0}, "load_deflection = -1.0 N/m\\^n; it must be above 0"),
        ({"exponent": 2.5}, "exponent = 2.5; allowed: 1 to 2"),
        ({"contact_angle": 1.2}, "contact_angle = 1.2 rad; allowed: 0 to 1.0472 rad"),
        ({"clearance": 2e-3}, "clearance = 0.002 m; allowed: -0.001 to 0.001 m"),
        ({"row_offset": math.inf}, "row_offset = inf rad; it must be finite"),
        ({"inner_conformity": 0.5}, "inner_conformity = 0.5; allowed: 0.501 to 1000"),
        ({"outer_conformity": 0.4}, "outer_conformity = 0.4; allowed: 0.501 to 1000"),
    ],
)
def test_an_impossible_bearing_is_refused_by_field_and_value(change, message):
    with pytest.raises(InvalidParameter, match=message) as caught:
        dataclasses.replace(SIMPLE, **change)
    assert caught.value.field in (*change, "ball_diameter")


def test_six_balls_that_touch_each_other_fit():
    # Their centres are a hexagon, whose side is the radius of its circle; sin 30° is 0.49999999999999994 here.
    hexagon = dataclasses.replace(SIMPLE, balls=6, pitch_diameter=0.04, ball_diameter=0.02)
    assert hexagon.spacing == pytest.approx(math.pi / 3.0, rel=1e-15)
    with pytest.raises(InvalidParameter, match="do not fit"):
        dataclasses.replace(hexagon, ball_diameter=0.02 * (1.0 + 1e-9))


def test_a_race_of_another_name_is_refused():
    with pytest.raises(InvalidParameter, match='race = "cage"; allowed: outer, inner'):
        SIMPLE.raceway_radius("cage")
