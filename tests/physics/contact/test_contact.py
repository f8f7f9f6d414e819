"""Contact forces and their assembly against a plain sum over the balls, written from the model's equations."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kernels import (
    compression_of,
    count_changes,
    direction,
    of_ball,
    passage,
    place_of,
    press,
    reset_contact,
    set_time,
    touches,
)
from variants import slipping_cage

from physics.assembly import assemble, ball_numbers
from physics.contact.forces import (
    ACTIVE,
    COMPRESSION,
    FALL,
    FLOOR,
    FORCE,
    LAW,
)
from physics.imperfections import Imperfections, Waviness
from physics.spall import Spall

BOTTOM = math.radians(270.0)
REST = (1e-6, -6e-6)
STILL = (0.0, 0.0)
MOVING = (2e-3, -3e-3)
INSTANT = 0.0123
SECOND = 1e-7  # s: half the time over which the plain sum differences its compressions
DIFFERENCED = 1e-6  # error of those differences: SECOND² times the third derivative, over a taper of some milliseconds


def taper(distance, length):
    return np.where(distance < length, 0.5 * (1 - np.cos(np.pi * np.clip(distance, 0, None) / length)), 1.0)


def tukey(spall, arc):
    """Equation 17 without roughness, at arcs along the direction of travel."""
    arc = (arc + np.pi) % (2 * np.pi) - np.pi
    half = spall.extent / 2
    depth = spall.depth * np.minimum(taper(arc + half, spall.entry_taper), taper(half - arc, spall.exit_taper))
    return np.where(np.abs(arc) <= half, depth, 0.0)


def ball_angles(scene, time):
    """φ of every ball, (rows, balls)."""
    bearing = scene.rig.bearing
    cages = [scene.cage, scene.second_cage or scene.cage][: bearing.rows]
    cage = np.array([float(path.polynomial(time)) for path in cages])
    stagger = np.arange(bearing.rows) * np.pi / bearing.balls
    return (cage + stagger)[:, None] + 2 * np.pi * np.arange(bearing.balls) / bearing.balls


def missing_material(scene, angle, time):
    """Depth (rows, balls), m, below balls at `angle`: spalls and waviness, less what larger balls fill."""
    turned = {"outer": 0.0, "inner": scene.operation.shaft_speed * time}
    depth = np.zeros(angle.shape)
    for spall in scene.spalls:
        along = 1 if spall.race == "outer" else -1
        here = angle[spall.row - 1]
        depth[spall.row - 1] += tukey(spall, along * (here - spall.angle - turned[spall.race]))
    for wave in scene.imperfections.waviness:
        depth += wave.amplitude * np.cos(wave.order * (angle - turned[wave.race]) + wave.phase)
    deviation = np.array(scene.imperfections.ball_deviation or np.zeros(angle.shape))
    return depth - deviation / math.cos(scene.rig.bearing.contact_angle)


def compression(scene, time, shift):
    """Radial compression of every ball, (rows, balls), m."""
    angle = ball_angles(scene, time)
    depth = missing_material(scene, angle, time)
    return shift[0] * np.cos(angle) + shift[1] * np.sin(angle) - depth - scene.rig.bearing.clearance


def plain_forces(scene, time, shift, velocity):
    """Radial force of every ball, (rows, balls), N; the compression's rate is differenced along the motion."""
    bearing = scene.rig.bearing
    alpha = math.cos(bearing.contact_angle)
    shift, velocity = np.array(shift), np.array(velocity)
    after = compression(scene, time + SECOND, shift + velocity * SECOND)
    before = compression(scene, time - SECOND, shift - velocity * SECOND)
    now, rate = compression(scene, time, shift), (after - before) / (2 * SECOND)
    normal = bearing.load_deflection * np.clip(now * alpha, 0, None) ** bearing.exponent
    normal = normal + scene.rig.film_damping * rate * alpha
    if scene.contact_law == "no_tension":
        normal = np.clip(normal, 0.0, None)
    return np.where(now > 0, normal * alpha, 0.0)


def pressed(scene, time, shift, velocity):
    """Net force (2,) and force of every ball (rows, balls) from the kernels, with the contact set the law gives."""
    contacts = assemble(scene)
    set_time(contacts, time)
    press(contacts, *shift, *velocity)
    reset_contact(contacts)
    net = press(contacts, *shift, *velocity)
    return np.array(net), column(scene, contacts, FORCE)


def column(scene, contacts, row):
    real = ball_numbers(scene)[1] >= 0
    return contacts.balls[:, row].ravel()[real].reshape(scene.rig.bearing.rows, scene.rig.bearing.balls)


def agree(scene, time=INSTANT, shift=REST, velocity=MOVING):
    """Compare kernels and plain sum; returns the forces of the balls."""
    expected = plain_forces(scene, time, shift, velocity)
    angle = ball_angles(scene, time)
    net, forces = pressed(scene, time, shift, velocity)
    scale = np.max(np.abs(expected))
    assert scale > 1.0
    assert np.max(np.abs(forces - expected)) < DIFFERENCED * scale
    assert net == pytest.approx(
        [np.sum(expected * np.cos(angle)), np.sum(expected * np.sin(angle))], abs=4 * DIFFERENCED * scale
    )
    return forces


def spall(race, row=1, **changes):
    return dataclasses.replace(Spall(race, row, BOTTOM, 1.1, 4e-6, 0.4, 0.6), **changes)


DEVIATION = tuple(tuple(1e-6 * math.sin(3 * row + 5 * ball) for ball in range(12)) for row in range(2))
WAVES = (Waviness("outer", 9, 1e-6, 0.4), Waviness("inner", 31, 0.5e-6, 1.4), Waviness("inner", 2, 0.7e-6))
VARIANTS = {
    "healthy": {},
    "clearance": {"bearing": {"clearance": 2e-6}},
    "preload": {"bearing": {"clearance": -2e-6}},
    "contact angle": {"bearing": {"contact_angle": math.radians(25)}},
    "rollers": {"bearing": {"exponent": 10 / 9, "load_deflection": 4e8}},
    "one row of seven": {"bearing": {"rows": 1, "balls": 7}},
    "unequal balls": {"imperfections": Imperfections(ball_deviation=DEVIATION)},
    "waviness": {"imperfections": Imperfections(waviness=WAVES)},
    "no tension": {"contact_law": "no_tension"},
}


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("velocity", [STILL, MOVING], ids=["still", "moving"])
def test_forces_are_the_plain_sum_over_the_balls(gearbox, build_scene, variant, velocity):
    forces = agree(build_scene(gearbox, start_angle=0.2, **VARIANTS[variant]), velocity=velocity)
    assert np.count_nonzero(forces) >= 3


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("race", ["outer", "inner"])
def test_forces_over_spalls_are_the_plain_sum_over_the_balls(gearbox, build_scene, race, variant):
    second = () if variant == "one row of seven" else (spall(race, 2, angle=BOTTOM + 0.4, extent=0.9, entry_taper=0.3),)
    scene = build_scene(gearbox, spall(race), spall(race, angle=1.0), *second, start_angle=0.2, **VARIANTS[variant])
    healthy = dataclasses.replace(scene, spalls=())
    for time in (INSTANT, 0.29, 0.43):
        deep = REST[0], 2 * REST[1]
        there = agree(scene, time, deep)
        assert np.max(np.abs(there - agree(healthy, time, deep))) > 1.0


@pytest.mark.parametrize("balls", [3, 12, 13, 17])
def test_waves_lie_under_every_ball_as_their_cosines_tell(gearbox, build_scene, balls):
    waves = (*WAVES, Waviness("outer", 400, 1e-6, 2.0))
    small = dataclasses.replace(gearbox.bearing, balls=balls, ball_diameter=4e-3, row_offset=math.pi / balls)
    machine = dataclasses.replace(gearbox, bearing=small)
    scene = build_scene(machine, start_angle=0.2, imperfections=Imperfections(waviness=waves))
    contacts, bearing = assemble(scene), scene.rig.bearing
    for time in (0.0, INSTANT, 0.43):
        set_time(contacts, time)
        angle = ball_angles(scene, time)
        speed = {"outer": scene.cage.mean_speed, "inner": scene.cage.mean_speed - scene.operation.shaft_speed}
        depth, rate = np.zeros(angle.shape), np.zeros(angle.shape)
        for wave in waves:
            turned = scene.operation.shaft_speed * time if wave.race == "inner" else 0.0
            place = wave.order * (angle - turned) + wave.phase
            depth += wave.amplitude * np.cos(place)
            rate -= wave.amplitude * wave.order * speed[wave.race] * np.sin(place)
        assert column(scene, contacts, FLOOR) - bearing.clearance == pytest.approx(depth, abs=1e-15)
        assert column(scene, contacts, FALL) == pytest.approx(rate, abs=1e-8 * np.abs(rate).max())


def test_waves_have_no_gap_where_rounding_makes_a_whole_turn_of_an_angle_below_zero(gearbox, build_scene):
    scene = build_scene(gearbox, start_angle=-1e-17, imperfections=Imperfections(waviness=WAVES[:2]))
    contacts = assemble(scene)
    set_time(contacts, 0.0)
    depth = 1e-6 * math.cos(0.4) + 0.5e-6 * math.cos(1.4)
    assert column(scene, contacts, FLOOR)[0, 0] - scene.rig.bearing.clearance == pytest.approx(depth, abs=1e-15)
    assert compression_of(contacts, 0, 0.0, 0.0, 0.0, 0.0, 0.0)[0] == pytest.approx(
        -scene.rig.bearing.clearance - depth, abs=1e-15
    )


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_slipping_cage_carries_its_balls_and_their_rates_along(gearbox, build_scene, race):
    scene = build_scene(gearbox, spall(race), spall(race, 2))
    scene = dataclasses.replace(scene, cage=slipping_cage(scene, 1), imperfections=Imperfections(waviness=WAVES))
    for time in (0.0021, 0.21, 0.49):
        agree(scene, time)


def test_two_cages_turn_their_rows_independently(gearbox, build_scene):
    scene = build_scene(gearbox, spall("outer"), spall("outer", 2))
    imperfect = Imperfections(waviness=WAVES, ball_deviation=DEVIATION)
    one = dataclasses.replace(
        scene, cage=slipping_cage(scene, 1), second_cage=slipping_cage(scene, 2, 1.4), imperfections=imperfect
    )
    for time in (INSTANT, 0.21):
        agree(one, time)


def slipping(gearbox, build_scene, race, cages):
    """Two rows in one cage or in two, each with two spalls of one race, waves and unequal balls."""
    spalls = [spall(race, row, angle=BOTTOM + angle + 0.3 * row) for angle in (0.0, 2.0) for row in (1, 2)]
    scene = build_scene(gearbox, *spalls, imperfections=Imperfections(waviness=WAVES, ball_deviation=DEVIATION))
    second = slipping_cage(scene, 2, 1.4) if cages == 2 else None
    return dataclasses.replace(scene, cage=slipping_cage(scene, 1), second_cage=second)


def columns_of(scene):
    """The number, row and ball of every ball, all from 0."""
    rows, balls = ball_numbers(scene)
    return [(number, rows[number], balls[number]) for number in np.flatnonzero(balls >= 0)]


@pytest.mark.parametrize("cages", [1, 2])
@pytest.mark.parametrize("race", ["outer", "inner"])
@pytest.mark.parametrize("time", [-0.003, INSTANT, 0.21, 0.56])  # before, within and behind the path of the cage
def test_a_ball_asked_alone_is_compressed_as_the_plain_sum_tells(gearbox, build_scene, time, race, cages):
    scene = slipping(gearbox, build_scene, race, cages)
    contacts, shift, move = assemble(scene), np.array(REST), np.array(MOVING)
    expected, angle = compression(scene, time, shift), ball_angles(scene, time)
    after, before = (compression(scene, time + side, shift + side * move) for side in (SECOND, -SECOND))
    rate = (after - before) / (2 * SECOND)
    set_time(contacts, time)
    for number, row, ball in columns_of(scene):
        found = compression_of(contacts, number, time, *REST, *MOVING)
        assert found[0] == pytest.approx(expected[row, ball], abs=1e-12)  # the table of a path of 4 µm
        assert found[1] == pytest.approx(rate[row, ball], abs=DIFFERENCED * np.abs(rate).max())
        place = divmod(int(number), contacts.balls.shape[2])
        assert direction(contacts, *place) == pytest.approx(
            (math.cos(angle[row, ball]), math.sin(angle[row, ball])), abs=1e-12
        )


@pytest.mark.parametrize("cages", [1, 2])
@pytest.mark.parametrize("race", ["outer", "inner"])
@pytest.mark.parametrize("step", [1e-4, 6e-3, -6e-3])  # s; in the longer ones a ball covers up to half a spacing
def test_the_balls_that_meet_a_spall_in_a_step_are_those_whose_way_leads_over_it(
    gearbox, build_scene, step, race, cages
):
    scene = slipping(gearbox, build_scene, race, cages)
    track, met = assemble(scene).track, []
    for time in np.linspace(0.01, 0.4, 40):
        for place, spall in enumerate(scene.spalls):
            along, speed = (1, 0.0) if spall.race == "outer" else (-1, scene.operation.shaft_speed)
            angle, later = (ball_angles(scene, t)[spall.row - 1] for t in (time, time + step))
            way = along * (later[0] - angle[0] - speed * step)
            arc = along * (angle - spall.angle - speed * time)
            # Whole turns that bring the way's middle next to the spall.
            arc -= 2 * np.pi * np.round((arc + way / 2) / (2 * np.pi))
            meets = (np.minimum(arc, arc + way) <= spall.extent / 2) & (np.maximum(arc, arc + way) >= -spall.extent / 2)
            travel, hind, turns, leave = passage(track, place, time, step)
            count = math.floor((leave - hind) / track.spacing) + 1
            first = (spall.row - 1) * track.row_size if cages == 1 else 0
            found = [place_of(track, place, turns + k) - first for k in range(count)]
            assert travel == pytest.approx(way, abs=1e-12)
            assert sorted(found) == np.flatnonzero(meets).tolist()
            assert hind + track.spacing * np.arange(count) == pytest.approx(arc[found], abs=1e-9)
            met.append(count)
    assert len(set(met)) > 1


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_balls_are_counted_round_the_row_from_wherever_the_hindmost_is(gearbox, build_scene, race):
    track = assemble(build_scene(gearbox, spall(race, 2))).track
    for row in range(3, 61):
        short = track._replace(row_size=row)
        found = [place_of(short, 0, float(turns)) for turns in range(-3 * row, 3 * row + 1)]
        along = 1 if race == "outer" else -1
        assert found == [12 + along * turns % row for turns in range(-3 * row, 3 * row + 1)]


def test_the_film_s_force_is_the_damping_times_the_total_derivative_of_the_compression(gearbox, build_scene):
    scene = build_scene(gearbox, spall("inner"), start_angle=0.2)
    rigid = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, film_damping=0.0))
    film = pressed(scene, INSTANT, REST, MOVING)[1] - pressed(rigid, INSTANT, REST, MOVING)[1]
    moved = np.array(REST) + np.array(MOVING) * SECOND, np.array(REST) - np.array(MOVING) * SECOND
    after, before = compression(scene, INSTANT + SECOND, moved[0]), compression(scene, INSTANT - SECOND, moved[1])
    rate = (after - before) / (2 * SECOND)
    touching = compression(scene, INSTANT, REST) > 0
    assert np.allclose(film[touching], 100.0 * rate[touching], atol=1e-6)  # the difference of forces near 100 N
    assert np.ptp(film[touching]) > 0.1


def test_a_turning_cage_alone_squeezes_and_relieves_the_film(gearbox, build_scene):
    scene = build_scene(gearbox, start_angle=0.2)
    angle, turn = ball_angles(scene, INSTANT), scene.cage.nominal_speed
    rate = turn * (-REST[0] * np.sin(angle) + REST[1] * np.cos(angle))
    _, moving = pressed(scene, INSTANT, REST, STILL)
    now = compression(scene, INSTANT, REST)
    elastic = 5157e6 * np.clip(now, 0, None) ** 1.5
    assert np.allclose(moving, np.where(now > 0, elastic + 100.0 * rate, 0.0), atol=1e-9)  # rounding of 100 N


@pytest.mark.parametrize(("exponent", "factor"), [(1.5, 2**1.5), (10 / 9, 2 ** (10 / 9)), (1.0, 2.0)])
def test_force_grows_with_the_exponent_of_the_load_deflection_law(gearbox, build_scene, exponent, factor):
    scene = build_scene(gearbox, start_angle=0.2, bearing={"exponent": exponent})
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, film_damping=0.0))
    once, twice = (pressed(scene, INSTANT, (0.0, -depth), STILL)[1] for depth in (5e-6, 10e-6))
    loaded = once > 0
    assert np.allclose(twice[loaded] / once[loaded], factor, rtol=1e-9)  # rounding of small compressions


def test_the_no_tension_law_never_pulls_where_the_paper_s_law_does(gearbox, build_scene):
    leaving = (0.0, 0.4)
    paper = build_scene(gearbox, start_angle=0.2)
    gentle = dataclasses.replace(paper, contact_law="no_tension")
    _, pulling = pressed(paper, INSTANT, REST, leaving)
    _, pushing = pressed(gentle, INSTANT, REST, leaving)
    assert pulling.min() < -1.0
    assert pushing.min() == 0.0
    assert np.allclose(pushing, np.clip(pulling, 0.0, None), atol=1e-12)


def test_forces_follow_the_frozen_contact_set_until_it_is_reset(gearbox, build_scene):
    contacts = assemble(build_scene(gearbox, start_angle=0.2))
    set_time(contacts, 0.0)
    assert press(contacts, *REST, *STILL) == (0.0, 0.0)
    touching = np.count_nonzero(contacts.balls[:, COMPRESSION] > 0)
    assert count_changes(contacts) == touching > 3
    reset_contact(contacts)
    assert count_changes(contacts) == 0
    held = np.flatnonzero(contacts.balls[:, ACTIVE] > 0.5)
    press(contacts, 0.0, 10e-6, *STILL)
    assert np.all(contacts.balls[:, FORCE].ravel()[held] == contacts.balls[:, LAW].ravel()[held])
    assert np.count_nonzero(contacts.balls[:, FORCE]) == held.size


def test_a_ball_touches_where_it_is_compressed_and_without_tension_only_where_it_also_pushes(gearbox, build_scene):
    for law in ("paper", "no_tension"):
        contacts = assemble(build_scene(gearbox, start_angle=0.2, contact_law=law))
        set_time(contacts, 0.0)
        press(contacts, *REST, 0.0, 0.4)
        for ball in range(contacts.balls[0, LAW].size):
            pressed_in = of_ball(contacts.balls, COMPRESSION, ball) > 0
            pushes = of_ball(contacts.balls, LAW, ball) > 0
            expected = pressed_in and (law == "paper" or pushes)
            assert touches(contacts, 0, ball) == expected


@given(start=st.floats(0, 6.28), x=st.floats(-2e-5, 2e-5), y=st.floats(-2e-5, 2e-5), turn=st.floats(-3, 3))
@settings(max_examples=50, deadline=None, derandomize=True)
def test_turning_cage_and_displacement_together_turns_the_force(gearbox, build_scene, start, x, y, turn):
    dry = dataclasses.replace(gearbox, film_damping=0.0)
    cosine, sine = math.cos(turn), math.sin(turn)
    net, balls = pressed(build_scene(dry, start_angle=start), 0.0, (x, y), STILL)
    turned = cosine * x - sine * y, sine * x + cosine * y
    other, same = pressed(build_scene(dry, start_angle=start + turn), 0.0, turned, STILL)
    size = 1e-9 * (np.max(np.abs(balls)) + 1e-3)  # rounding
    assert other == pytest.approx([cosine * net[0] - sine * net[1], sine * net[0] + cosine * net[1]], abs=size)
    assert np.allclose(same, balls, rtol=0, atol=size)
