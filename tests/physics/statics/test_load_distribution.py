"""Quasi-static load distribution: published values, symmetry, scaling, redistribution."""

import dataclasses
import math

import numpy as np
import pytest
from at_rest import LINE, SOLVED, START, angles
from scipy.optimize import brentq

from physics.cage import CagePath
from physics.imperfections import Imperfections
from physics.operation import Operation
from physics.outcome import Outcome, SimulationFailed, StaticOutcome
from physics.spall import Spall
from physics.statics.ball_load import ball_load
from physics.statics.load_distribution import (
    OUTCOMES,
    equilibrium,
    instants_without_period,
    load_range,
    load_vector,
    require_equilibrium,
)
from physics.statics.rest import NO_EQUILIBRIUM
from physics.statics.stiffness_series import stiffness_series


def loads_of(scene, time=START):
    return equilibrium(scene, time).ball_load


def test_the_most_loaded_ball_of_the_gearbox_rig_carries_62_995_n(authority, gearbox, build_scene):
    check = authority("independent_model")["statics"]["gearbox_solved_peak_n"]
    peak = loads_of(build_scene(gearbox)).max()
    assert peak == pytest.approx(check["value"], abs=check["tolerance"])  # the digits given


def test_the_solved_peak_is_stribeck_s_to_a_tenth_of_a_percent(authority, gearbox, build_scene):
    check = authority("independent_model")["statics"]["gearbox_stribeck_peak_n"]
    peak = loads_of(build_scene(gearbox)).max()
    assert peak == pytest.approx(check["value"], abs=check["tolerance"])  # the digits given
    assert peak == pytest.approx(gearbox.bearing.stribeck_peak_load(346.0), rel=1e-3)  # a sum of 24, not an integral


def test_many_balls_share_the_load_as_stribeck_s_integral(gearbox, build_scene):
    many = build_scene(gearbox, bearing={"balls": 200, "ball_diameter": 0.5e-3})
    assert loads_of(many).max() == pytest.approx(many.rig.bearing.stribeck_peak_load(346.0), rel=1e-5)  # 1/400²


@pytest.mark.parametrize("exponent", [1.5, 10 / 9])
def test_at_zero_clearance_balls_share_the_load_as_the_cosine_to_the_n(gearbox, build_scene, exponent):
    scene = build_scene(gearbox, bearing={"exponent": exponent})
    share = np.clip(-np.sin(angles(scene, START)), 0.0, None)
    expected = 346.0 * share**exponent / np.sum(share ** (exponent + 1.0))
    assert np.allclose(loads_of(scene), expected, atol=346.0 * SOLVED)


def test_with_clearance_the_drop_of_the_shaft_is_the_root_of_one_equation(fan, build_scene):
    scene = build_scene(fan)
    below = np.clip(-np.sin(angles(scene, START)), 0.0, None).ravel()

    def excess(drop):
        return np.sum(10.1e9 * np.clip(drop * below - 3e-6, 0.0, None) ** 1.5 * below) - 100.0

    drop = brentq(excess, 1e-7, 1e-4, xtol=1e-18)
    rest = equilibrium(scene, START)
    assert rest.displacement[0] == pytest.approx([0.0, -drop], abs=1e-13)  # the root finder's rounding
    assert rest.outcome(0) is StaticOutcome.LOADED


@pytest.mark.parametrize("start", [0.0, math.radians(7.5), math.radians(15.0)])
def test_a_symmetric_pattern_of_balls_shares_the_load_symmetrically(gearbox, build_scene, start):
    scene = build_scene(gearbox, start_angle=start)
    rest = equilibrium(scene, START)
    assert rest.displacement[0, 0] == pytest.approx(0.0, abs=1e-15)  # rounding
    half_degrees = np.round(2.0 * np.degrees(angles(scene, START))).astype(int).ravel() % 720
    carried = dict(zip(half_degrees.tolist(), rest.ball_load.ravel(), strict=True))
    for place, force in carried.items():
        assert force == pytest.approx(carried[(1080 - place) % 720], abs=346.0 * SOLVED)


@pytest.mark.parametrize("turn", [math.radians(15), 1.0, -2.2])
def test_turning_load_and_cage_together_turns_the_displacement(gearbox, build_scene, turn):
    rotating = {"load": 0.0, "unbalance_force": 346.0}
    first = build_scene(gearbox, start_angle=0.3, operation={**rotating, "unbalance_phase": 0.2})
    second = build_scene(gearbox, start_angle=0.3 + turn, operation={**rotating, "unbalance_phase": 0.2 + turn})
    before, after = equilibrium(first, START), equilibrium(second, START)
    x, y = before.displacement[0]
    turned = math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y
    assert after.displacement[0] == pytest.approx(turned, abs=1e-14)  # 1e-9 of 10 µm
    assert np.allclose(after.ball_load, before.ball_load, atol=346.0 * SOLVED)


def test_moving_the_cage_by_a_ball_spacing_renumbers_the_balls(gearbox, build_scene):
    scene = build_scene(gearbox, LINE, start_angle=0.1)
    moved = build_scene(gearbox, LINE, start_angle=0.1 + gearbox.bearing.spacing)
    assert np.allclose(np.roll(loads_of(moved), 1, axis=2), loads_of(scene), atol=346.0 * SOLVED)


@pytest.mark.parametrize("exponent", [1.5, 10 / 9])
@pytest.mark.parametrize("factor", [1e-3, 10.0, 1e3])
def test_at_zero_clearance_deflection_grows_as_load_to_the_1_over_n(gearbox, build_scene, exponent, factor):
    once = build_scene(gearbox, bearing={"exponent": exponent}, start_angle=0.1)
    more = build_scene(gearbox, bearing={"exponent": exponent}, start_angle=0.1, operation={"load": 346.0 * factor})
    light, heavy = equilibrium(once, START), equilibrium(more, START)
    ratio = factor ** (1.0 / exponent)
    assert heavy.displacement[0] == pytest.approx(ratio * light.displacement[0], rel=1e-8)  # the solver's tolerance
    assert np.allclose(heavy.ball_load, factor * light.ball_load, atol=346.0 * factor * SOLVED)
    assert heavy.stiffness[0] == pytest.approx(factor / ratio * light.stiffness[0], rel=1e-8, abs=1.0)


def test_a_deep_spall_takes_the_load_off_its_ball_and_the_others_take_it_over(gearbox, build_scene):
    healthy, spalled = build_scene(gearbox), build_scene(gearbox, LINE)
    before, after = loads_of(healthy)[0], loads_of(spalled)[0]
    lowest = np.unravel_index(np.argmax(before), before.shape)
    others = before > 1.0
    others[lowest] = False
    assert lowest == (0, 9)
    assert after[lowest] == 0.0
    assert np.all(after[others] > before[others])
    assert equilibrium(spalled, START).displacement[0, 1] < equilibrium(healthy, START).displacement[0, 1]


def test_a_shallow_spall_takes_part_of_the_load_off_its_ball(gearbox, build_scene):
    before = loads_of(build_scene(gearbox))[0]
    after = loads_of(build_scene(gearbox, dataclasses.replace(LINE, depth=2e-6)))[0]
    assert 0.0 < after[0, 9] < before[0, 9]
    assert after.sum() > before.sum()


def test_an_inner_spall_redistributes_only_while_it_turns_through_the_load_zone(gearbox, build_scene):
    scene = build_scene(gearbox, dataclasses.replace(LINE, race="inner", extent=0.5))
    healthy = build_scene(gearbox)
    turn = 1.0 / 7.0
    for time, changed in ((0.0, True), (0.5 * turn, False), (turn, True)):
        difference = np.abs(loads_of(scene, np.array([time])) - loads_of(healthy, np.array([time]))).max()
        assert (difference > 1.0) == changed


def test_rows_on_cages_of_their_own_that_change_places_with_their_spall_change_loads(gearbox, build_scene):
    machine, stagger = gearbox.bearing, math.pi / 12
    first, second = ((17.9, 0.3), (16.0, 1.1))  # speed (rad/s) and angle of ball 1 (rad) of each row
    spall = Spall("outer", 1, math.radians(270.0), 0.3, 12e-6, 0.1, 0.1)
    cage, other = (CagePath(speed, 0.5, angle) for speed, angle in (first, (second[0], second[1] - stagger)))
    scene = build_scene(gearbox, spall, cage=cage, second_cage=other)
    cage, other = (CagePath(speed, 0.5, angle) for speed, angle in (second, (first[0], first[1] - stagger)))
    turned = build_scene(gearbox, dataclasses.replace(spall, row=2), cage=cage, second_cage=other)
    time = np.linspace(0.0, 0.5, 101)
    assert machine.stagger == stagger
    np.testing.assert_allclose(loads_of(turned, time)[:, ::-1], loads_of(scene, time), atol=1e-6)  # N; the solver's


def test_a_larger_ball_carries_more_and_a_smaller_one_less(gearbox, build_scene):
    even = loads_of(build_scene(gearbox))[0]
    for deviation, more in ((1e-6, True), (-1e-6, False)):
        rows = [[0.0] * 12, [0.0] * 12]
        rows[0][9] = deviation
        uneven = Imperfections(ball_deviation=tuple(tuple(row) for row in rows))
        assert (loads_of(build_scene(gearbox, imperfections=uneven))[0, 0, 9] > even[0, 9]) == more


def test_a_ball_s_size_counts_along_the_contact_normal_and_clearance_along_the_radius(gearbox, build_scene):
    angle, larger, clearance = math.radians(30), 5e-6, 2e-6
    oversize = Imperfections(ball_deviation=((larger,) * 12,) * 2)
    bearing = {"contact_angle": angle, "clearance": clearance}
    scene = build_scene(gearbox, bearing=bearing, operation={"load": 0.0}, imperfections=oversize)
    each = gearbox.bearing.load_deflection * (larger - clearance * math.cos(angle)) ** 1.5  # the shaft at the centre
    assert loads_of(scene) == pytest.approx(each, rel=1e-9)  # rounding


def test_with_a_contact_angle_balls_press_harder_and_the_shaft_sinks_deeper(gearbox, build_scene):
    tilted = equilibrium(build_scene(gearbox, bearing={"contact_angle": math.radians(30)}), START)
    straight = equilibrium(build_scene(gearbox), START)
    cosine = math.cos(math.radians(30))
    assert tilted.ball_load.max() == pytest.approx(straight.ball_load.max() / cosine, rel=SOLVED)
    factor = cosine ** (-5.0 / 3.0)  # K cos^(n+1) α to the power −1/n
    assert tilted.displacement[0, 1] == pytest.approx(straight.displacement[0, 1] * factor, rel=SOLVED)


def test_the_load_vector_is_the_static_load_with_its_fluctuation_and_the_unbalance(gearbox, build_scene):
    operation = {"load": 100.0, "load_fluctuation": 0.3, "fluctuation_phase": 1.1}
    operation |= {"unbalance_force": 7.0, "unbalance_phase": 0.4}
    time = np.linspace(0.0, 0.3, 7)
    turn = 2 * math.pi * 7.0 * time
    expected_y = 7.0 * np.sin(turn + 0.4) - 100.0 * (1 + 0.3 * np.cos(turn + 1.1))
    load = load_vector(build_scene(gearbox, operation=operation), time)
    assert np.allclose(load, np.stack([7.0 * np.cos(turn + 0.4), expected_y], axis=1), rtol=1e-9)  # 7 Hz in rad/s


@pytest.mark.parametrize(
    ("load", "unbalance", "fluctuation", "phase"),
    [
        (346.0, 0.0, 0.0, 0.0),
        (346.0, 50.0, 0.0, 1.0),
        (346.0, 0.0, 2.0, 0.4),
        (346.0, 300.0, 0.5, 2.0),
        (0.0, 5.0, 9.0, 0),
    ],
)
def test_the_range_of_the_load_is_that_of_a_dense_search(gearbox, build_scene, load, unbalance, fluctuation, phase):
    run = Operation(gearbox.rated_speed, load, unbalance, phase, fluctuation, 0.3)
    angle = np.linspace(0.0, 2.0 * math.pi, 1_000_001)
    down = load * (1.0 + fluctuation * np.cos(angle + 0.3))
    magnitude = np.hypot(unbalance * np.cos(angle + phase), unbalance * np.sin(angle + phase) - down)
    found = load_range(dataclasses.replace(build_scene(gearbox), operation=run))
    # The search steps by 6e-6 of the angle, over which a load of 1 kN that passes through zero moves by 6 mN.
    assert found == pytest.approx((magnitude.min(), magnitude.max()), rel=1e-9, abs=6e-3)
    if fluctuation > 1.0 and unbalance == 0.0:
        assert found[0] < 1e-9 * found[1]


def test_the_damping_is_that_of_the_loaded_balls(gearbox, build_scene):
    loose = dataclasses.replace(gearbox, bearing=dataclasses.replace(gearbox.bearing, clearance=2e-5))
    scene = build_scene(loose, LINE, start_angle=0.05)
    rest = equilibrium(scene, START)
    phi = angles(scene, START)[rest.ball_load > 0.0]
    expected = 100.0 * np.array([np.sum(np.cos(phi) ** 2), np.sum(np.sin(phi) ** 2), np.sum(np.cos(phi) * np.sin(phi))])
    assert np.abs(np.subtract.outer(expected, expected))[np.triu_indices(3, 1)].min() > 10.0  # none passes for another
    assert rest.damping[0] == pytest.approx(expected, rel=1e-12)


QUASI_STATIC = {
    "series": lambda scene, time: stiffness_series(scene, time[1], time.size),
    "load of a ball": lambda scene, time: ball_load(scene, time, 1, np.ones(time.size, dtype=np.int64)),
    "equilibrium": require_equilibrium,
}


@pytest.mark.parametrize("step", [1 / 65536, 1 / 200])  # at which the series is sparse, and at which it is not
@pytest.mark.parametrize("preload", [0.0, 15e-6])
@pytest.mark.parametrize("name", QUASI_STATIC)
def test_where_no_position_carries_the_load_there_is_no_answer(gearbox, build_scene, name, preload, step):
    soft = {"load_deflection": 1e5, "clearance": -preload}
    crushed = build_scene(gearbox, bearing=soft, operation={"load": 1e7})
    with pytest.raises(
        SimulationFailed, match=r"at t = 0 s no position of the shaft carries .* of 1e\+07 N"
    ) as failure:
        QUASI_STATIC[name](crushed, np.arange(200) * step)
    assert failure.value.outcome is Outcome.NO_START


@pytest.mark.parametrize("name", QUASI_STATIC)
def test_the_first_instant_is_told_at_which_a_growing_load_is_not_carried(gearbox, build_scene, name):
    swinging = {"load": 1e4, "load_fluctuation": 1.0, "fluctuation_phase": math.pi}
    scene = build_scene(gearbox, bearing={"load_deflection": 1e5}, operation=swinging)
    time = np.arange(5000) / 65536.0  # half a turn, in which the load grows from 0 to 20 kN
    lost = np.flatnonzero(equilibrium(scene, time).status == NO_EQUILIBRIUM)
    assert time[lost[0]] == pytest.approx(0.0267, abs=1e-4)  # where the shaft would have moved by 50 mm
    for instants in (time, time[: lost[0] + 1]):
        with pytest.raises(SimulationFailed, match=r"^at t = 0\.026[67]\d* s no position"):
            QUASI_STATIC[name](scene, instants)
    # Within a few instants of it the way there is given up as too far by those that set out from farther away.
    QUASI_STATIC[name](scene, time[: lost[0] - 20])


def test_every_status_names_one_outcome():
    assert list(OUTCOMES.values()) == list(StaticOutcome)


@pytest.mark.parametrize("count", [64, 10])
def test_instants_without_period_see_the_mean_of_a_swing_whatever_its_period(count):
    instants = instants_without_period(0.3, count)
    assert instants.size == count
    assert 0.0 <= instants[0] < instants[-1] < 0.3
    assert (np.diff(instants) > 0.0).all()
    golden = (math.sqrt(5.0) - 1.0) / 2.0
    for swings in (1, 2, count // 2, count, 2 * count):
        # A geometric series: of n terms exp(2πi h k g) the mean is below 1 / (n |sin πhg|).
        mean = abs(np.exp(2j * np.pi * swings * instants / 0.3).mean())
        assert mean <= 1.0001 / (count * abs(math.sin(math.pi * swings * golden)))
