"""Quasi-static stiffness: check values, finite differences of the force, periodicity, and what a spall does to it."""

import dataclasses
import math

import numpy as np
import pytest
from at_rest import EXTENDED, LINE, START

from physics.imperfections import Imperfections, Waviness
from physics.statics.load_distribution import equilibrium, require_equilibrium
from physics.statics.stiffness import symmetric_matrices
from physics.words import STIFFNESS_COMPONENTS

XX, YY, XY = range(3)
FIRST_TOUCH = 100.0  # N/m: 1.5 K √δ of a ball at first touch, where δ is known to 1e-16 m


def at_cage_angle(build_scene, rig, degrees, *spalls, **changes):
    return require_equilibrium(
        build_scene(rig, *spalls, start_angle=math.radians(degrees), **changes), START
    ).stiffness[0]


def over_cage_angles(build_scene, rig, *spalls, spacings, **changes):
    """Stiffness (481, 3) while the cage turns by `spacings` ball spacings."""
    scene = build_scene(rig, *spalls, **changes)
    turn = spacings * scene.rig.bearing.spacing
    return require_equilibrium(scene, np.linspace(0.0, turn / scene.cage.nominal_speed, 481)).stiffness


@pytest.mark.parametrize(("degrees", "label"), [(0.0, "0"), (7.5, "7_5_deg")])
def test_the_healthy_stiffness_is_that_of_the_independent_implementation(
    authority, gearbox, build_scene, degrees, label
):
    expected = authority("independent_model")["statics"]
    stiffness = at_cage_angle(build_scene, gearbox, degrees)
    for component, name in ((XX, "kxx"), (YY, "kyy")):
        check = expected[f"gearbox_{name}_at_{label}_MN_per_m"]
        assert stiffness[component] * 1e-6 == pytest.approx(check["value"], abs=check["tolerance"])  # the digits given
    assert abs(stiffness[XY]) < 1e-9 * stiffness[YY]  # by symmetry; the rest is rounding


SCENES = {
    "healthy": {},
    "clearance": {"bearing": {"clearance": 3e-6}},
    "rollers": {"bearing": {"exponent": 10 / 9, "load_deflection": 4e8}},
    "contact angle": {"bearing": {"contact_angle": math.radians(20)}},
    "waviness": {"imperfections": Imperfections(waviness=(Waviness("inner", 5, 1e-6),))},
}


@pytest.mark.parametrize("spalls", [(), (LINE,), (EXTENDED,), (dataclasses.replace(EXTENDED, race="inner"),)])
@pytest.mark.parametrize("variant", SCENES)
def test_stiffness_times_the_shift_is_the_change_of_load(gearbox, build_scene, variant, spalls):
    changed = SCENES[variant]
    scene = build_scene(gearbox, *spalls, start_angle=0.05, **changed)
    stiffness = symmetric_matrices(require_equilibrium(scene, START).stiffness[0])
    little = 1e-3
    for phase in (0.0, math.pi / 2.0, 2.0):
        extra = {"unbalance_force": little, "unbalance_phase": phase}
        opposite = {"unbalance_force": little, "unbalance_phase": phase + math.pi}
        after, before = (
            equilibrium(build_scene(gearbox, *spalls, start_angle=0.05, operation=operation, **changed), START)
            for operation in (extra, opposite)
        )
        shift = after.displacement[0] - before.displacement[0]
        expected = 2.0 * little * np.array([math.cos(phase), math.sin(phase)])
        assert stiffness @ shift == pytest.approx(expected, abs=2e-5 * little)  # loads known to 1e-11 of 346 N


def test_the_healthy_stiffness_of_staggered_rows_repeats_every_half_ball_spacing(gearbox, build_scene):
    trace = over_cage_angles(build_scene, gearbox, spacings=1.5)
    assert np.allclose(trace[:-160], trace[160:], rtol=1e-8, atol=FIRST_TOUCH)
    assert np.ptp(trace[:, XX]) > 0.05 * trace[0, XX]


def test_the_healthy_stiffness_of_one_row_repeats_only_every_ball_spacing(gearbox, build_scene):
    trace = over_cage_angles(build_scene, gearbox, spacings=2, bearing={"rows": 1})
    assert np.allclose(trace[:-240], trace[240:], rtol=1e-8, atol=FIRST_TOUCH)
    assert np.max(np.abs(trace[:-120, XX] - trace[120:, XX])) > 0.1 * trace[0, XX]


def test_an_outer_spall_on_one_row_makes_the_stiffness_repeat_every_ball_spacing(gearbox, build_scene):
    trace = over_cage_angles(build_scene, gearbox, LINE, spacings=2)
    assert np.allclose(trace[:-240], trace[240:], rtol=1e-8, atol=FIRST_TOUCH)
    assert np.max(np.abs(trace[:-120, YY] - trace[120:, YY])) > 0.05 * trace[0, YY]


def test_each_healthy_row_s_stiffness_along_the_load_varies_by_one_or_two_tenths_of_a_meganewton(gearbox, build_scene):
    """Section 5.4 of the paper: "about 0.1-0.2 MN/m"; each row's share follows from its balls' loads."""
    scene, bearing = build_scene(gearbox), gearbox.bearing
    time = np.linspace(0.0, bearing.spacing / scene.cage.nominal_speed, 481)
    rest = equilibrium(scene, time)
    within = np.arange(2)[:, None] * bearing.stagger + np.arange(12) * bearing.spacing
    sine = np.sin(scene.cage.angle(time)[:, None, None] + within)
    each = 1.5 * bearing.load_deflection ** (2.0 / 3.0) * np.cbrt(rest.ball_load) * sine**2
    assert np.allclose(each.sum((1, 2)), rest.stiffness[:, YY], rtol=1e-12)
    assert np.all((np.ptp(each.sum(2), axis=0) > 0.1e6) & (np.ptp(each.sum(2), axis=0) < 0.2e6))


@pytest.mark.parametrize("spall", [LINE, dataclasses.replace(LINE, depth=2e-6), EXTENDED])
def test_a_ball_in_the_spall_lowers_the_stiffness_along_the_load_and_raises_it_across(gearbox, build_scene, spall):
    """Section 5.4 of the paper."""
    healthy = at_cage_angle(build_scene, gearbox, 0.0)
    spalled = at_cage_angle(build_scene, gearbox, 0.0, spall)
    assert spalled[YY] < healthy[YY]
    assert spalled[XX] > healthy[XX]


def test_a_line_spall_changes_the_stiffness_only_while_a_ball_is_in_it(gearbox, build_scene):
    """Section 5.4 of the paper: an extended spall changes it at every cage angle."""
    scene = build_scene(gearbox, LINE)
    angle = np.linspace(0.0, scene.rig.bearing.spacing, 301)
    time = angle / scene.cage.nominal_speed
    healthy, line, extended = (
        require_equilibrium(build_scene(gearbox, *spalls), time).stiffness for spalls in ((), (LINE,), (EXTENDED,))
    )
    arc = np.remainder(angle + scene.rig.bearing.spacing / 2, scene.rig.bearing.spacing) - scene.rig.bearing.spacing / 2
    outside = np.abs(arc) > LINE.extent / 2
    assert np.allclose(line[outside], healthy[outside], rtol=1e-8, atol=FIRST_TOUCH)
    assert np.all(line[np.abs(arc) < LINE.extent / 4, YY] < 0.99 * healthy[np.abs(arc) < LINE.extent / 4, YY])
    assert np.all(extended[:, YY] < healthy[:, YY] - 1e4)


def test_the_cross_coupling_is_one_or_two_orders_smaller_and_larger_for_the_extended_spall(gearbox, build_scene):
    """Section 5.4 of the paper."""
    largest = []
    for spall in (LINE, EXTENDED):
        trace = over_cage_angles(build_scene, gearbox, spall, spacings=1)
        largest.append(np.max(np.abs(trace[:, XY])))
        assert largest[-1] < 0.1 * trace[:, YY].min()
    assert largest[1] > largest[0]


def test_without_load_there_is_no_stiffness(fan, build_scene):
    assert np.array_equal(
        require_equilibrium(build_scene(fan, operation={"load": 0.0}), START).stiffness, np.zeros((1, 3))
    )


def test_the_trace_is_taken_at_each_instant_s_own_load_and_spall_angle(gearbox, build_scene):
    inner = dataclasses.replace(EXTENDED, race="inner")
    scene = build_scene(gearbox, inner, operation={"load_fluctuation": 0.5, "unbalance_force": 20.0})
    time = np.array([0.0, 0.02, 0.05])
    for k, trace in enumerate(require_equilibrium(scene, time).stiffness):
        turn = 2 * math.pi * 7.0 * time[k]
        frozen = build_scene(
            gearbox,
            dataclasses.replace(inner, angle=inner.angle + turn),
            start_angle=scene.cage.nominal_speed * time[k],
            operation={"load": 346.0 * (1 + 0.5 * math.cos(turn)), "unbalance_force": 20.0, "unbalance_phase": turn},
        )
        assert trace == pytest.approx(
            require_equilibrium(frozen, START).stiffness[0], rel=1e-8, abs=1.0
        )  # the solver's tolerance


def test_matrices_are_symmetric_and_hold_the_components_in_their_order():
    components = np.arange(6.0).reshape(2, 3)
    assert STIFFNESS_COMPONENTS == ("xx", "yy", "xy")
    assert symmetric_matrices(components).tolist() == [[[0.0, 2.0], [2.0, 1.0]], [[3.0, 5.0], [5.0, 4.0]]]
    assert symmetric_matrices((1.0, 2.0, 3.0)).tolist() == [[1.0, 3.0], [3.0, 2.0]]
