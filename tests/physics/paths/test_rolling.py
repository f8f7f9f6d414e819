"""The rolling-ball filter against its closed form, against plain geometry, and as a morphological filter."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from measures import hanging
from scipy.interpolate import CubicSpline

from physics.paths.corners import RolledPath, branches, corners_of
from physics.paths.held_ball import Ball
from physics.paths.path_nodes import bumpy_branches
from physics.paths.rolling import roll

BALL = 3.56e-3
RACE = {"outer": 22.935e-3, "inner": 15.815e-3}
RACES = pytest.mark.parametrize("race", ["outer", "inner"])
HALF = math.radians(1.0)
STEP = 5e-6 / RACE["outer"]
ROUNDING = 1e-15  # m: a few units in the last place of a race's radius


def ball_on(race, radius=BALL):
    return Ball(RACE[race], radius, -1.0 if race == "outer" else 1.0)


def sloped(depth):
    """The surface of this depth, with a slope from differences."""
    apart = 1e-8
    return lambda arc, order=0: depth(arc) if order == 0 else (depth(arc + apart) - depth(arc - apart)) / (2.0 * apart)


def rolled(depth, race, half=HALF, step=STEP):
    return roll(sloped(depth), (-half, half), ball_on(race), step).path[:2]


def gap(depth):
    return lambda arc: np.full_like(arc, depth)


def closest(surface, race, arcs, drop, half=HALF):
    """Distance (m) of each ball's centre to the nearest point of the raceway, from Cartesian coordinates."""
    outward = 1 if race == "outer" else -1
    centre = RACE[race] - outward * BALL + outward * drop
    theta = np.linspace(-half - 0.15, half + 0.15, 40001)
    theta = np.union1d(theta, arcs)
    depth = np.where(np.abs(theta) < half * (1 - 1e-12), surface(theta), 0.0)
    x, y = (RACE[race] + outward * depth) * np.stack([np.cos(theta), np.sin(theta)])
    along, across = centre * np.stack([np.cos(arcs), np.sin(arcs)])
    return np.hypot(x - along[:, None], y - across[:, None]).min(axis=1)


def bumpy(seed, height, waves=8):
    """A random smooth surface, zero at both edges."""
    rng = np.random.default_rng(seed)
    amplitude, phase = rng.normal(0, 1, waves) / math.sqrt(waves), rng.uniform(0, 2 * np.pi, waves)
    order = np.arange(1, waves + 1)

    def surface(arc):
        waviness = (amplitude * np.cos(order * np.asarray(arc)[..., None] / HALF * np.pi + phase)).sum(-1)
        return height * waviness * np.clip(1 - (np.asarray(arc) / HALF) ** 2, 0, None)

    return surface


@RACES
def test_a_deep_gap_is_crossed_on_the_closed_form_of_its_two_edges(race):
    arcs, drop = rolled(gap(1e-3), race)
    assert np.max(np.abs(drop - hanging(race, RACE[race], BALL, HALF - np.abs(arcs)))) < ROUNDING


@RACES
def test_a_shallow_gap_is_crossed_on_the_edges_and_on_its_floor(race):
    arcs, drop = rolled(gap(4e-6), race)
    expected = np.minimum(hanging(race, RACE[race], BALL, HALF - np.abs(arcs)), 4e-6)
    assert np.max(np.abs(drop - expected)) < ROUNDING
    assert np.count_nonzero(np.abs(drop - 4e-6) < ROUNDING) > 0.2 * arcs.size


@RACES
@pytest.mark.parametrize("steps", [800, 801])  # the corner lies on a node, or in the middle between two
def test_the_ball_changes_edges_at_a_corner_where_both_sides_keep_their_own_slope(race, steps):
    path = roll(sloped(gap(1e-3)), (-HALF, HALF), ball_on(race), 2.0 * HALF / (steps - 0.5)).path
    assert path.arc.size == steps + 1
    found = branches(path)
    assert found.edges[1:-1] == pytest.approx([0.0], abs=1e-9)
    here, steep = np.flatnonzero(found.arc == found.edges[1]), float(ball_on(race).slope_from_edge(np.array(HALF)))
    assert found.slope[here] == pytest.approx([steep, -steep], rel=1e-6)
    assert found.drop[here] == pytest.approx(float(hanging(race, RACE[race], BALL, HALF)), abs=1e-13)


@RACES
@pytest.mark.parametrize("seed", range(3))
def test_slopes_and_corners_of_a_bumpy_path_agree_with_its_drops(race, seed):
    path = roll(sloped(bumpy(seed, 8e-6)), (-HALF, HALF), ball_on(race), STEP).path
    found = branches(path)
    assert 2 < found.edges.size < 20
    width, rise = np.diff(found.arc), np.diff(found.drop)
    inside = width > 0.0
    mean = 0.5 * (found.slope[1:] + found.slope[:-1])[inside]
    assert np.allclose(mean * width[inside], rise[inside], rtol=0, atol=1e-10)  # trapezia of 5 µm: h³/12 times a bend
    corners = ~inside
    assert np.all(found.drop[1:][corners] == found.drop[:-1][corners])
    assert np.all(found.slope[1:][corners] < found.slope[:-1][corners])  # the ball falls from one bump onto the other


@RACES
def test_the_closed_form_s_slope_is_its_derivative(race):
    ball = ball_on(race)
    psi, h = np.linspace(0.001, 0.15, 50), 1e-6
    risen = ball.drop_from_edge(psi + h) - ball.drop_from_edge(psi - h)
    assert np.allclose(risen / (2 * h), ball.slope_from_edge(psi), rtol=1e-6)  # third derivative times h²


@RACES
@given(depth=st.floats(1e-9, 3e-3))
@settings(max_examples=50, deadline=None, derandomize=True)
def test_the_reach_of_a_hanging_ball_inverts_the_closed_form(race, depth):
    reach = ball_on(race).reach_from_edge(depth)
    dropped = float(hanging(race, RACE[race], BALL, reach))
    assert dropped == pytest.approx(depth, rel=1e-6, abs=1e-15)  # cancellation in Rb − √(…)


@RACES
def test_a_ball_hangs_no_further_from_an_edge_than_where_it_slips_past(race):
    furthest = math.asin(BALL / RACE[race])
    deepest = float(hanging(race, RACE[race], BALL, furthest - 1e-12))
    assert ball_on(race).reach_from_edge(1.5 * deepest) == pytest.approx(furthest, rel=1e-6)  # a square root
    assert ball_on(race).reach_from_edge(0.0) == 0.0


@RACES
@pytest.mark.parametrize("ball_share", [0.16, 0.30, 0.46])
def test_even_a_ball_nearly_as_large_as_its_race_finds_the_edges_it_hangs_on(race, ball_share):
    ball = ball_share * RACE[race]
    half = 0.98 * math.asin(ball_share)
    arcs, drop, _, _ = roll(sloped(gap(5e-3)), (-half, half), ball_on(race, ball), STEP).path
    exact = ball_on(race, ball).drop_from_edge
    assert np.max(np.abs(drop - np.minimum(exact(half - np.abs(arcs)), 5e-3))) < ROUNDING * 10  # steep: more rounding


@RACES
@pytest.mark.parametrize("seed", range(4))
def test_the_ball_touches_the_surface_and_never_enters_it(race, seed):
    surface = bumpy(seed, 8e-6)
    arcs, drop = rolled(surface, race)
    distance = closest(surface, race, arcs[::16], drop[::16])
    assert np.max(np.abs(distance - BALL)) < 1e-8  # contacts found to 0.6 µm on bumps of 50 µm radius: 4 nm, twice


@RACES
def test_a_smooth_healthy_race_leaves_the_ball_where_it_is(race):
    _, drop = rolled(gap(0.0), race)
    assert np.max(np.abs(drop)) < ROUNDING


@RACES
@pytest.mark.parametrize("seed", range(3))
def test_the_ball_s_centre_is_never_deeper_than_the_surface_below_it(race, seed):
    surface = bumpy(seed, 20e-6)
    arcs, drop = rolled(surface, race)
    assert np.all(drop <= np.where(np.abs(arcs) < HALF, surface(arcs), 0.0) + ROUNDING)


@RACES
@pytest.mark.parametrize("taper", [4e-6, 1e-5, 1e-4])
def test_a_ball_neither_sinks_into_a_steep_taper_nor_is_lifted_by_it(race, taper):
    width, depth, half = taper / RACE[race], 80e-6, 0.3e-3 / RACE[race]

    def surface(arc):
        return depth * np.sin(0.5 * np.pi * np.clip((half - np.abs(arc)) / width, 0.0, 1.0)) ** 2

    arcs, drop = rolled(surface, race, half)
    for arc, found in zip(arcs[1:-1:23], drop[1:-1:23], strict=True):
        # Points of the taper itself, much closer together than it bends.
        edge = half - width * np.linspace(0.0, 1.0, 200_001)
        theta = np.concatenate([-edge, edge])
        radius = RACE[race] + (surface(theta) if race == "outer" else -surface(theta))
        lever = radius * np.sin(theta - arc)
        hanging = np.sqrt(BALL**2 - lever**2)
        sign = 1.0 if race == "outer" else -1.0
        drops = sign * (radius * np.cos(theta - arc) - RACE[race]) - hanging + BALL
        assert found == pytest.approx(drops.min(), abs=1e-13)  # points 20 to 500 pm apart on a bend of less than 1 µm


@RACES
@pytest.mark.parametrize("taper", [5e-5, 1.5e-4, 3.5e-4])
def test_over_a_taper_the_ball_runs_on_the_curve_one_radius_off_it(race, taper):
    width, depth, outward = taper / RACE[race], 36e-6, 1.0 if race == "outer" else -1.0

    def surface(arc, order=0):
        into = np.clip((HALF - np.abs(arc)) / width, 0.0, 1.0)
        if order == 0:
            return depth * np.sin(0.5 * np.pi * into) ** 2
        return -np.sign(arc) * depth * 0.5 * np.pi / width * np.sin(np.pi * into)

    arcs, drop, slope, _ = roll(surface, (-HALF, HALF), ball_on(race), STEP).path
    # Points of the taper near its edge and the ball that lies on each of them, along the normal there.
    touched = -HALF + width * np.linspace(1e-5, 0.3, 4001)
    radius, tilt = RACE[race] + outward * surface(touched), outward * surface(touched, 1)
    length = np.hypot(radius, tilt)
    inward = RACE[race] - outward * BALL
    across, along = radius - outward * BALL * radius / length, outward * BALL * tilt / length
    centre, place = np.hypot(across, along), touched + np.arctan2(along, across)
    near = (arcs > place[0]) & (arcs < min(place[-1], 0.0))  # beyond the middle it lies on the other taper
    assert near.sum() > 20
    expected = CubicSpline(place, outward * (centre - inward))
    np.testing.assert_allclose(drop[near], expected(arcs[near]), rtol=0, atol=1e-13)
    np.testing.assert_allclose(slope[near], expected(arcs[near], 1), rtol=1e-7, atol=1e-12)


@RACES
def test_a_ball_turns_around_a_lip_wherever_it_lies_between_points(race):
    lip, outward = -0.137 * HALF, 1.0 if race == "outer" else -1.0
    knots, depths = np.array([-HALF, lip - 3e-3, lip, lip + 4e-3, HALF]), np.array([0.0, 20e-6, 2e-6, 30e-6, 0.0])

    def surface(arc, order=0):
        if order == 0:
            return np.interp(arc, knots, depths)
        return np.concatenate([[0.0], np.diff(depths) / np.diff(knots), [0.0]])[np.searchsorted(knots, arc)]

    arcs, drop, slope, _ = roll(surface, (-HALF, HALF), ball_on(race), STEP, knots).path
    near = np.abs(arcs - lip) < 1e-3
    radius, away = RACE[race] + outward * 2e-6, lip - arcs[near]
    hanging = np.sqrt(BALL**2 - (radius * np.sin(away)) ** 2)
    expected = outward * (radius * np.cos(away) - RACE[race]) - hanging + BALL
    np.testing.assert_allclose(drop[near], expected, rtol=0, atol=1e-10)  # the lip within 0.3 nm, on a flank of 0.26
    np.testing.assert_allclose(
        np.diff(slope[near]) / np.diff(arcs[near]), np.diff(slope[near]).mean() / np.diff(arcs).mean(), rtol=0.01
    )


@RACES
def test_a_bump_that_holds_the_ball_over_less_than_a_step_is_not_passed_over(race):
    half = 4.0 * HALF  # so that steps are no shorter than asked
    step = 2.0 * half / math.ceil(2.0 * half / STEP)
    middle = -half + step * (math.floor(half / step) + 0.5)  # in the middle between two nodes
    apart, width = 100e-6 / RACE[race], 20e-6 / RACE[race]

    def crests(height):
        def surface(arc):
            tops = ((middle - apart, 18e-6), (middle, height), (middle + apart, 18e-6))
            return 20e-6 - sum(top * np.exp(-(((arc - place) / width) ** 2)) for place, top in tops)

        return surface

    low = roll(sloped(crests(0.0)), (-half, half), ball_on(race), STEP)
    path, without = low.path, bumpy_branches(low)
    assert np.min(np.abs(path.arc - middle)) == pytest.approx(0.5 * step)
    corner = float(np.interp(middle, without.arc, without.drop))
    surface = crests(20e-6 - corner + 15e-9)  # holds the ball 15 nm higher than its neighbours, over a µm
    found = bumpy_branches(roll(sloped(surface), (-half, half), ball_on(race), STEP))
    near = np.abs(found.edges - middle) < 0.5 * step
    assert np.count_nonzero(near) == 2
    assert 0.0 < np.ptp(found.edges[near]) < 0.5 * step
    arcs = middle + 0.5 * step * np.linspace(-1.0, 1.0, 41)
    clear = closest(surface, race, arcs, np.interp(arcs, found.arc, found.drop), half)
    np.testing.assert_allclose(clear, BALL, rtol=0, atol=2e-9)  # chords of 5 µm, points of the race 0.2 µm apart


@RACES
def test_of_two_crests_the_higher_one_holds_the_ball_though_points_of_the_surface_miss_its_top(race):
    half, ball = 4.0 * HALF, ball_on(race)  # so that steps are no shorter than asked
    steps = math.ceil(2.0 * half / STEP)
    step = 2.0 * half / steps
    node = -half + step * (steps // 2)
    # One crest on a point of the surface, the other midway between two, which show its 1 µm as 15 nm lower.
    near, far, width = node - 2.0 * step, node + 2.125 * step, 5e-6 / RACE[race]

    def surface(arc):
        return 20e-6 - 1e-6 * np.exp(-(((arc - near) / width) ** 2)) - 1.006e-6 * np.exp(-(((arc - far) / width) ** 2))

    path = roll(sloped(surface), (-half, half), ball, STEP).path
    at = np.argmin(np.abs(path.arc - node))
    assert path.arc[at] == pytest.approx(node, abs=1e-12)
    on_top = [ball.drop(surface(np.array([crest])), np.array([crest - node]))[0] for crest in (near, far)]
    assert on_top[1] < on_top[0] - 2e-9
    # It touches a little beside the top, where that is as steep as the ball: 0.1 nm higher.
    assert on_top[1] - 2e-10 < path.drop[at] <= on_top[1]


@pytest.mark.parametrize("higher", [True, False])
def test_two_branches_meet_in_a_corner_where_the_higher_one_holds_and_nowhere_else(higher):
    """The drop is the less of two lines, and turns upwards where they cross; where it is the larger one it is none of a
    ball that rolls, whatever the place of contact does."""
    arc = np.arange(8.0)
    left, right = 0.2 * arc, 0.86 - 0.1 * (arc - 2.6) - 0.34  # they cross at 2.6, where both are 0.52
    on_left = (left < right) == higher
    slope = np.where(on_left, 0.2, -0.1)
    path = RolledPath(arc, np.where(on_left, left, right), slope, arc + np.where(on_left, 0.0, 10.0))
    corners = corners_of(path)
    assert path.arc[corners.cells] + corners.share == pytest.approx([2.6] if higher else [], abs=1e-9)
    assert branches(path).edges == pytest.approx([0.0, 2.6, 7.0] if higher else [0.0, 7.0], abs=1e-9)


@RACES
@pytest.mark.parametrize("seed", range(3))
def test_a_path_over_roughness_is_the_same_with_steps_eight_times_as_short(race, seed):
    half, step = 20.0 * HALF, 2e-6 / RACE[race]
    knots = np.linspace(-half, half, round(2.0 * half * RACE[race] / 15e-6) + 1)
    heights = np.random.default_rng(seed).normal(0.0, 0.3e-6, knots.size)
    rough = CubicSpline(knots, heights, bc_type="natural")

    def surface(arc, order=0):
        return rough(arc, order) + (10e-6 if order == 0 else 0.0)

    arcs = np.linspace(-half, half, 400_001)
    long, short = (bumpy_branches(roll(surface, (-half, half), ball_on(race), step / n)) for n in (1, 8))
    assert long.edges.size > 100
    drops = [np.interp(arcs, found.arc, found.drop) for found in (long, short)]
    np.testing.assert_allclose(*drops, rtol=0, atol=2e-9)  # chords of 2 µm, and corners of bumps less than 6 µm apart


@RACES
@pytest.mark.parametrize("seed", range(3))
def test_a_deeper_surface_never_lifts_the_ball(race, seed):
    shallow = bumpy(seed, 10e-6)
    extra = bumpy(seed + 100, 10e-6)
    _, upper = rolled(lambda arc: np.maximum(shallow(arc), 0.0), race)
    arcs, lower = rolled(lambda arc: np.maximum(shallow(arc), 0.0) + np.maximum(extra(arc), 0.0), race)
    assert np.all(lower >= upper - ROUNDING)
    assert np.max(lower - upper) > 1e-7
    assert arcs.size == upper.size


@RACES
@pytest.mark.parametrize("seed", range(2))
def test_rolling_over_what_the_ball_left_reachable_changes_nothing(race, seed):
    surface = bumpy(seed, 8e-6)
    arcs, drop = rolled(lambda arc: np.maximum(surface(arc), 0.0), race)
    outward = 1 if race == "outer" else -1
    centre = RACE[race] - outward * BALL + outward * drop
    away = arcs[:, None] - arcs[None, :]
    furthest_out = outward * centre * np.cos(away) + np.sqrt(BALL**2 - (centre * np.sin(away)) ** 2)
    reached = np.max(furthest_out, axis=1) - outward * RACE[race]
    assert np.max(surface(arcs) - reached) > 1e-6
    _, again = rolled(lambda arc: np.interp(arc, arcs, reached), race)
    assert np.max(np.abs(again - drop)) < 1e-8  # the surface left is known every 1.6 µm, on bumps of 50 µm radius: 6 nm


@RACES
def test_a_symmetric_surface_gives_a_symmetric_path(race):
    surface = bumpy(1, 10e-6)
    _, drop = rolled(lambda arc: surface(arc) + surface(-arc), race)
    assert np.allclose(drop, drop[::-1], rtol=0, atol=ROUNDING)


@RACES
def test_a_mirrored_surface_gives_the_mirrored_path(race):
    surface = bumpy(2, 10e-6)
    _, drop = rolled(surface, race)
    _, mirrored = rolled(lambda arc: surface(-arc), race)
    assert np.allclose(drop, mirrored[::-1], rtol=0, atol=ROUNDING)


def ridge(arc):
    """A lip 6 µm proud of the race beside the entry edge, before a deep floor."""
    return np.where(np.abs(arc + HALF - 2e-4) < 1e-4, -6e-6, 30e-6)


@RACES
def test_a_bump_that_stands_proud_lifts_the_ball_before_the_edge(race):
    arcs, drop = rolled(ridge, race)
    assert drop.min() == pytest.approx(-6e-6, abs=1e-11)  # the grid may miss the lip's centre by half a step
    assert arcs[0] < -HALF
    approach = drop[arcs < -HALF + 1e-4]
    assert np.all(np.diff(approach[2:]) < 0.0)
    assert np.all(np.abs(approach[:2]) < ROUNDING)
    assert np.max(np.abs(np.diff(approach))) < 0.02 * 6e-6  # no jump: the lip lifts the ball over hundreds of steps


@RACES
def test_a_ball_climbs_a_proud_plateau_on_its_very_corner(race):
    proud, turn = 3e-6, -1 if race == "outer" else 1
    arc, drop = rolled(gap(-proud), race)
    before = (arc < -HALF) & (drop < -ROUNDING)
    corner, psi = RACE[race] + turn * proud, -HALF - arc[before]
    sag = BALL - np.sqrt(BALL**2 - corner**2 * np.sin(psi) ** 2) + turn * corner * (1 - np.cos(psi))
    assert before.sum() > 20
    np.testing.assert_allclose(drop[before], sag - proud, atol=1e-12)


@RACES
def test_both_edges_stay_exact_when_a_bump_stands_proud(race):
    arcs, drop = rolled(ridge, race)
    beside_exit = (arcs > HALF - 5e-3) & (arcs < HALF)
    expected = hanging(race, RACE[race], BALL, HALF - arcs[beside_exit])
    assert np.max(np.abs(drop[beside_exit] - expected)) < ROUNDING


@RACES
@pytest.mark.parametrize("height", [5e-6, 5e-4])
def test_the_path_of_a_lifted_ball_begins_and_ends_at_zero(race, height):
    arcs, drop = rolled(lambda arc: np.where(np.abs(arc) > HALF - 1e-4, -height, 0.0), race)
    assert arcs[0] == pytest.approx(-arcs[-1], rel=1e-12)
    assert max(abs(drop[0]), abs(drop[-1])) < ROUNDING
    bump = RACE[race] - height if race == "outer" else RACE[race] + height
    touch = ball_on(race)._replace(race_radius=bump).reach_from_edge(height)
    assert -HALF - touch - arcs[0] < 1.5 * (arcs[1] - arcs[0])


@RACES
def test_arcs_are_no_further_apart_than_asked(race):
    arcs, _ = rolled(gap(1e-5), race, half=0.3, step=STEP)
    assert np.max(np.diff(arcs)) <= STEP * (1 + 1e-9)
    assert np.ptp(np.diff(arcs)) < 1e-12


@RACES
def test_a_ball_falls_to_the_floor_of_a_hole_deeper_than_itself_and_is_found_there_at_once(race):
    half, floor, asked = 3.0 * BALL / RACE[race], 2.5 * BALL, []

    def surface(arc, order=0):
        asked.append(arc.size)
        bumps = 1e-6 * np.cos(4e2 * arc)
        return np.full_like(arc, floor) + bumps if order == 0 else -4e-4 * np.sin(4e2 * arc)

    path = roll(surface, (-half, half), ball_on(race), STEP).path
    # A ball that touches neither edge from beside its centre rests on the floor, a little above its deepest points.
    free = np.abs(path.arc) < half - 1.05 * math.asin(BALL / RACE[race])
    assert free.sum() > 500
    assert np.all(np.abs(path.drop[free] - floor) <= 1e-6 * (1.0 + 1e-9))
    assert len(asked) < 500
