import math

import numpy as np
import pytest

from physics.checks import (
    InvalidParameter,
    require_angle,
    require_below_nyquist,
    require_between,
    require_count,
    require_finite,
    require_not_negative,
    require_positive,
)

CHECKS = {
    "between": lambda value: require_between("depth", value, 0.0, 1.0, "m"),
    "finite": lambda value: require_finite("depth", value, "m"),
    "positive": lambda value: require_positive("depth", value, "m"),
    "not negative": lambda value: require_not_negative("depth", value, "m"),
    "below Nyquist": lambda value: require_below_nyquist("depth", value, 3.0),
}


@pytest.mark.parametrize("check", CHECKS.values(), ids=CHECKS)
@pytest.mark.parametrize("value", ["0.5", None, True, 0.5j, [0.5], math.nan, math.inf, -math.inf, 10**400], ids=str)
def test_what_is_no_finite_number_is_refused_by_field(check, value):
    with pytest.raises(InvalidParameter, match=r"^depth = ") as caught:
        check(value)
    assert caught.value.field == "depth"


@pytest.mark.parametrize("check", CHECKS.values(), ids=CHECKS)
@pytest.mark.parametrize("value", [0.5, 1, np.float32(0.5), np.int64(1)], ids=repr)
def test_numbers_of_any_kind_are_taken(check, value):
    check(value)


def test_a_refused_number_is_told_by_its_digits_and_a_text_in_quotes():
    for value, said in ((np.float64(1.5), "1.5"), (np.float32(2.5), "2.5"), ("1.5", "'1.5'")):
        with pytest.raises(InvalidParameter, match=f"^depth = {said} m; allowed: 0 to 1 m$"):
            require_between("depth", value, 0.0, 1.0, "m")
    with pytest.raises(InvalidParameter, match=r"^cutoff = 1\.5 Hz; allowed: from 0 to below 1 Hz, half the rate$"):
        require_below_nyquist("cutoff", np.float64(1.5), 2.0)


@pytest.mark.parametrize("value", [1e6, -1e6])
def test_angles_are_up_to_a_million_radians(value):
    require_angle("phase", value)
    with pytest.raises(InvalidParameter, match=r"^phase = .* rad; allowed: -1e\+06 to 1e\+06 rad$"):
        require_angle("phase", math.nextafter(value, 2.0 * value))


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_both_ends_of_a_range_are_allowed(value):
    require_between("depth", value, 0.0, 1.0)
    for beyond in (math.nextafter(0.0, -1.0), math.nextafter(1.0, 2.0)):
        with pytest.raises(InvalidParameter):
            require_between("depth", beyond, 0.0, 1.0)


def test_zero_is_not_positive_but_not_negative_either():
    require_not_negative("depth", 0.0)
    with pytest.raises(InvalidParameter):
        require_positive("depth", 0.0)


@pytest.mark.parametrize("rate", [0.0, -1.0, math.nan, math.inf])
def test_there_is_no_half_of_a_rate_that_is_none(rate):
    with pytest.raises(InvalidParameter, match=f"rate = {rate} Hz; it must be above 0"):
        require_below_nyquist("frequency", 50.0, rate)


def test_half_the_rate_is_not_below_it():
    require_below_nyquist("frequency", 49.9, 100.0)
    with pytest.raises(InvalidParameter):
        require_below_nyquist("frequency", 50.0, 100.0)


@pytest.mark.parametrize("value", [1, 3, np.int16(2)], ids=repr)
def test_whole_numbers_of_any_kind_are_counts(value):
    require_count("rows", value, 1, 3)


@pytest.mark.parametrize("value", [0, 4, 2.0, True, "2", None], ids=repr)
def test_what_is_no_whole_number_within_both_ends_is_no_count(value):
    with pytest.raises(InvalidParameter, match=r"^rows = .*; allowed: whole numbers 1 to 3$") as caught:
        require_count("rows", value, 1, 3)
    assert caught.value.field == "rows"
