import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

from physics.checks import InvalidParameter
from physics.hertz import (
    PointContact,
    contact_parameters,
    contact_width,
    hertz_load_deflection,
    in_series,
    is_roller,
    load_deflection_factor,
    race_contact,
    roller_length,
    roller_load_deflection_factor,
)

MODULUS = 206e9 / (1 - 0.3**2)
GROOVE = race_contact("inner", 38.75e-3, 7.12e-3)


def test_the_dimensionless_parameters_are_those_of_harris_table_6_1(authority):
    table = authority("harris")["contact_parameters"]
    for difference, *printed in table["rows"]:
        computed = contact_parameters(difference)
        assert computed == pytest.approx(printed, rel=table["tolerance"])  # four digits printed


def test_a_ball_on_a_ball_follows_the_closed_form_of_a_circular_contact():
    radius, load = 5e-3, 80.0
    contact = PointContact(along=2 / radius, across=2 / radius)
    effective_radius, effective_modulus = radius / 2, MODULUS / 2
    half_width = (3 * load * effective_radius / (4 * effective_modulus)) ** (1 / 3)
    assert contact.semi_axes(load) == pytest.approx((half_width, half_width), rel=1e-12)  # rounding
    assert contact.approach(load) == pytest.approx(half_width**2 / effective_radius, rel=1e-12)  # rounding


def hertz_integral(load, a, b, weight):
    """Hertz's integral of a `weight` over an ellipse of the semi-axes `a` along and `b` across (m) under `load` (N)."""

    # w = ab s², so that the integrand varies on the scale of s = 1 to a few.
    def integrand(s):
        w = a * b * s**2
        return 2 * math.sqrt(a * b) * weight(w) / math.sqrt((a**2 + w) * (b**2 + w))

    return 3 * load / (2 * math.pi * MODULUS) * quad(integrand, 0, np.inf, epsabs=0, epsrel=1e-10, limit=400)[0]


def curvatures(load, a, b):
    """Sums of curvatures (1/m) along and across of the bodies that such an ellipse flattens against each other."""
    return tuple(2 * hertz_integral(load, a, b, lambda w, axis=axis: 1 / (axis**2 + w)) for axis in (a, b))


@pytest.mark.parametrize("conformity", [0.505, 0.52, 0.6, 3.2])
@pytest.mark.parametrize("race", ["outer", "inner"])
def test_the_ellipse_satisfies_the_integral_equations_of_hertz(race, conformity):
    contact = race_contact(race, 38.75e-3, 7.12e-3, conformity=conformity)
    load = 63.0
    a, b = contact.semi_axes(load)
    assert curvatures(load, a, b) == pytest.approx((contact.along, contact.across), rel=1e-8)  # quadrature
    assert hertz_integral(load, a, b, lambda w: 1.0) == pytest.approx(contact.approach(load), rel=1e-8)  # quadrature


def test_nearly_circular_contacts_join_the_circular_limit_smoothly():
    below, above = contact_parameters(0.99e-4), contact_parameters(1.01e-4)
    assert np.allclose(below, above, rtol=2e-6)  # the parameters move by 4/3 of the change of F at most


@given(load=st.floats(1.0, 1e4), scale=st.floats(0.1, 10.0))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_a_bearing_scaled_in_size_scales_load_and_approach_alike(load, scale):
    small = race_contact("outer", 38.75e-3, 7.12e-3)
    large = race_contact("outer", scale * 38.75e-3, scale * 7.12e-3)
    assert large.approach(scale**2 * load) == pytest.approx(scale * small.approach(load), rel=1e-12)  # rounding


@given(load=st.floats(1e-3, 1e5))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_the_load_is_the_factor_times_the_approach_to_the_three_halves(load):
    assert GROOVE.load_deflection * GROOVE.approach(load) ** 1.5 == pytest.approx(load, rel=1e-12)  # rounding


def test_one_steel_contact_has_harris_factor(authority):
    steel = authority("harris")["steel_ball"]
    delta = contact_parameters(GROOVE.curvature_difference)[2]
    harris = steel["factor"] * (GROOVE.curvature_sum * 1e-3) ** -0.5 * delta**-1.5
    assert GROOVE.load_deflection * 1e-3**1.5 == pytest.approx(harris, rel=steel["tolerance"])  # its stiffer steel


def test_both_races_deflect_in_series():
    load = 63.0
    outer = race_contact("outer", 38.75e-3, 7.12e-3)
    both = load_deflection_factor(38.75e-3, 7.12e-3)
    deflection = GROOVE.approach(load) + outer.approach(load)
    assert both * deflection**1.5 == pytest.approx(load, rel=1e-12)  # rounding
    assert both < min(GROOVE.load_deflection, outer.load_deflection)


def test_the_gearbox_rig_s_printed_factor_is_that_of_a_self_aligning_bearing(gearbox):
    sphere = gearbox.bearing.raceway_radius("outer") / gearbox.bearing.ball_diameter
    computed = load_deflection_factor(38.75e-3, 7.12e-3, outer_conformity=sphere)
    assert computed == pytest.approx(gearbox.bearing.load_deflection, rel=0.02)  # its conformity and steel are unknown


def test_a_closer_groove_is_stiffer():
    factors = [load_deflection_factor(38.75e-3, 7.12e-3, inner_conformity=f) for f in (0.51, 0.52, 0.54, 0.6)]
    assert np.all(np.diff(factors) < 0)


def test_a_contact_angle_flattens_the_inner_race_and_bends_the_outer_one():
    straight, angular = (race_contact("inner", 40e-3, 8e-3, contact_angle=a) for a in (0.0, 0.5))
    assert angular.along == pytest.approx(2 / 8e-3 + 2 * math.cos(0.5) / (40e-3 - 8e-3 * math.cos(0.5)), rel=1e-14)
    assert angular.along < straight.along
    assert (
        race_contact("outer", 40e-3, 8e-3, contact_angle=0.5).along > race_contact("outer", 40e-3, 8e-3).along
    )  # less of the hollow race's curvature is taken off


def test_the_contact_width_of_the_gearbox_rig_is_about_0_2_mm(authority, gearbox):
    printed = authority("petersen_2014")["printed"]["contact_width_mm"]
    width = contact_width(gearbox.bearing, "outer", gearbox.bearing.stribeck_peak_load(346.0))
    assert width * 1e3 == pytest.approx(printed["value"], abs=printed["tolerance"])  # an order of magnitude, one digit


def test_the_contact_width_is_the_short_axis_in_a_groove_and_grows_with_the_cube_root_of_load(gearbox):
    bearing, load = gearbox.bearing, 63.0
    width = contact_width(bearing, "inner", load)
    # 2/D + 1/R along the race, and 2/D less the curvature of the groove across it.
    ball, groove = 2 / bearing.ball_diameter, 1 / (bearing.inner_conformity * bearing.ball_diameter)
    half_across = brentq(
        lambda b: curvatures(load, width / 2, b)[1] - (ball - groove), width / 2, 50 * width, xtol=1e-14
    )
    along = ball + 1 / bearing.raceway_radius("inner")
    assert curvatures(load, width / 2, half_across)[0] == pytest.approx(along, rel=1e-7)  # quadrature and root
    ratio = contact_width(bearing, "inner", 8 * load) / width
    assert ratio == pytest.approx(2.0, rel=1e-12)  # rounding


def test_a_contact_longer_along_than_across_gives_its_long_axis_along():
    contact = PointContact(along=10.0, across=400.0)
    along, across = contact.semi_axes(50.0)
    assert along > across


def test_palmgren_s_roller_agrees_with_the_line_contact_of_elasticity_at_each_race():
    length, load = 10e-3, 1000.0
    half_space = 2 * load / (math.pi * MODULUS * length)
    one_race = half_space * math.log(math.pi * MODULUS * length**2 / load)
    deflection = (load / roller_load_deflection_factor(length)) ** 0.9
    assert deflection == pytest.approx(2 * one_race, rel=0.06)  # Palmgren's is a fit to measurements


def test_palmgren_s_deflection_of_one_race_is_3_84e_5_q_to_0_9_over_l_to_0_8_mm():
    length, load = 12.0, 500.0
    both = (load / roller_load_deflection_factor(length * 1e-3)) ** 0.9 * 1e3
    assert both / 2 == pytest.approx(3.84e-5 * load**0.9 / length**0.8, rel=1e-3)  # 8.06e4 is rounded to three digits


@given(length=st.floats(1e-3, 0.1))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_the_roller_length_is_recovered_from_its_factor(length):
    assert roller_length(roller_load_deflection_factor(length)) == pytest.approx(length, rel=1e-12)  # rounding


def test_two_equal_contacts_in_series_deflect_twice():
    assert in_series(3.0, 3.0, 1.5) == pytest.approx(3.0 / 2**1.5, rel=1e-14)


def test_the_contact_width_of_a_roller_is_that_of_two_cylinders(gearbox):
    length, load = 10e-3, 2000.0
    roller = dataclasses.replace(
        gearbox.bearing, exponent=10 / 9, load_deflection=roller_load_deflection_factor(length)
    )
    assert is_roller(roller)
    assert not is_roller(gearbox.bearing)
    radius = 1 / (2 / roller.ball_diameter + 1 / roller.raceway_radius("inner"))
    half = math.sqrt(4 * load / length * radius / (math.pi * MODULUS / 2))
    assert contact_width(roller, "inner", load) == pytest.approx(2 * half, rel=1e-12)  # rounding


def test_a_bearing_s_contact_angle_enters_its_factor_and_the_width_of_its_contacts(gearbox):
    angle, load = 0.7, 63.0
    bearing = dataclasses.replace(gearbox.bearing, contact_angle=angle, inner_conformity=0.51, outer_conformity=0.53)
    # 2/D + cos α / R of the inner race and 2/D − cos α / R of the outer one, R = (Dp ∓ D cos α) / 2.
    pitch, ball, cosine = bearing.pitch_diameter, bearing.ball_diameter, math.cos(angle)
    contacts = [
        PointContact(2.0 / ball + sign * 2.0 * cosine / (pitch - sign * ball * cosine), (2.0 - 1.0 / conformity) / ball)
        for sign, conformity in ((1.0, 0.51), (-1.0, 0.53))
    ]
    deflection = sum(contact.approach(load) for contact in contacts)
    assert hertz_load_deflection(bearing) * deflection**1.5 == pytest.approx(load, rel=1e-12)  # rounding
    for race, contact in zip(("inner", "outer"), contacts, strict=True):
        assert contact_width(bearing, race, load) == pytest.approx(2.0 * contact.semi_axes(load)[0], rel=1e-12)


@pytest.mark.parametrize(("exponent", "roller"), [(1.0, True), (1.30, True), (1.31, False), (2.0, False)])
def test_elements_are_of_the_kind_whose_exponent_is_nearer(gearbox, exponent, roller):
    assert (abs(exponent - 10.0 / 9.0) < abs(exponent - 1.5)) is roller
    assert is_roller(dataclasses.replace(gearbox.bearing, exponent=exponent)) is roller


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: race_contact("outer", 38.75e-3, 7.12e-3, conformity=0.5), "conformity = 0.5"),
        (lambda: race_contact("cage", 38.75e-3, 7.12e-3), 'race = "cage"'),
        (lambda: load_deflection_factor(39e-3, 0.0), "ball_diameter = 0.0 m; it must be above 0"),
        (lambda: load_deflection_factor(math.nan, 8e-3), "pitch_diameter = nan m; it must be above 0"),
        (lambda: load_deflection_factor(8e-3, 8e-3), r"ball_diameter = 0\.008 m; it must be below the pitch diameter"),
        (lambda: load_deflection_factor(39e-3, 8e-3, 2.0), r"contact_angle = 2\.0 rad; allowed: 0 to 1\.0472 rad"),
        (lambda: contact_parameters(1.0), "curvature_difference = 1.0"),
        (lambda: PointContact(along=-1.0, across=1.0), "along = -1.0"),
        (lambda: roller_length(0.0), "load_deflection = 0.0"),
        (lambda: roller_load_deflection_factor(-1e-3), "length = -0.001"),
    ],
)
def test_impossible_contacts_are_refused_by_name_and_value(call, message):
    with pytest.raises(InvalidParameter, match=message):
        call()


def test_a_contact_without_load_has_no_width(gearbox):
    with pytest.raises(InvalidParameter, match="load = 0"):
        contact_width(gearbox.bearing, "outer", 0.0)
