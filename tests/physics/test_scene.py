import dataclasses
import math
from contextlib import nullcontext

import numpy as np
import pytest
from variants import changed

from physics.assembly import assemble
from physics.cage import CagePath
from physics.checks import InvalidParameter
from physics.imperfections import Imperfections, Waviness
from physics.motion import motion_model
from physics.operation import Operation
from physics.paths.profile import build_path
from physics.scene import Scene
from physics.spall import Spall

SPALL = Spall("outer", 1, math.radians(270), 0.1, 12e-6)


@pytest.fixture
def healthy(gearbox):
    cage = CagePath(nominal_speed=gearbox.bearing.cage_speed(gearbox.rated_speed), duration=0.5)
    return Scene(rig=gearbox, operation=Operation(shaft_speed=gearbox.rated_speed, load=346.0), cage=cage)


@pytest.fixture
def single_row(gearbox):
    return dataclasses.replace(gearbox, bearing=dataclasses.replace(gearbox.bearing, name="single", rows=1))


def test_a_scene_lasts_as_long_as_its_cage_path_and_names_its_defective_race(healthy):
    assert healthy.duration == 0.5
    assert healthy.defective_race == "none"
    assert dataclasses.replace(healthy, spalls=(SPALL,)).defective_race == "outer"
    inner = dataclasses.replace(SPALL, race="inner")
    assert dataclasses.replace(healthy, spalls=(inner,)).defective_race == "inner"


@pytest.mark.parametrize(
    "changes",
    [
        {"operation": Operation(shaft_speed=80.0, load=346.0, unbalance_force=1.0)},
        {"operation": Operation(shaft_speed=80.0, load=346.0, load_fluctuation=0.1)},
        {"imperfections": Imperfections(waviness=(Waviness("inner", 3, 1e-7),))},
        {"spalls": (dataclasses.replace(SPALL, race="inner"),)},
    ],
)
def test_a_scene_knows_what_turns_with_the_shaft(healthy, changes):
    assert dataclasses.replace(healthy, **changes).turns_with_the_shaft


def test_a_still_load_and_an_outer_race_do_not_turn_with_the_shaft(healthy):
    waves = Imperfections(waviness=(Waviness("outer", 3, 1e-7),))
    assert not healthy.turns_with_the_shaft
    assert not dataclasses.replace(healthy, spalls=(SPALL,), imperfections=waves).turns_with_the_shaft


def test_balls_are_alike_if_those_of_each_row_are(healthy):
    rows = {"as drawn": (), "by rows": ((1e-7,) * 12, (2e-7,) * 12), "not": ((1e-7,) * 12, (0.0,) * 11 + (1e-7,))}
    alike = {
        name: dataclasses.replace(healthy, imperfections=Imperfections(ball_deviation=row)).balls_are_alike
        for name, row in rows.items()
    }
    assert alike == {"as drawn": True, "by rows": True, "not": False}


def test_spalls_on_both_races_are_refused(healthy):
    with pytest.raises(InvalidParameter, match="spalls on both races"):
        dataclasses.replace(healthy, spalls=(SPALL, dataclasses.replace(SPALL, race="inner", row=2)))


def test_a_spall_on_a_row_that_the_bearing_lacks_is_refused(healthy, single_row):
    second = dataclasses.replace(SPALL, row=2)
    with pytest.raises(InvalidParameter, match="spall on row 2, but bearing single has 1 row"):
        dataclasses.replace(healthy, rig=single_row, spalls=(second,))


@pytest.mark.parametrize("row", [0, 3])
def test_no_cage_holds_a_row_that_the_bearing_lacks(healthy, row):
    assert healthy.cage_of(2) is healthy.cage
    with pytest.raises(InvalidParameter, match=f"row = {row}; allowed: whole numbers 1 to 2"):
        healthy.cage_of(row)


@pytest.mark.parametrize("apart", [0.0, 0.09, -0.09, 2 * math.pi - 0.09])
def test_overlapping_spalls_of_one_row_are_refused(healthy, apart):
    other = dataclasses.replace(SPALL, angle=SPALL.angle + apart)
    with pytest.raises(InvalidParameter, match="two spalls on row 1 overlap"):
        dataclasses.replace(healthy, spalls=(SPALL, other))


def test_spalls_may_touch_or_lie_side_by_side_on_two_rows(healthy):
    beside = dataclasses.replace(SPALL, row=2)
    after = dataclasses.replace(SPALL, angle=SPALL.angle + 0.1)
    assert len(dataclasses.replace(healthy, spalls=(SPALL, beside, after)).spalls) == 3


def test_an_unknown_contact_law_is_refused(healthy):
    with pytest.raises(InvalidParameter, match='contact_law = "glue"; allowed: paper, no_tension'):
        dataclasses.replace(healthy, contact_law="glue")


@pytest.mark.parametrize("rows", [((0.0,) * 12,), ((0.0,) * 12, (0.0,) * 11)])
def test_ball_deviations_must_name_every_ball(healthy, rows):
    with pytest.raises(InvalidParameter, match="ball_deviation must hold 2 row"):
        dataclasses.replace(healthy, imperfections=Imperfections(ball_deviation=rows))


def test_a_second_cage_needs_a_second_row(healthy, single_row):
    with pytest.raises(InvalidParameter, match="a second cage needs 2 rows; bearing single has 1"):
        dataclasses.replace(healthy, rig=single_row, second_cage=healthy.cage)


def test_both_cages_last_equally_long(healthy):
    short = dataclasses.replace(healthy.cage, duration=0.4)
    with pytest.raises(InvalidParameter, match=r"0\.5 s and 0\.4 s; they must last equally long"):
        dataclasses.replace(healthy, second_cage=short)
    assert dataclasses.replace(healthy, second_cage=healthy.cage).second_cage is healthy.cage


@pytest.mark.parametrize("field", ["cage", "second_cage"])
def test_a_cage_faster_than_the_shaft_over_an_inner_spall_is_refused_with_both_speeds(healthy, field):
    inner = dataclasses.replace(SPALL, race="inner", row=1 if field == "cage" else 2)
    shaft = healthy.operation.shaft_speed
    fast = CagePath(1.25 * shaft, 0.5)
    assert dataclasses.replace(healthy, spalls=(SPALL,), **{field: fast}).defective_race == "outer"
    message = r"54\.9779 rad/s at its fastest; .* below the shaft's 43\.9823"
    with pytest.raises(InvalidParameter, match=message) as refused:
        dataclasses.replace(healthy, spalls=(inner,), **{field: fast})
    assert refused.value.field == field
    for share in (0.99, 1.0):
        dataclasses.replace(healthy, spalls=(inner,), **{field: CagePath(share * shaft, 0.5)})


def test_of_two_cages_the_one_over_the_inner_spall_is_named_whatever_the_other_does(healthy):
    shaft = healthy.operation.shaft_speed
    slow, fast = CagePath(0.4 * shaft, 0.5), CagePath(1.25 * shaft, 0.5)
    for row, first, second, field in ((1, fast, slow, "cage"), (2, slow, fast, "second_cage")):
        inner = dataclasses.replace(SPALL, race="inner", row=row)
        with pytest.raises(InvalidParameter, match=rf"^{field} = 54\.9779 rad/s at its fastest") as refused:
            dataclasses.replace(healthy, spalls=(inner,), cage=first, second_cage=second)
        assert refused.value.field == field
        dataclasses.replace(healthy, spalls=(inner,), cage=second, second_cage=first)


def put_over_inner_spall(healthy, cage, refusal):
    """Put that cage over a spall of the inner race: refused with that message, or accepted if there is none."""
    inner = dataclasses.replace(SPALL, race="inner")
    with nullcontext() if refusal is None else pytest.raises(InvalidParameter, match=refusal):
        dataclasses.replace(healthy, cage=cage, spalls=(inner,))


def test_a_cage_that_overtakes_the_shaft_between_two_knots_of_its_slip_is_refused(healthy):
    shaft = healthy.operation.shaft_speed
    # The spline through 0, a, a, 0 (steps of 1, natural ends) peaks half-way, at 1.15 a: by hand, its second derivative
    # at both inner knots is -6 a / 5, which lifts the middle of the chord by (6 a / 5) / 8 = 0.15 a.
    for peak, refusal in ((0.999, None), (1.001, r"cage = 44\.0263 rad/s at its fastest")):
        slip = (peak / 0.8 - 1.0) / 1.15
        cage = CagePath(0.8 * shaft, 0.5, knot_step=0.5 / 3.0, knot_values=(0.0, slip, slip, 0.0))
        assert cage.fastest == pytest.approx(peak * shaft, rel=1e-12)  # rounding
        put_over_inner_spall(healthy, cage, refusal)


def test_a_cage_that_overtakes_the_shaft_before_and_after_its_slip_is_refused(healthy):
    """Beyond the record, where passes begin and end, a cage goes on at its mean speed."""
    shaft = healthy.operation.shaft_speed
    for mean, refusal in ((0.99, None), (1.01, r"cage = 44\.4221 rad/s at its fastest")):
        cage = CagePath(mean * shaft, 0.5, knot_step=0.5, knot_values=(-0.1, -0.1))
        assert cage.fastest == pytest.approx(0.9 * mean * shaft)
        put_over_inner_spall(healthy, cage, refusal)


def test_a_cage_that_slips_and_reaches_the_speed_of_the_shaft_is_refused(healthy):
    shaft = healthy.operation.shaft_speed
    slipping = CagePath(shaft, 0.5, knot_step=0.25, knot_values=(0.0, -0.1, -0.1))
    assert slipping.fastest == shaft
    put_over_inner_spall(healthy, slipping, "or that speed without slip")


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_balls_pass_a_spall_at_the_mean_speed_of_a_cage_that_slips(healthy, race):
    spall = dataclasses.replace(SPALL, race=race)
    scene = dataclasses.replace(healthy, spalls=(spall,), cage=dataclasses.replace(healthy.cage, mean_slip=0.1))
    # 2π · 7 Hz of the shaft; the cage turns 0.9 · 0.5 (1 − 7.12/38.75) times as fast.
    shaft, cage = 43.9823, 0.9 * 17.9505
    expected = cage if race == "outer" else shaft - cage
    assert scene.crossing_speed(spall) == pytest.approx(expected, rel=1e-5)  # digits


def test_no_sample_is_lost_to_the_rounding_of_duration_times_rate(healthy):
    assert 0.29 * 100.0 < 29.0  # in binary
    assert dataclasses.replace(healthy, cage=dataclasses.replace(healthy.cage, duration=0.29)).samples(100.0) == 29


def test_a_race_of_another_name_has_no_speed(healthy):
    assert (healthy.race_speed("outer"), healthy.race_speed("inner")) == (0.0, healthy.operation.shaft_speed)
    with pytest.raises(InvalidParameter, match='race = "cage"; allowed: outer, inner'):
        healthy.race_speed("cage")


@pytest.mark.parametrize("sequence", [list, np.array])
def test_lists_and_arrays_describe_the_same_scene_as_tuples(healthy, sequence):
    deviation = ((0.0, 1e-6, *(0.0,) * 10), (0.0,) * 12)
    slip, heights = (0.0, 1e-3, 0.0, -1e-3) * 3, (0.0, 1e-7, -1e-7, 0.0)
    wave, steps = Waviness("outer", 3, 1e-7), 0.1 * healthy.duration

    def described(in_rows, numbers):
        spall = Spall("outer", 1, 4.0, 0.3, 1e-5, roughness=1e-7, roughness_values=numbers(heights))
        cage = dataclasses.replace(healthy.cage, knot_step=steps, knot_start=-steps, knot_values=numbers(slip))
        imperfections = Imperfections(waviness=in_rows((wave,)), ball_deviation=in_rows(map(numbers, deviation)))
        return dataclasses.replace(healthy, spalls=in_rows((spall,)), cage=cage, imperfections=imperfections)

    assert described(list, sequence) == described(tuple, tuple)
    assert hash(described(list, sequence)) == hash(described(tuple, tuple))


@pytest.mark.parametrize("single", [Spall("outer", 1, 4.0, 0.3, 1e-5), None, np.array(1.0)])
def test_a_single_spall_is_no_sequence_of_them(healthy, single):
    with pytest.raises(InvalidParameter, match=f"spalls is of type {type(single).__name__}; it must be a sequence"):
        dataclasses.replace(healthy, spalls=single)


@pytest.mark.parametrize(
    "shape",
    [
        {"entry_taper": 1e-12},
        {"roughness": 1e-6, "roughness_values": (0.0, 1e-6, -1e-6, 0.0)},
        {"profile": "table", "table_angle": (-1e-11, 1e-11), "table_depth": (1e-5, 1e-5)},
    ],
)
def test_a_surface_too_short_to_roll_a_ball_over_is_refused(healthy, shape):
    radius = healthy.rig.bearing.raceway_radius("outer")
    for length, allowed in ((0.9e-6, False), (1.1e-6, True)):
        shape = {"profile": "ball_path", **shape}
        if shape["profile"] == "table":
            shape["table_angle"] = (-0.5 * length / radius, 0.5 * length / radius)
        spall = Spall("outer", 1, 4.0, 1.001 * length / radius, 1e-5, **shape)
        if allowed:
            dataclasses.replace(healthy, spalls=(spall,))
        else:
            with pytest.raises(InvalidParameter, match=r"surface 9(\.01)?e-07 m long; allowed: from 1e-06 m"):
                dataclasses.replace(healthy, spalls=(spall,))


def test_a_short_table_within_a_long_spall_is_refused(healthy):
    short = Spall("outer", 1, 4.0, 0.1, 0.0, profile="table", table_angle=(-1e-6, 1e-6), table_depth=(0.0, 0.0))
    with pytest.raises(InvalidParameter, match=r"surface 4\.59e-08 m long; allowed: from 1e-06 m"):
        dataclasses.replace(healthy, spalls=(short,))


@pytest.mark.parametrize("race", ["outer", "inner"])
@pytest.mark.parametrize("end", [0, -1])
def test_a_table_that_ends_in_a_wall_as_high_as_the_ball_s_centre_is_refused(healthy, race, end):
    """Where a wall is lower the ball climbs over its corner, and a ramp may be as high as it likes."""
    radius = healthy.rig.bearing.ball_radius
    heights = [0.0, -1.4 * radius, -1.4 * radius, 0.0]
    for height, allowed in ((0.99 * radius, True), (radius, False), (1.4 * radius, False)):
        heights[end] = -height
        spall = Spall(race, 1, 4.0, 0.7, 0.0, profile="table", table_angle=(-0.3, -0.1, 0.1, 0.3), table_depth=heights)
        if allowed:
            scene = dataclasses.replace(healthy, spalls=(spall,))
            highest = build_path(scene.spalls[0], healthy.rig.bearing).depth(np.linspace(-0.4, 0.4, 8001)).min()
            assert highest == pytest.approx(-1.4 * radius, rel=1e-6)
        else:
            with pytest.raises(
                InvalidParameter, match=r"in a wall that no ball of 0\.00356 m radius rolls over"
            ) as caught:
                dataclasses.replace(healthy, spalls=(spall,))
            assert caught.value.field == "table_depth"


def test_a_path_in_closed_form_may_be_as_short_as_it_likes(healthy):
    for profile in ("tukey", "ball_path"):
        dataclasses.replace(healthy, spalls=(Spall("outer", 1, 4.0, 1e-12, 1e-5, profile=profile),))


ANGLES = {
    "angle": lambda scene: changed(scene, spall={"angle": 1e20}),
    "start_angle": lambda scene: dataclasses.replace(scene.cage, start_angle=1e20),
    "unbalance_phase": lambda scene: changed(scene, operation={"unbalance_phase": 1e20}),
    "fluctuation_phase": lambda scene: changed(scene, operation={"fluctuation_phase": -1e20}),
}


@pytest.mark.parametrize("field", ANGLES)
def test_an_angle_of_more_turns_than_floats_tell_apart_is_refused(field, reference_scene):
    """A spall at 1e20 rad was looked for without end."""
    with pytest.raises(InvalidParameter, match=f"^{field} = .*1e\\+20 rad; allowed: -1e"):
        ANGLES[field](reference_scene("G1", 0.01))


def test_numbers_of_every_type_reach_the_kernels_as_floats(reference_scene):
    """They are compiled once more, for a minute, for every other type."""
    scene = reference_scene("G1", 0.01)
    other = changed(scene, operation={"load": np.float32(300.0)}, rig={"outer_mass": np.int64(2), "inner_mass": 3})
    for compiled in (motion_model(other), assemble(other).law):
        assert {type(value) for value in compiled if not isinstance(value, tuple | bool)} == {float}
    assert motion_model(other).load == 300.0
