"""Finding the position at rest: balance of forces and least energy in any scene, and honest outcomes."""

import dataclasses
import math

import numpy as np
import pytest
from at_rest import BOTTOM, LINE, SOLVED, START, angles
from hypothesis import given, settings
from hypothesis import strategies as st
from kernels import elastic, set_time
from scipy.optimize import minimize_scalar

from physics.assembly import assemble
from physics.contact.forces import FLOOR
from physics.imperfections import Imperfections
from physics.outcome import StaticOutcome
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium, load_vector


def net_force(scene, time, ball_load):
    """Sum (T, 2) of the balls' radial forces, N."""
    radial = ball_load * math.cos(scene.rig.bearing.contact_angle)
    angle = angles(scene, time)
    return np.stack([(radial * np.cos(angle)).sum((1, 2)), (radial * np.sin(angle)).sum((1, 2))], axis=1)


def aligned(bearing):
    """Cage angle at which a ball of row 1 stands exactly below the shaft of a bearing with any number of balls."""
    return BOTTOM % bearing.spacing


@st.composite
def bearings(draw):
    roller = draw(st.booleans())
    return {
        "balls": draw(st.sampled_from([3, 5, 8, 12, 16])),
        "rows": draw(st.sampled_from([1, 2])),
        "clearance": draw(st.sampled_from([0.0, 1e-6, 10e-6, 200e-6, -1e-6, -20e-6])),
        "contact_angle": draw(st.sampled_from([0.0, 0.4])),
        "exponent": 10 / 9 if roller else 1.5,
        "load_deflection": 3e8 if roller else 5e9,
    }


@st.composite
def spalls(draw, rows):
    race = draw(st.sampled_from(["outer", "inner"]))
    found = []
    for row in range(1, rows + 1):
        if draw(st.booleans()):
            extent = draw(st.floats(0.01, math.pi))
            share = draw(st.sampled_from([0.0, 0.2, 0.5]))
            angle = draw(st.one_of(st.just(BOTTOM), st.floats(0.0, 6.28)))
            depth = draw(st.floats(1e-7, 1e-3))
            found.append(Spall(race, row, angle, extent, depth, share * extent, share * extent))
    return tuple(found)


@given(data=st.data())
@settings(max_examples=150, deadline=None, derandomize=True)
def test_the_balls_carry_the_load_whatever_bearing_load_cage_angle_and_spalls(gearbox, build_scene, data):
    bearing = data.draw(bearings())
    operation = {
        "load": data.draw(st.sampled_from([-1.0, 1.0, 1.0])) * 10 ** data.draw(st.floats(-1.0, 5.0)),
        "unbalance_force": data.draw(st.sampled_from([0.0, 5.0])),
        "unbalance_phase": data.draw(st.floats(0.0, 6.28)),
        "load_fluctuation": data.draw(st.sampled_from([0.0, 0.5])),
    }
    start = data.draw(st.one_of(st.sampled_from([0.0, BOTTOM]), st.floats(0.0, 6.28)))
    defects = data.draw(spalls(bearing["rows"]))
    scene = build_scene(gearbox, *defects, start_angle=start, bearing=bearing, operation=operation)
    time = np.array([0.0, 0.013, 0.0131, 0.2, 0.44])
    rest = equilibrium(scene, time)
    load = load_vector(scene, time)
    assert {rest.outcome(k) for k in range(5)} <= {StaticOutcome.LOADED, StaticOutcome.NOT_UNIQUE}
    assert np.all(rest.ball_load >= 0.0)
    unbalanced = np.hypot(*(net_force(scene, time, rest.ball_load) - load).T)
    total = np.hypot(*load.T) + 1e-3 * rest.ball_load.sum((1, 2))
    assert np.all(unbalanced <= 1e-8 * total)  # of 0.1 N at 0.2 mm of clearance, whose rounding moves 1e-9 of it


@given(data=st.data())
@settings(max_examples=40, deadline=None, derandomize=True)
def test_no_position_nearby_has_less_energy(gearbox, build_scene, data):
    bearing = data.draw(bearings())
    scene = build_scene(gearbox, *data.draw(spalls(bearing["rows"])), bearing=bearing)
    contacts = assemble(scene)
    set_time(contacts, 0.0)
    x, y = equilibrium(scene, START).displacement[0]
    reach = 1e-6 + 0.01 * math.hypot(x, y)

    def energy(dx, dy):
        return elastic(contacts, x + dx, y + dy).energy + 346.0 * (y + dy)

    for turn in np.linspace(0.0, np.pi, 7):
        along = minimize_scalar(
            lambda s, t=turn: energy(s * math.cos(t), s * math.sin(t)) - energy(0.0, 0.0), bounds=(-reach, reach)
        )
        assert along.fun >= -1e-12 * abs(energy(0.0, 0.0)) - 1e-15  # rounding


def test_no_load_in_clearance_is_not_loaded(fan, build_scene):
    rest = equilibrium(build_scene(fan, operation={"load": 0.0}), START)
    assert rest.outcome(0) is StaticOutcome.NOT_LOADED
    for result in (rest.displacement, rest.ball_load, rest.stiffness, rest.damping):
        assert np.all(result == 0.0)


def test_no_load_on_larger_balls_in_loose_clearance_is_not_loaded(gearbox, build_scene):
    row = (2e-6, *(0.0,) * 11)
    uneven = Imperfections(ball_deviation=(row, row))
    scene = build_scene(gearbox, imperfections=uneven, bearing={"clearance": 1e-6}, operation={"load": 0.0})
    rest = equilibrium(scene, START)
    assert rest.outcome(0) is StaticOutcome.NOT_LOADED


def test_without_load_a_preloaded_bearing_has_an_equilibrium_of_its_own(gearbox, build_scene):
    tight = {"bearing": {"clearance": -5e-6}, "operation": {"load": 0.0}}
    rest = equilibrium(build_scene(gearbox, **tight), START)
    assert rest.outcome(0) is StaticOutcome.LOADED
    assert rest.displacement[0] == pytest.approx([0.0, 0.0], abs=1e-15)  # rounding
    assert rest.ball_load == pytest.approx(np.full((1, 2, 12), 5157e6 * 5e-6**1.5), rel=1e-9)
    scene = build_scene(gearbox, LINE, **tight)
    spalled = equilibrium(scene, START)
    assert spalled.outcome(0) is StaticOutcome.LOADED
    assert spalled.displacement[0, 1] < -1e-7
    assert np.hypot(*net_force(scene, START, spalled.ball_load)[0]) < 1e-9  # of 58 N a ball


@pytest.mark.parametrize("balls", [8, 12])
def test_one_ball_straight_below_a_loose_shaft_carries_everything_but_does_not_hold_it_sideways(
    gearbox, build_scene, balls
):
    loose = {"balls": balls, "rows": 1, "clearance": 1e-3}
    start = aligned(dataclasses.replace(gearbox.bearing, **loose))
    rest = equilibrium(build_scene(gearbox, bearing=loose, start_angle=start, operation={"load": 1.0}), START)
    assert rest.outcome(0) is StaticOutcome.NOT_UNIQUE
    assert np.count_nonzero(rest.ball_load) == 1
    assert rest.ball_load.max() == pytest.approx(1.0, rel=SOLVED)
    assert rest.stiffness[0, 0] < 1e-6 * rest.stiffness[0, 1]


def test_a_little_off_that_the_shaft_rolls_over_until_a_second_ball_holds_it(gearbox, build_scene):
    loose = {"balls": 8, "rows": 1, "clearance": 1e-3}
    start = aligned(dataclasses.replace(gearbox.bearing, **loose)) + 1e-3
    scene = build_scene(gearbox, bearing=loose, start_angle=start, operation={"load": 1.0})
    rest = equilibrium(scene, START)
    assert rest.outcome(0) is StaticOutcome.LOADED
    assert np.count_nonzero(rest.ball_load) == 2
    assert abs(rest.displacement[0, 0]) > 0.3e-3
    assert net_force(scene, START, rest.ball_load)[0] == pytest.approx([0.0, -1.0], abs=1e-7)  # rounding of 1 mm


def test_a_shaft_whose_whole_load_zone_is_spalled_sinks_until_balls_carry_it(gearbox, build_scene):
    zone = tuple(Spall("outer", row, BOTTOM, math.pi * 0.999, 40e-6) for row in (1, 2))
    healthy, sunk = equilibrium(build_scene(gearbox), START), equilibrium(build_scene(gearbox, *zone), START)
    assert sunk.outcome(0) is StaticOutcome.LOADED
    assert sunk.displacement[0, 1] < healthy.displacement[0, 1] - 35e-6
    scene = build_scene(gearbox, *zone)
    assert net_force(scene, START, sunk.ball_load)[0] == pytest.approx([0.0, -346.0], abs=346.0 * SOLVED)


def test_a_reversed_load_lifts_the_shaft_as_far_as_the_load_would_sink_it(gearbox, build_scene):
    down = equilibrium(build_scene(gearbox), START)
    up = equilibrium(build_scene(gearbox, operation={"load": -346.0}), START)
    assert up.outcome(0) is StaticOutcome.LOADED
    assert up.displacement[0] == pytest.approx(-down.displacement[0], abs=1e-14)  # 24 balls: symmetric up and down
    assert up.ball_load[0, 0, 3] == pytest.approx(down.ball_load[0, 0, 9], rel=SOLVED)


def test_a_load_that_no_position_within_reach_carries_is_said_so(gearbox, build_scene):
    """The most loaded ball would give way by (63 N / 1 kN/m^1.5)^(2/3) = 16 cm."""
    rest = equilibrium(build_scene(gearbox, bearing={"load_deflection": 1e3}), START)
    assert rest.outcome(0) is StaticOutcome.NO_EQUILIBRIUM
    assert np.all(rest.displacement == 0.0)


def test_each_instant_of_a_series_is_solved_as_well_as_alone(gearbox, build_scene):
    scene = build_scene(gearbox, LINE, bearing={"clearance": 3e-6})
    time = np.linspace(0.0, 0.1, 400)
    together = equilibrium(scene, time)
    for k in (0, 57, 133, 399):
        alone = equilibrium(scene, time[k : k + 1])
        assert np.allclose(together.ball_load[k], alone.ball_load[0], atol=346.0 * 1e-8)  # twice the tolerance


def test_the_series_recovers_after_an_instant_without_load(gearbox, build_scene):
    """The fluctuation takes the load to exactly zero at t = 0."""
    operation = {"load_fluctuation": 1.0, "fluctuation_phase": math.pi}
    scene = build_scene(gearbox, operation=operation, bearing={"clearance": 3e-6})
    rest = equilibrium(scene, np.array([0.02, 0.0, 0.02]))
    assert [rest.outcome(k).name for k in range(3)] == ["LOADED", "NOT_LOADED", "LOADED"]
    assert np.allclose(rest.ball_load[0], rest.ball_load[2], atol=346.0 * SOLVED)


def test_energy_force_and_stiffness_are_each_other_s_derivatives(gearbox, build_scene):
    scene = build_scene(gearbox, LINE, start_angle=0.1)
    contacts = assemble(scene)
    set_time(contacts, 0.0)
    x, y, h = 1.3e-6, -7e-6, 1e-11

    def at(dx, dy):
        return elastic(contacts, x + dx, y + dy)

    here = at(0.0, 0.0)
    assert (at(h, 0).energy - at(-h, 0).energy) / (2 * h) == pytest.approx(here.force_x, rel=1e-6)  # rounding
    assert (at(0, h).energy - at(0, -h).energy) / (2 * h) == pytest.approx(here.force_y, rel=1e-6)
    assert (at(h, 0).force_x - at(-h, 0).force_x) / (2 * h) == pytest.approx(here.xx, rel=1e-6)
    assert (at(0, h).force_y - at(0, -h).force_y) / (2 * h) == pytest.approx(here.yy, rel=1e-6)
    assert (at(0, h).force_x - at(0, -h).force_x) / (2 * h) == pytest.approx(here.xy, rel=1e-5)
    phi = angles(scene, START).ravel()
    compression = x * np.cos(phi) + y * np.sin(phi) - contacts.balls[0, FLOOR]
    assert here.pressed == pytest.approx(5157e6 * np.sum(np.clip(compression, 0.0, None) ** 1.5), rel=1e-12)
