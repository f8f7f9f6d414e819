import dataclasses
import math

import pytest

from physics.checks import InvalidParameter
from physics.spall import Spall, is_extended

SPALL = Spall("outer", 1, math.radians(270), 0.1, 12e-6, 0.02, 0.01)
TABLE = dataclasses.replace(
    SPALL,
    profile="table",
    table_angle=(-0.05, 0.0, 0.05),
    table_depth=(0.0, 1e-5, 0.0),
    entry_taper=0.0,
    exit_taper=0.0,
)


def test_balls_cross_an_outer_spall_forwards_and_an_inner_one_backwards():
    assert SPALL.travel_sign == 1
    assert dataclasses.replace(SPALL, race="inner").travel_sign == -1


def test_1_2_mm_on_the_fan_rig_s_outer_race_is_2_6_degrees(authority, fan):
    check = authority("petersen_2014")["printed"]["fan_spall_deg"]
    extent = 1.2e-3 / fan.bearing.raceway_radius("outer")
    assert math.degrees(extent) == pytest.approx(check["value"], abs=check["tolerance"])  # digits printed
    assert dataclasses.replace(SPALL, extent=extent).length(fan.bearing) == pytest.approx(1.2e-3, rel=1e-14)


def test_the_same_arc_is_shorter_on_the_inner_race(fan):
    inner = dataclasses.replace(SPALL, race="inner")
    ratio = inner.length(fan.bearing) / SPALL.length(fan.bearing)
    assert ratio == pytest.approx((45.0 - 8.0) / (45.0 + 8.0), rel=1e-14)


def test_a_spall_is_extended_from_one_ball_spacing_on(gearbox):
    spacing = gearbox.bearing.spacing
    assert is_extended(spacing, gearbox.bearing)
    assert is_extended(math.radians(40), gearbox.bearing)
    assert not is_extended(0.999 * spacing, gearbox.bearing)


def test_a_spacing_stated_in_degrees_of_nine_digits_is_a_whole_one(fan):
    assert is_extended(math.radians(25.7142857), fan.bearing)


@pytest.mark.parametrize(
    ("change", "field", "message"),
    [
        ({"race": "cage"}, "race", 'race = "cage"; allowed: outer, inner'),
        ({"row": 3}, "row", "row = 3; allowed: whole numbers 1 to 2"),
        ({"row": 1.0}, "row", "row = 1.0; allowed: whole numbers 1 to 2"),
        ({"row": True}, "row", "row = True; allowed: whole numbers 1 to 2"),
        ({"profile": "box"}, "profile", 'profile = "box"; allowed: tukey, ball_path, table'),
        ({"angle": math.nan}, "angle", "angle = nan rad; allowed: -1e.06 to 1e.06 rad"),
        ({"extent": 0.0}, "extent", "extent = 0.0 rad; allowed: above 0, up to 3.14159 rad"),
        ({"extent": 4.0}, "extent", "extent = 4.0 rad; allowed: above 0, up to 3.14159 rad"),
        ({"depth": -1e-6}, "depth", "depth = -1e-06 m; allowed: 0 to 0.01 m"),
        ({"depth": math.inf}, "depth", "depth = inf m; allowed"),
        ({"roughness": -1e-6}, "roughness", "roughness = -1e-06 m; it must not be below 0"),
        ({"entry_taper": 0.2}, "entry_taper", "entry_taper = 0.2 rad; allowed: 0 to 0.1 rad"),
        ({"exit_taper": -0.01}, "exit_taper", "exit_taper = -0.01 rad; allowed: 0 to 0.1 rad"),
        ({"exit_taper": 0.09}, "entry_taper", "entry_taper \\+ exit_taper = 0.11 rad is longer than the spall"),
        ({"roughness_values": (0.0, 1e-6, 0.0)}, "roughness_values", "at least 4 numbers \\(m\\); there are 3"),
        ({"roughness_values": (0.0, 1e-6, math.nan, 0.0)}, "roughness_values", "number 3 of 4 .* = nan m"),
        (
            {"roughness_values": (0.0, -1.1e-2, 0.0, 0.0)},
            "roughness_values",
            "number 2 of 4 .* = -0.011 m; allowed: -0.01",
        ),
        ({"roughness_values": (0.0, 1e-6, 0.0, 1e-6)}, "roughness_values", "must begin and end with 0"),
        ({"table_angle": (0.0, 0.1)}, "table_depth", "table_angle has 2 values and table_depth 0"),
        ({"profile": "table"}, "table_angle", 'profile = "table" needs at least 2 table points; there are 0'),
    ],
)
def test_an_impossible_spall_is_refused_by_field_and_value(change, field, message):
    with pytest.raises(InvalidParameter, match=message) as caught:
        dataclasses.replace(SPALL, **change)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"table_angle": (-0.05, 0.05, 0.0)}, "table_angle must be finite and rise"),
        ({"table_angle": (-0.05, 0.0, 0.0)}, "table_angle must be finite and rise"),
        ({"table_angle": (-0.05, 0.0, math.inf)}, "table_angle must be finite and rise"),
        ({"table_angle": (-0.06, 0.0, 0.05)}, "table_angle = -0.06 rad; allowed: -0.05 to 0.05 rad"),
        ({"table_depth": (0.0, 0.02, 0.0)}, "table_depth = 0.02 m; allowed: -0.01 to 0.01 m"),
        ({"roughness_values": (0.0, 1e-6, 1e-6, 0.0)}, "the measured surface has its roughness; 4 roughness_values"),
    ],
)
def test_a_measured_profile_must_be_a_rising_table_of_sane_depths(change, message):
    with pytest.raises(InvalidParameter, match=message):
        dataclasses.replace(TABLE, **change)


def test_a_table_may_reach_beyond_its_spall_by_what_degrees_are_rounded_to():
    within, beyond = (0.05 * (1.0 + share) for share in (5e-10, 2e-9))
    assert dataclasses.replace(TABLE, table_angle=(-within, 0.0, within)).table_angle[-1] == within
    with pytest.raises(InvalidParameter, match=r"table_angle = -0\.05.* rad; allowed: -0\.05 to 0\.05 rad"):
        dataclasses.replace(TABLE, table_angle=(-beyond, 0.0, beyond))


def test_tapers_may_fill_the_spall_exactly():
    full = dataclasses.replace(SPALL, entry_taper=0.09, exit_taper=0.01)
    assert full.entry_taper + full.exit_taper == pytest.approx(full.extent)


@pytest.mark.parametrize("race", ["outer", "inner"])
@pytest.mark.parametrize("tapers", [(0.02, 0.0), (0.0, 0.02), (0.02, 0.02)])
def test_a_ball_is_rolled_over_a_gap_with_a_taper_at_either_end(race, tapers):
    gap = dataclasses.replace(SPALL, race=race, entry_taper=0.0, exit_taper=0.0, profile="ball_path")
    assert gap.rolled_arc == 0.0
    entry, leave = tapers
    assert dataclasses.replace(gap, entry_taper=entry, exit_taper=leave).rolled_arc == gap.extent
