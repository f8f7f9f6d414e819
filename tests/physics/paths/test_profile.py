"""The path of the ball's centre: closed forms, Tukey window, orientation and sums on both races."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measures import hanging
from short_spalls import EXTENT, gap, inside, tukey

from physics.imperfections import Imperfections, Waviness
from physics.paths.depth_path import hermite_cubics
from physics.paths.profile import build_path, race_depth, race_depths, wrap
from physics.paths.spall_surface import window
from physics.spall import Spall

RACES = pytest.mark.parametrize("race", ["outer", "inner"])
PICOMETRE = 1e-12  # cubic cells against the curve they follow: their fourth derivative times a 48th of a taper, ^4/384


def rounded_ramp(distance, taper):
    return np.where(distance < taper, 0.5 * (1 - np.cos(np.pi * distance / taper)), 1.0)


@pytest.mark.parametrize(
    ("name", "race", "arc", "check"),
    [
        ("gearbox", "outer", EXTENT, "gearbox_outer_2_deg_um"),
        ("fan", "outer", None, "fan_outer_1_2_mm_um"),
        ("fan", "inner", None, "fan_inner_1_2_mm_um"),
    ],
)
def test_a_ball_sinks_into_a_deep_gap_as_far_as_the_independent_implementation_says(
    authority, request, name, race, arc, check
):
    bearing = request.getfixturevalue(name).bearing
    expected = authority("independent_model")["ball_path"][check]
    path = build_path(gap(race, arc or 1.2e-3 / bearing.raceway_radius(race)), bearing)
    assert path.largest_depth * 1e6 == pytest.approx(expected["value"], abs=expected["tolerance"])  # the digits given
    assert path.bridged
    assert path.deepest == 0.0


@RACES
def test_the_path_over_a_deep_gap_is_the_closed_form(gearbox, race):
    arcs = inside(gap(race))
    path = build_path(gap(race), gearbox.bearing)
    exact = hanging(race, gearbox.bearing.raceway_radius(race), gearbox.bearing.ball_radius, EXTENT / 2 - np.abs(arcs))
    assert np.max(np.abs(path.depth(arcs) - exact)) < PICOMETRE


@RACES
@pytest.mark.parametrize("depth", [1e-6, 12e-6, 100e-6])
@pytest.mark.parametrize("extent", [EXTENT, math.radians(40.0)])
def test_the_closed_form_and_the_rolled_surface_are_the_same_path(gearbox, race, depth, extent):
    analytic = build_path(gap(race, extent, depth), gearbox.bearing)
    flat = (0.0,) * 8  # roughness of zero height: the same gap, but rolled
    rolled = build_path(gap(race, extent, depth, roughness_values=flat), gearbox.bearing)
    arcs = inside(gap(race, extent), 4001)
    difference = np.abs(analytic.depth(arcs) - rolled.depth(arcs))
    assert np.max(difference) < PICOMETRE
    assert rolled.bridged == analytic.bridged
    assert rolled.largest_depth == pytest.approx(analytic.largest_depth, rel=1e-9)  # the deepest point is a node


@RACES
def test_the_ball_reaches_a_floor_that_lies_above_its_deepest_sag(gearbox, race):
    sag = build_path(gap(race), gearbox.bearing).largest_depth
    above, below = (build_path(gap(race, depth=share * sag), gearbox.bearing) for share in (0.999, 1.001))
    assert not above.bridged
    assert above.largest_depth == pytest.approx(0.999 * sag, rel=1e-12)
    assert below.bridged
    assert below.largest_depth == pytest.approx(sag, rel=1e-12)


@RACES
def test_on_the_floor_the_path_is_flat(gearbox, race):
    path = build_path(gap(race, math.radians(40.0), 4e-6), gearbox.bearing)
    floor = np.linspace(path.breaks[1], path.breaks[2], 50)
    assert np.allclose(path.depth(floor), 4e-6, rtol=1e-12)
    assert np.max(np.abs(path.slope(floor[1:-1]))) == 0.0
    assert path.deepest == pytest.approx(0.0, abs=1e-12)


@RACES
def test_a_gap_without_depth_is_a_healthy_race(gearbox, race):
    path = build_path(gap(race, depth=0.0), gearbox.bearing)
    assert np.array_equal(path.depth(inside(gap(race))), np.zeros(1001))
    assert not path.bridged
    assert path.breaks.tolist() == [-EXTENT / 2, EXTENT / 2]


@RACES
def test_a_tapered_gap_is_bridged_although_the_ball_touches_its_tapers(gearbox, race):
    taper = math.radians(0.3)
    path = build_path(gap(race, depth=100e-6, entry_taper=taper, exit_taper=taper), gearbox.bearing)
    assert path.bridged
    assert path.largest_depth < 50e-6
    shallow = build_path(gap(race, depth=4e-6, entry_taper=taper, exit_taper=taper), gearbox.bearing)
    assert not shallow.bridged
    assert shallow.largest_depth == pytest.approx(4e-6, rel=1e-9)


@RACES
@given(shallow=st.floats(0.0, 60e-6), extra=st.floats(0.0, 60e-6), extent=st.floats(0.005, 0.3))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_a_deeper_gap_never_lifts_the_ball_and_the_ball_never_passes_its_floor(gearbox, race, shallow, extra, extent):
    arcs = inside(gap(race, extent), 501)
    upper = build_path(gap(race, extent, shallow), gearbox.bearing).depth(arcs)
    lower = build_path(gap(race, extent, shallow + extra), gearbox.bearing).depth(arcs)
    assert np.all(lower >= upper - PICOMETRE)
    assert np.all(upper >= -PICOMETRE)
    assert np.all(upper <= shallow + PICOMETRE)


def test_the_tukey_path_is_the_window_of_equation_17(gearbox):
    spall = tukey()
    arcs = inside(spall)
    half = EXTENT / 2
    expected = 12e-6 * np.minimum(rounded_ramp(arcs + half, 0.010), rounded_ramp(half - arcs, 0.004))
    path = build_path(spall, gearbox.bearing)
    assert np.max(np.abs(path.depth(arcs) - expected)) < 10 * PICOMETRE
    assert np.max(np.abs(12e-6 * window(spall, arcs) - expected)) < 1e-20
    assert path.breaks == pytest.approx([-half, -half + 0.010, half - 0.004, half], abs=1e-15)
    assert path.largest_depth == 12e-6
    assert path.deepest == pytest.approx(0.5 * (0.010 - 0.004), abs=1e-12)
    assert not path.bridged


@pytest.mark.parametrize("arc", [-EXTENT / 2 + 0.005, EXTENT / 2 - 0.002])
def test_half_way_down_a_taper_the_path_has_half_its_depth(gearbox, arc):
    assert build_path(tukey(), gearbox.bearing).depth(np.array([arc]))[0] == pytest.approx(6e-6, rel=1e-6)  # the cells


def test_without_tapers_the_tukey_path_is_a_step(gearbox):
    path = build_path(tukey(entry_taper=0.0, exit_taper=0.0), gearbox.bearing)
    edge = np.array([-EXTENT / 2 - 1e-9, -EXTENT / 2 + 1e-9, EXTENT / 2 - 1e-9, EXTENT / 2 + 1e-9])
    assert path.depth(edge) == pytest.approx([0.0, 12e-6, 12e-6, 0.0], abs=1e-20)
    assert path.breaks.tolist() == [-EXTENT / 2, EXTENT / 2]


def test_tapers_that_meet_share_one_kink(gearbox):
    path = build_path(tukey(entry_taper=0.9 * EXTENT, exit_taper=0.1 * EXTENT), gearbox.bearing)
    assert path.breaks == pytest.approx([-EXTENT / 2, 0.4 * EXTENT, EXTENT / 2], abs=1e-12)
    assert np.all(np.diff(path.breaks) > 0)


@pytest.mark.parametrize(
    "spall",
    [
        tukey(),
        tukey(roughness_values=(0.0, 1e-6, -1e-6, 2e-6, 0.0)),
        gap(),
        gap("inner", depth=5e-6),
        gap(depth=20e-6, entry_taper=0.005, exit_taper=0.01),
        gap(depth=5e-6, roughness_values=(0.0, 1e-6, -1e-6, 2e-6, 0.0)),
    ],
)
def test_every_path_is_zero_outside_smooth_between_its_kinks_and_has_its_own_slope(gearbox, spall):
    path = build_path(spall, gearbox.bearing)
    outside = EXTENT / 2 * np.array([-100.0, -1.0 - 1e-9, 1.0 + 1e-9, 100.0])
    assert np.array_equal(path.depth(outside), np.zeros(4))
    assert np.array_equal(path.slope(outside), np.zeros(4))
    assert path.breaks[[0, -1]] == pytest.approx([-EXTENT / 2, EXTENT / 2], rel=1e-12)
    h = 1e-9
    nodes = np.concatenate(
        [np.linspace(a, b, n + 1) for a, b, n in zip(path.breaks[:-1], path.breaks[1:], path.cells, strict=True)]
    )
    arcs = np.random.default_rng(1).uniform(-EXTENT / 2, EXTENT / 2, 300)
    arcs = arcs[np.abs(arcs[:, None] - nodes).min(axis=1) > 2 * h]
    difference = (path.depth(arcs + h) - path.depth(arcs - h)) / (2 * h)
    assert np.allclose(difference, path.slope(arcs), rtol=1e-5, atol=2e-11)  # rounding of depths, 1e-20, over h
    away = nodes[np.abs(nodes[:, None] - path.breaks).min(axis=1) > 2 * h]
    assert np.allclose(path.depth(away - 1e-15), path.depth(away + 1e-15), atol=1e-16)
    assert np.allclose(path.slope(away - h), path.slope(away + h), rtol=1e-3, atol=1e-9 + 4 * h * bend(path))


def bend(path):
    """Largest second derivative of a path, m/rad²."""
    widths = np.repeat(np.diff(path.breaks) / path.cells, path.cells)
    return np.max(np.abs(path.cubics[:, :2] @ [[6.0, 0.0], [2.0, 2.0]]) / widths[:, None] ** 2)


@RACES
@pytest.mark.parametrize("profile", ["tukey", "ball_path"])
def test_a_ball_meets_the_entry_taper_first_on_either_race(gearbox, build_scene, race, profile):
    spall = Spall(race, 1, 1.0, 0.1, 6e-6, entry_taper=0.06, exit_taper=0.02, profile=profile)
    scene = build_scene(gearbox, spall)
    race_speed = scene.operation.shaft_speed if race == "inner" else 0.0
    slip = scene.cage.mean_speed - race_speed  # the ball's speed relative to that race
    travelled = np.linspace(-0.06, 0.06, 6001)
    met = race_depth(scene, 1, 1.0 + travelled * np.sign(slip))
    assert np.allclose(met, build_path(spall, gearbox.bearing).depth(travelled), rtol=0, atol=1e-17)
    half_down = travelled[met > 3e-6][[0, -1]]
    assert half_down == pytest.approx([-0.05 + 0.03, 0.05 - 0.01], abs=3e-3)  # the contact leads by Rb times the slope


@RACES
def test_the_path_on_a_race_wraps_around(gearbox, build_scene, race):
    scene = build_scene(gearbox, tukey(race, angle=math.pi - 0.001))
    angle = np.linspace(-0.01, 0.01, 41)
    there = race_depth(scene, 1, math.pi - 0.001 + angle)
    assert np.max(there) == 12e-6
    for turns in (-3, -1, 2):
        assert np.allclose(race_depth(scene, 1, math.pi - 0.001 + angle + turns * 2 * math.pi), there, atol=1e-16)


def test_angles_wrap_into_half_a_turn_either_side():
    assert wrap(np.array([math.pi, -math.pi, 7.0, -7.0, 0.5])) == pytest.approx(
        [-math.pi, -math.pi, 7 - 2 * math.pi, 2 * math.pi - 7, 0.5], abs=1e-15
    )


def test_spalls_of_one_row_add_up_and_stay_off_the_other_row(gearbox, build_scene):
    first, second = tukey(angle=0.0), tukey(angle=1.0, depth=5e-6)
    other = tukey(angle=2.0, row=2, depth=7e-6)
    scene = build_scene(gearbox, first, second, other)
    angle = np.array([0.003, 1.003, 2.003])
    assert race_depth(scene, 1, angle) == pytest.approx([12e-6, 5e-6, 0.0], abs=1e-18)
    assert race_depth(scene, 2, angle) == pytest.approx([0.0, 0.0, 7e-6], abs=1e-18)


@RACES
def test_the_waviness_of_the_defective_race_belongs_to_the_path_and_that_of_the_other_race_does_not(
    gearbox, build_scene, race
):
    waves = (Waviness("outer", 7, 1e-6, 0.3), Waviness("inner", 12, 2e-6, 0.8))
    scene = build_scene(gearbox, tukey(race), imperfections=Imperfections(waviness=waves))
    smooth = build_scene(gearbox, tukey(race))
    angle = np.linspace(-4.0, 4.0, 101)
    wave = 1e-6 * np.cos(7 * angle + 0.3) if race == "outer" else 2e-6 * np.cos(12 * angle + 0.8)
    for row in (1, 2):
        assert np.allclose(race_depth(scene, row, angle) - race_depth(smooth, row, angle), wave, atol=1e-18)


@RACES
def test_all_around_the_race_every_row_has_the_path_that_single_angles_have(gearbox, build_scene, race):
    waves = (Waviness("outer", 7, 1e-6, 0.3), Waviness("inner", 12, 2e-6, 0.8), Waviness("inner", 499, 1e-7, 2.0))
    spalls = tukey(race, angle=3.13), tukey(race, angle=1.0, row=2, depth=7e-6)
    scene = build_scene(gearbox, *spalls, imperfections=Imperfections(waviness=waves))
    around = race_depths(scene, 20000)
    angle = np.linspace(-math.pi, math.pi, 20001)[:-1]
    assert around.max() > 10e-6
    for row in (1, 2):
        assert np.allclose(around[row - 1], race_depth(scene, row, angle), rtol=0, atol=1e-17)


@RACES
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_all_around_the_race_a_table_at_one_end_of_its_spall_is_whole(gearbox, build_scene, race, side):
    angle, depth = np.array([0.05, 0.08, 0.12, 0.15]), np.array([0.0, 8e-6, 8e-6, 0.0])
    if side < 0.0:
        angle = -angle[::-1]
    measured = Spall(race, 1, 1.0, 0.31, 0.0, profile="table", table_angle=tuple(angle), table_depth=tuple(depth))
    scene = build_scene(gearbox, measured)
    around = race_depths(scene, 2000)
    single = race_depth(scene, 1, np.linspace(-math.pi, math.pi, 2001)[:-1])
    assert np.count_nonzero(single > 7e-6) > 10
    assert np.allclose(around[0], single, rtol=0, atol=1e-17)


def test_a_wave_that_the_points_around_the_race_cannot_show_is_refused(gearbox, build_scene):
    scene = build_scene(gearbox, tukey(), imperfections=Imperfections(waviness=(Waviness("outer", 4, 1e-6),)))
    assert race_depths(scene, 9).shape == (2, 9)
    with pytest.raises(ValueError, match="8 points are too few for 4 waves a turn"):
        race_depths(scene, 8)


def test_hermite_cells_have_the_values_and_slopes_of_their_nodes():
    value, rate = np.array([1.0, 3.0, 2.0]), np.array([0.5, -1.0, 4.0])
    cubics = hermite_cubics(value, rate)
    assert [np.polyval(c, 0.0) for c in cubics] == pytest.approx(value[:2])
    assert [np.polyval(c, 1.0) for c in cubics] == pytest.approx(value[1:])
    assert [np.polyval(np.polyder(c), 0.0) for c in cubics] == pytest.approx(rate[:2])
    assert [np.polyval(np.polyder(c), 1.0) for c in cubics] == pytest.approx(rate[1:])


def test_the_path_of_a_spall_is_built_once_and_that_of_another_spall_or_bearing_anew(gearbox, fan):
    path = build_path(tukey(), gearbox.bearing)
    assert build_path(tukey(), dataclasses.replace(gearbox.bearing)) is path
    assert build_path(tukey(depth=13e-6), gearbox.bearing) is not path
    assert build_path(gap(), gearbox.bearing).largest_depth != build_path(gap(), fan.bearing).largest_depth


@pytest.mark.parametrize("depth", [0.0, 1e-9])
@pytest.mark.parametrize("taper", [0.0, 0.01])
def test_a_floor_that_stands_proud_of_the_race_throughout_is_lowest_at_an_edge(gearbox, depth, taper):
    heights = (0.0, -1e-6, -1e-6, -1e-6, 0.0)
    shape = {"extent": 0.035, "depth": depth, "entry_taper": taper, "exit_taper": taper}
    spall = tukey(roughness=1e-6, roughness_values=heights, **shape)
    path = build_path(spall, gearbox.bearing)
    assert 0.0 <= path.largest_depth <= depth
    assert abs(path.deepest) == pytest.approx(0.0175, rel=0.1)
    assert path.depth(np.array([0.0])) == pytest.approx(depth - 1e-6)


def test_a_spall_elsewhere_on_the_race_has_the_same_path(gearbox):
    spall = gap("inner", entry_taper=1e-3)
    elsewhere = dataclasses.replace(spall, angle=spall.angle + 1.0, row=2)
    assert build_path(elsewhere, gearbox.bearing) is build_path(spall, gearbox.bearing)
