"""The path of the ball's centre over measured tables and rough floors."""

import dataclasses
import math

import numpy as np
import pytest
from measures import hanging
from scipy.interpolate import CubicSpline
from short_spalls import BOTTOM, EXTENT, gap, inside, tukey

from physics.paths.profile import build_path, is_rough, race_depth
from physics.paths.roughness import draw_roughness
from physics.paths.spall_surface import roughness_curve, window
from physics.spall import Spall

RACES = pytest.mark.parametrize("race", ["outer", "inner"])
BETWEEN_NODES = 1e-9  # m: what cells of 4 µm leave between the corners, which are edges of cells


def table(race, angle, depth, extent=EXTENT):
    return Spall(race, 1, BOTTOM, extent, 0.0, profile="table", table_angle=tuple(angle), table_depth=tuple(depth))


@RACES
def test_a_table_of_a_gentle_surface_is_followed_by_the_ball(gearbox, race):
    knots = np.array([-0.15, -0.05, 0.1, 0.15])
    values = np.array([0.0, 6e-6, 2e-6, 0.0])
    path = build_path(table(race, knots, values, 0.3), gearbox.bearing)
    arcs = np.linspace(-0.15, 0.15, 601)
    surface = np.interp(arcs if race == "outer" else -arcs, knots, values)
    steepest = 6e-6 / 0.05 / gearbox.bearing.raceway_radius(race)
    assert np.max(np.abs(path.depth(arcs) - surface)) < gearbox.bearing.ball_radius * steepest**2  # Rb (s′)²/2, corners
    assert not path.bridged


@RACES
@pytest.mark.parametrize("extent", [0.04, 0.0531, 0.3])
def test_a_ball_hangs_on_the_wall_of_a_table_wherever_in_the_spall_it_is(gearbox, race, extent):
    angle, walls = np.array([-0.02, -0.00713, 0.0113, 0.02]), np.array([3e-6, 8e-6, 8e-6, 3e-6])
    path = build_path(table(race, angle, walls, extent), gearbox.bearing)
    away = np.array([0.001, 0.003, 0.006])
    radius, ball = gearbox.bearing.raceway_radius(race), gearbox.bearing.ball_radius
    for arcs in (-0.02 + away, 0.02 - away):
        assert path.depth(arcs) == pytest.approx(hanging(race, radius, ball, away), abs=1e-12)
    assert path.depth(np.array([-0.0201, 0.0201])) == pytest.approx([0.0, 0.0], abs=0.0)


@RACES
def test_a_table_is_given_in_the_direction_of_rising_angle_on_either_race(gearbox, build_scene, race):
    spall = table(race, [-0.15, -0.14, 0.15], [0.0, 5e-6, 0.0], 0.3)
    scene = build_scene(gearbox, spall)
    low, high = race_depth(scene, 1, BOTTOM + np.array([-0.12, 0.12]))
    assert low == pytest.approx(5e-6 * 0.27 / 0.29, rel=5e-3)  # the ball hangs a little above a sloping floor
    assert high == pytest.approx(5e-6 * 0.03 / 0.29, rel=5e-3)
    assert build_path(spall, gearbox.bearing).deepest * spall.travel_sign < -0.1


@RACES
def test_a_table_of_a_gap_gives_the_path_of_the_gap(gearbox, race):
    half = EXTENT / 2
    spall = table(race, [-half, half], [30e-6, 30e-6])
    arcs = inside(spall)
    rolled, analytic = build_path(spall, gearbox.bearing), build_path(gap(race, depth=30e-6), gearbox.bearing)
    assert np.max(np.abs(rolled.depth(arcs) - analytic.depth(arcs))) < BETWEEN_NODES
    assert rolled.bridged
    assert analytic.bridged


@RACES
def test_a_pit_narrower_than_the_ball_can_feel_is_felt_as_a_narrow_gap(gearbox, race):
    spall = table(race, [-0.001, -0.00099, 0.00099, 0.001], [0.0, 20e-6, 20e-6, 0.0])
    path = build_path(spall, gearbox.bearing)
    assert path.bridged
    sharp = hanging(race, gearbox.bearing.raceway_radius(race), gearbox.bearing.ball_radius, 0.001)
    assert path.largest_depth == pytest.approx(float(sharp), rel=0.05)  # sloping walls
    assert path.largest_depth < 0.01 * 20e-6


@RACES
def test_a_lip_beside_a_measured_spall_lifts_the_ball_before_it_gets_there(gearbox, race):
    half = EXTENT / 2
    spall = table(race, [-half, -half + 0.002, -half + 0.004, half], [0.0, -3e-6, 10e-6, 0.0])
    path = build_path(spall, gearbox.bearing)
    first, last = path.breaks[[0, -1]] * spall.travel_sign
    arcs = np.linspace(*path.breaks[[0, -1]], 2001)
    depth = path.depth(arcs)
    assert depth.min() == pytest.approx(-3e-6, rel=5e-3)  # the lip is a corner between two points of the surface
    assert np.max(np.abs(depth[[0, -1]])) < 1e-18
    assert np.max(np.abs(np.diff(depth))) < 0.1e-6  # no jump at the edges of the spall
    assert min(first, last) < -half
    assert path.relief[-1] == pytest.approx(np.ptp(depth), rel=5e-3)  # a free ball may touch the lip within a step


@pytest.mark.parametrize(("turns", "expected"), [(1, False), (3, False), (8, False), (9, True), (60, True)])
def test_a_table_is_rough_if_it_goes_up_and_down_all_along(gearbox, turns, expected):
    angle = np.linspace(-0.15, 0.15, turns + 2)
    depth = np.where(np.arange(turns + 2) % 2 == 1, 6e-6, 1e-6)
    fine = np.linspace(-0.15, 0.15, 400)  # many points alone make no roughness
    spall = table("outer", fine, np.interp(fine, angle, depth).tolist(), 0.3)
    assert is_rough(spall, gearbox.bearing) is expected


def test_flat_stretches_of_a_table_are_no_turns(gearbox):
    levels = np.repeat(np.where(np.arange(9) % 2 == 1, 6e-6, 1e-6), 2)  # eight moves, so seven turns
    assert not is_rough(table("outer", np.linspace(-0.15, 0.15, levels.size), levels.tolist(), 0.3), gearbox.bearing)


@RACES
@pytest.mark.parametrize(("share", "bridged"), [(0.99, False), (1.1, True)])
def test_a_ball_bridges_a_rolled_floor_that_it_misses_by_a_tenth_of_the_depth(gearbox, race, share, bridged):
    sag = hanging(race, gearbox.bearing.raceway_radius(race), gearbox.bearing.ball_radius, EXTENT / 2)
    assert build_path(gap(race, depth=share * sag, roughness_values=(0.0,) * 8), gearbox.bearing).bridged is bridged


@RACES
@pytest.mark.parametrize(("shelf", "bridged"), [(4e-6, False), (2e-6, True)])
def test_a_shelf_deeper_than_half_of_a_table_is_floor_of_it(gearbox, race, shelf, bridged):
    angle = np.array([0.0004, 0.0005, 0.1, 0.15])  # a pit 18 µm wide in a shelf of 4 mm
    depth = np.array([6e-6, shelf, shelf, 0.0])
    pit = table(race, np.concatenate([-angle[::-1], angle]), np.concatenate([depth[::-1], depth]).tolist(), 0.3)
    path = build_path(pit, gearbox.bearing)
    assert path.largest_depth == pytest.approx(shelf, abs=0.1e-6)
    assert path.bridged is bridged


def rough(race="outer", profile="tukey", seed=1, deviation=1e-6, count=41):
    values = np.random.default_rng(seed).normal(0, deviation, count)
    values[[0, -1]] = 0.0
    return tukey(race, profile=profile, roughness=deviation, roughness_values=tuple(values))


def test_a_rough_tukey_path_is_the_window_plus_the_natural_spline_through_its_values(gearbox):
    spall = rough()
    arcs = inside(spall, 2001)
    knots = np.linspace(-EXTENT / 2, EXTENT / 2, 41)
    bumps = CubicSpline(knots, spall.roughness_values, bc_type="natural")(arcs)
    path = build_path(spall, gearbox.bearing)
    assert np.max(np.abs(path.depth(arcs) - 12e-6 * window(spall, arcs) - bumps)) < 0.02e-6  # quarters of the steps
    at_knots = path.depth(knots) - 12e-6 * window(spall, knots)
    assert np.allclose(at_knots, spall.roughness_values, atol=0.02e-6)
    assert np.std(at_knots) == pytest.approx(np.std(spall.roughness_values), rel=0.01)  # nothing is filtered twice


@pytest.mark.parametrize("profile", ["tukey", "ball_path"])
def test_a_spall_with_roughness_is_rough_and_one_without_is_not_whatever_its_profile(gearbox, profile):
    uneven, smooth = rough("outer", profile), tukey(profile=profile)
    assert [is_rough(spall, gearbox.bearing) for spall in (uneven, smooth)] == [True, False]


def test_a_smooth_spall_has_no_roughness_curve():
    assert roughness_curve(tukey()) is None


@RACES
def test_a_rough_floor_of_a_rolled_gap_is_smoothed_by_the_ball_from_above(gearbox, race):
    spall = rough(race, "ball_path")
    arcs = inside(spall, 1001)
    surface = 12e-6 * window(spall, arcs) + roughness_curve(spall)(arcs)
    depth = build_path(spall, gearbox.bearing).depth(arcs)
    smooth = build_path(tukey(race, profile="ball_path"), gearbox.bearing).depth(arcs)
    assert np.all(depth <= np.maximum(surface, 0.0) + BETWEEN_NODES)
    assert np.mean(depth) < np.mean(smooth)  # the ball rides on the crests
    assert np.std(np.diff(depth, 2)) < np.std(np.diff(surface, 2))


@RACES
@pytest.mark.parametrize("profile", ["tukey", "ball_path"])
def test_the_deepest_point_of_a_rough_path_may_lie_between_nodes(gearbox, race, profile):
    path = build_path(rough(race, profile), gearbox.bearing)
    arcs = np.linspace(-EXTENT / 2, EXTENT / 2, 400_001)
    depth = path.depth(arcs)
    assert path.largest_depth == pytest.approx(depth.max(), abs=1e-10)  # m: half a step beside a corner of the path
    assert path.deepest == pytest.approx(arcs[np.argmax(depth)], abs=1e-7)  # one step, 9e-8; nodes are 2e-4 apart


@RACES
def test_a_surface_that_is_nowhere_proud_of_the_race_never_lifts_the_ball_above_it(gearbox, race):
    # Taper and race meet without a step or a kink, but only the taper bends: no parabola runs through both.
    values = np.zeros(41)
    values[5:-5] = 0.7e-6 * np.sin(np.arange(31))
    spall = Spall(race, 1, BOTTOM, 0.016, 180e-6, 0.0059, 0.0008, "ball_path", 0.5e-6, tuple(values))
    path = build_path(spall, gearbox.bearing)
    depth = path.depth(np.linspace(path.breaks[0], path.breaks[-1], 20_001))
    assert depth.min() > -1e-13
    assert np.abs(path.depth(path.breaks[[0, -1]])).max() < 1e-13
    assert np.abs(path.slope(path.breaks[-1:] - 1e-9)).max() < 1e-7  # m/rad: 2 nm/s at the rated speed


@pytest.mark.parametrize(("pitch", "ball"), [(1.0, 0.05), (3.0, 0.1)])
def test_the_path_over_a_spall_of_metres_has_bounded_cells_and_is_as_exact_as_over_its_beginning(gearbox, pitch, ball):
    bearing = dataclasses.replace(gearbox.bearing, pitch_diameter=pitch, ball_diameter=ball)
    extent = 1.2
    heights = draw_roughness(np.random.default_rng(1), bearing, "outer", extent, 1e-5, None)
    whole = Spall("outer", 1, 4.7, extent, 1e-4, 0.0, 0.0, "ball_path", 1e-5, heights)
    path = build_path(whole, bearing)
    assert path.cells.sum() < 60_000
    # The same surface over its first 0.1 m alone, where steps are as short as on any small spall.
    few = math.ceil(0.1 / (extent * bearing.raceway_radius("outer")) * (len(heights) - 1))
    share = few / (len(heights) - 1)
    beginning = dataclasses.replace(whole, extent=share * extent, roughness_values=(*heights[:few], 0.0))
    arcs = np.linspace(0.1, 0.8, 20001) * share * extent
    drops = [build_path(one, bearing).depth(arcs - one.extent / 2.0) for one in (whole, beginning)]
    assert np.std(drops[1]) > 1e-6
    assert np.sqrt(np.mean((drops[0] - drops[1]) ** 2)) < 2e-9


@pytest.mark.parametrize("count", [8, 20, 60])
@pytest.mark.parametrize("tapers", [(0.3, 0.06), (0.01, 0.0)])
def test_beside_tapers_the_path_follows_rough_values_of_any_kind(gearbox, count, tapers):
    values = np.random.default_rng(count).normal(0.0, 1e-6, count)
    values[[0, -1]] = 0.0
    spall = Spall("outer", 1, BOTTOM, 0.6, 8e-6, *tapers, "tukey", 1e-6, tuple(values))
    arcs = np.linspace(-0.2999, 0.2999, 20_001)
    floor = CubicSpline(np.linspace(-0.3, 0.3, count), values, bc_type="natural")(arcs)
    rise = np.cos(np.pi * np.clip((0.3 + arcs) / tapers[0], 0.0, 1.0))
    fall = np.cos(np.pi * np.clip((0.3 - arcs) / tapers[1], 0.0, 1.0)) if tapers[1] else -1.0
    expected = 8e-6 * np.minimum(0.5 - 0.5 * rise, 0.5 - 0.5 * fall) + floor
    assert np.abs(build_path(spall, gearbox.bearing).depth(arcs) - expected).max() < 2e-10


def offset_curve(spall, bearing, place):
    """Arcs (N,), rad, of the ball's centre, and its drop (N,), m, where it touches a smooth gap at `place` (N,)."""
    turn = -1.0 if spall.race == "outer" else 1.0
    radius = bearing.raceway_radius(spall.race)
    taper = np.where(place < 0.0, spall.entry_taper, spall.exit_taper)
    phase = np.pi * np.clip((spall.extent / 2.0 - np.abs(place)) / taper, 0.0, 1.0)
    level = radius - turn * 0.5 * spall.depth * (1.0 - np.cos(phase))
    rise = turn * np.sign(place) * 0.5 * spall.depth * np.sin(phase) * np.pi / taper
    tangent = (rise + 1j * level) * np.exp(1j * place)
    centre = level * np.exp(1j * place) - turn * 1j * bearing.ball_radius * tangent / np.abs(tangent)
    return np.angle(centre), -turn * (np.abs(centre) - (radius + turn * bearing.ball_radius))


@RACES
@pytest.mark.parametrize(("entry", "exit_"), [(0.02, 0.012), (0.012, 0.025)])
def test_the_ball_rolls_down_tapers_and_over_the_floor_between_them(gearbox, race, entry, exit_):
    spall = gap(race, extent=0.08, depth=2e-6, entry_taper=entry, exit_taper=exit_)
    path = build_path(spall, gearbox.bearing)
    arc, drop = offset_curve(spall, gearbox.bearing, np.linspace(-0.04, 0.04, 20_001)[1:-1])
    assert (np.diff(arc) > 0.0).all()  # no taper is too hollow for the ball to touch it all along
    # Cells of 4 um leave as much in a hollow nearly as bent as the ball.
    np.testing.assert_allclose(path.depth(arc), drop, rtol=0, atol=2e-11)


@RACES
@pytest.mark.parametrize("entry", [0.04, 0.05])
def test_the_ball_rolls_down_one_taper_and_up_another_that_meets_it(gearbox, race, entry):
    spall = gap(race, extent=0.08, depth=1e-6, entry_taper=entry, exit_taper=0.08 - entry)
    path = build_path(spall, gearbox.bearing)
    down, up = np.linspace(-0.04, 0.0, 10_001)[1:-1], np.linspace(entry - 0.04, 0.04, 10_001)[1:-1]
    arc, drop = offset_curve(spall, gearbox.bearing, np.concatenate([down, up]))
    np.testing.assert_allclose(path.depth(arc), drop, rtol=0, atol=2e-11)
    assert (np.diff(path.breaks) > 0.0).all()


@RACES
@pytest.mark.parametrize(("depth", "entry", "exit_"), [(2e-6, 0.02, 0.012), (5e-6, 0.027, 0.003), (12e-6, 0.0, 0.017)])
def test_the_deepest_place_of_a_flat_floor_is_its_middle(gearbox, race, depth, entry, exit_):
    spall = gap(race, extent=0.08, depth=depth, entry_taper=entry, exit_taper=exit_)
    path = build_path(spall, gearbox.bearing)
    floor = np.linspace(-0.04, 0.04, 80_001)
    reached = floor[path.depth(floor) > depth - 1e-12]
    assert path.deepest == pytest.approx(0.5 * (reached[0] + reached[-1]), abs=2e-5)  # the arc of 0.5 um
    assert reached[-1] - reached[0] > 0.02
    assert path.largest_depth == pytest.approx(depth, abs=1e-12)


@RACES
def test_the_path_of_a_table_has_a_break_where_the_ball_begins_to_hang_on_a_lip(gearbox, race):
    angle, depth = np.array([-0.02, -0.01, -0.005, 0.006, 0.011, 0.02]), np.array([0.0, 0.0, 25e-6, 25e-6, 0.0, 0.0])
    path = build_path(table(race, angle, depth, 0.04), gearbox.bearing)
    lip = -0.01 if race == "outer" else -0.011
    assert np.abs(path.breaks - lip).min() < 1e-12
    away = np.linspace(0.0, 4e-4, 1001)  # two cells: a parabola begins there, and no cubic may bridge its beginning
    exact = hanging(race, gearbox.bearing.raceway_radius(race), gearbox.bearing.ball_radius, away)
    np.testing.assert_allclose(path.depth(lip + away), exact, rtol=0, atol=1e-14)
    np.testing.assert_allclose(path.depth(lip - away), 0.0, rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    ("race", "degrees", "shares", "depth"), [("outer", 19.0, (0.21, 0.1), 19e-6), ("inner", 4.9, (0.18, 0.36), 6e-6)]
)
def test_points_of_a_table_in_line_leave_every_slope_of_its_path_a_number(gearbox, race, degrees, shares, depth):
    """Where a finely measured taper turns from bending down to bending up, three of its points are in line."""
    share, extent = np.linspace(-0.5, 0.5, 1001), math.radians(degrees)
    entry, exit_ = np.clip((0.5 + share) / shares[0], 0.0, 1.0), np.clip((0.5 - share) / shares[1], 0.0, 1.0)
    floor = 0.25 * depth * (1.0 - np.cos(np.pi * entry)) * (1.0 - np.cos(np.pi * exit_))
    path = build_path(table(race, share * extent, floor, extent), gearbox.bearing)
    assert path.largest_depth == pytest.approx(depth, abs=BETWEEN_NODES)


@RACES
def test_the_deepest_place_of_two_pits_is_in_one_of_them(gearbox, race):
    angle, depth = [-0.03, -0.02, -0.01, 0.01, 0.02, 0.03], [0.0, 3e-6, 0.0, 0.0, 3e-6, 0.0]
    path = build_path(table(race, angle, depth, 0.06), gearbox.bearing)
    assert path.depth(np.array([path.deepest])) == pytest.approx(path.largest_depth, rel=1e-9)


@RACES
@pytest.mark.parametrize("depth", [0.0, 1e-9])
def test_the_deepest_place_of_a_spall_that_stands_proud_throughout_lies_within_it(gearbox, race, depth):
    """Its path begins and ends far beyond the spall, where its bumps lift the ball off the race."""
    values = (0.0, *(-1e-6 * (2.0 + np.cos(np.linspace(0.0, 12.0, 15)))), 0.0)
    spall = gap(race, extent=1e-3, depth=depth, roughness=1e-6, roughness_values=values)
    path = build_path(spall, gearbox.bearing)
    assert path.breaks[0] < -5 * spall.extent
    assert (path.depth(inside(spall)) < 0.0).all()
    assert abs(path.deepest) <= spall.extent / 2
    assert path.depth(np.array([path.deepest])) == pytest.approx(path.depth(inside(spall)).max(), abs=1e-12)
    assert path.largest_depth == 0.0


@RACES
def test_a_ball_over_a_table_rests_on_what_lifts_it_most_of_all_its_points(gearbox, race):
    """Walls at both ends, one of them proud, and faces that the ball rolls over: every point of it tried."""
    angle = np.array([-0.034, -0.02, -0.008, 0.004, 0.02, 0.034])
    spall = table(race, angle, np.array([2e-6, 0.5e-6, 6e-6, 4e-6, 1e-6, -1.4e-6]), 0.068)
    path, radius, ball = build_path(spall, gearbox.bearing), gearbox.bearing.raceway_radius(race), 3.56e-3
    turn = -1.0 if race == "outer" else 1.0
    knots, depth = np.sort(-turn * angle), np.array(spall.table_depth)[:: int(-turn)]
    beyond = [np.nextafter(knots[0], -1.0), np.nextafter(knots[-1], 1.0)]
    place = np.sort(np.concatenate([np.linspace(-0.1, 0.1, 2_000_001), knots, beyond]))
    surface = np.interp(place, knots, depth, left=0.0, right=0.0)
    for arc in np.linspace(-0.036, 0.036, 37):
        below = np.abs(place - arc) < 0.02
        level = radius - turn * surface[below]
        lever = level * np.sin(place[below] - arc)
        drop = turn * (radius - level * np.cos(place[below] - arc)) + ball - np.sqrt(ball**2 - lever**2)
        assert float(path.depth(np.array([arc]))[0]) == pytest.approx(drop.min(), abs=2e-11)
