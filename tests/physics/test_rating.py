"""Static load ratings against a maker's catalogue and ISO 76's own scaling."""

import dataclasses
import math

import pytest

from physics import catalog
from physics.rating import static_load_rating


def test_a_deep_groove_bearing_has_about_the_rating_its_maker_prints():
    # SKF, Rolling bearings: 6205, C0 = 7.8 kN; f0 of its own geometry is 14.0, not 14.7
    assert static_load_rating(catalog.bearing("skf_6205")) == pytest.approx(7.8e3, rel=0.08)


@pytest.mark.parametrize("name", ["skf_6205", "rexnord_za2115"])
def test_twice_the_elements_or_rows_carry_twice_the_load(name):
    bearing = dataclasses.replace(catalog.bearing(name), pitch_diameter=0.1, balls=7, rows=1)
    rows = dataclasses.replace(bearing, rows=2)
    assert static_load_rating(rows) == 2 * static_load_rating(bearing)
    balls = dataclasses.replace(bearing, balls=14)
    assert static_load_rating(balls) == 2 * static_load_rating(bearing)


def test_a_roller_bearing_is_rated_by_length_times_diameter():
    bearing = catalog.bearing("rexnord_za2115")
    # 44 N/mm² (1 - 8.407 cos 15.17° / 71.5) · 2 · 16 · 11 mm · 8.407 mm · cos 15.17°
    assert static_load_rating(bearing) == pytest.approx(111_414, rel=1e-3)  # computed by hand to four digits


def test_a_ball_bearing_with_a_contact_angle_carries_its_cosine_less():
    straight = catalog.bearing("skf_6205")
    steep = dataclasses.replace(straight, contact_angle=math.radians(40.0))
    # ISO 76: f0 i Z Db² cos α, cos 40° = 0.766044
    assert static_load_rating(steep) == pytest.approx(0.766044 * static_load_rating(straight), rel=1e-6)  # digits
