"""The impulse train: its steps of force, what they ring, and its contact changes."""

import dataclasses
import math

import numpy as np
import pytest
from fine_runs import RATE, nonlinear
from scipy.integrate import solve_ivp

from physics.imperfections import Imperfections
from physics.ladder.impulse_train import edges_around, edges_within, impulse_response
from physics.modes import coupled_matrix, coupled_resonator_frequency, rated_matrices
from physics.paths.passages import passages
from physics.paths.profile import race_depth
from physics.request import Simpler
from physics.rms import rms
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium
from physics.statics.stiffness import symmetric_matrices


def edges_of(scene):
    return edges_within(edges_around(scene), scene.duration)


def test_a_healthy_bearing_makes_no_impulses(reference_scene):
    assert np.all(simulate(reference_scene("G0", 0.05), RATE, Simpler("impulse train")).acceleration == 0.0)


def test_impulses_start_when_the_cage_says_slip_included(reference_scene):
    scene = reference_scene("F1", 0.3, slip_seed=5)
    trace, edges = simulate(scene, RATE, Simpler("impulse train")), edges_of(scene)
    entries = edges.change < 0.0
    half = scene.spalls[0].extent / 2.0
    expected = passages(scene, 0, -half, 0.0, scene.duration).time[: entries.sum()]
    assert (edges.time - 0.5 * edges.ramp)[entries] == pytest.approx(expected, abs=1e-12)
    first = round(edges.time[0] * RATE)
    assert np.all(trace.acceleration[: first - 1] == 0.0)
    assert np.abs(trace.acceleration[first + 1 : first + 40]).max() > 1e-3


def test_impulses_ring_at_the_coupled_resonator_and_decay(reference_scene):
    scene = reference_scene("F1", 0.3)
    sharp = dataclasses.replace(scene.spalls[0], entry_taper=0.0, exit_taper=0.0)  # tapers blunt the steps
    scene = dataclasses.replace(scene, spalls=(sharp,))
    trace = simulate(scene, RATE, Simpler("impulse train"))
    spectrum = np.abs(np.fft.rfft(trace.acceleration[:, 1] * np.hanning(trace.time.size)))
    frequency = np.fft.rfftfreq(trace.time.size, 1.0 / RATE)
    above = frequency > 5000.0
    expected = coupled_resonator_frequency(scene.rig, rated_matrices(scene.rig)[0])
    # The steps of entry and exit, 1.3 ms apart, interfere: a comb of 770 Hz lies over the mode.
    assert frequency[above][spectrum[above].argmax()] == pytest.approx(expected, abs=385.0)


@pytest.mark.parametrize(("name", "share"), [("G1", 0.0), ("F1", 0.0), ("F1", 0.6)])
def test_between_its_steps_the_impulse_train_is_the_rigs_own_equation_of_motion_under_their_forces(
    name, share, reference_scene
):
    scene, angle = reference_scene(name, 0.03), 0.5
    rig = dataclasses.replace(scene.rig, bearing=dataclasses.replace(scene.rig.bearing, contact_angle=angle))
    if share > 0.0:  # of the resonator's critical damping
        critical = 2.0 * math.sqrt(rig.resonator_stiffness * rig.resonator_mass)
        rig = dataclasses.replace(rig, resonator_damping=share * critical)
    # Deep, so that all load is lost, and beside the load's direction, so that both axes are moved.
    aside = {"angle": 4.5, "extent": 0.1, "depth": 1e-4, "entry_taper": 0.02, "exit_taper": 0.02}
    scene = dataclasses.replace(scene, rig=rig, spalls=(dataclasses.replace(scene.spalls[0], **aside),))
    edges, rest = edges_of(scene), equilibrium(dataclasses.replace(scene, spalls=()), np.linspace(0.0, 0.03, 1001))
    spring = coupled_matrix(rig.stiffness_matrix(), symmetric_matrices(rest.stiffness.mean(axis=0)))
    damper = coupled_matrix(rig.damping_matrix(), symmetric_matrices(rest.damping.mean(axis=0)))
    mass = np.diag(rig.mass_matrix())

    def accelerations(time, state):
        done = np.clip((time - edges.time) / edges.ramp + 0.5, 0.0, 1.0)
        pushed = edges.change * math.cos(angle) * (0.5 - 0.5 * np.cos(np.pi * done))
        along = np.array([pushed @ np.cos(edges.angle), pushed @ np.sin(edges.angle)])
        push = np.concatenate([-along, along, np.zeros(2)])  # a ball presses the outer ring outwards, the shaft back
        return (push - spring @ state[:6] - damper @ state[6:]) / mass

    trace, asked = impulse_response(scene, RATE), {"method": "DOP853", "max_step": 2e-5, "rtol": 1e-8, "atol": 1e-14}
    motion = solve_ivp(
        lambda time, state: np.concatenate([state[6:], accelerations(time, state)]),
        (0.0, 0.03),
        np.zeros(12),
        t_eval=trace.time,
        **asked,
    )
    expected = np.array([accelerations(*at)[4:6] for at in zip(motion.t, motion.y.T, strict=True)])
    between = ~(np.abs(trace.time[:, None] - edges.time) <= 0.5 * edges.ramp).any(axis=1)
    assert edges.unloads[:2].all()
    # Measured 0.003, under strong damping 0.012: modes have dampings of their own, and the means of stiffness and
    # damping are of other instants.
    assert rms(trace.acceleration[between] - expected[between]) < 0.02 * rms(expected[between])
    assert min(rms(expected[between, axis]) for axis in (0, 1)) > 0.1 * rms(expected[between])


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_ball_is_released_where_it_has_sunk_by_what_it_was_pressed_together_and_back_where_it_rises(
    race, reference_scene
):
    scene = reference_scene("G1p", 1.0)
    scene = dataclasses.replace(scene, spalls=(dataclasses.replace(scene.spalls[0], race=race),))
    changes, spall, bearing = impulse_response(scene, RATE).changes, scene.spalls[0], scene.rig.bearing
    assert changes.made.sum() > 5
    assert (~changes.made).sum() > 5
    angle = scene.cage.angle(changes.time) + bearing.spacing * (changes.ball - 1)
    depth = race_depth(scene, 1, angle - scene.race_speed(race) * changes.time)
    pressed = equilibrium(dataclasses.replace(scene, spalls=()), changes.time).displacement
    pressed = pressed[:, 0] * np.cos(angle) + pressed[:, 1] * np.sin(angle) - bearing.clearance
    assert spall.depth > 2.0 * pressed.max()
    assert depth == pytest.approx(pressed, rel=0.02, abs=3e-8)  # its load is that at the edge, half a degree away


@pytest.mark.parametrize("name", ["G1", "G1s", "G1p", "G2", "F1", "F1s", "F1p", "F2"])
@pytest.mark.parametrize("taper", [None, 0.02])
def test_the_impulse_train_has_the_size_of_the_nonlinear_response(name, taper, reference_scene):
    scene = reference_scene(name, 0.15)
    if taper is not None:  # so long that a ball is released in the first part of it
        changes = {"extent": 0.05, "depth": 60e-6, "entry_taper": taper, "exit_taper": taper}
        scene = dataclasses.replace(scene, spalls=(dataclasses.replace(scene.spalls[0], **changes),))
    ratio = rms(simulate(scene, RATE, Simpler("impulse train")).acceleration) / rms(nonlinear(scene).acceleration)
    assert 0.5 < ratio < 2.0  # within 6 dB, as the model states


@pytest.mark.parametrize(
    ("angle", "fluctuation", "clearance"),
    [(0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.6, 0.0, 0.0), (0.0, 0.8, 0.0), (0.3, 0.0, 5e-6)],
)
def test_an_edge_takes_off_the_load_that_the_ball_carries(angle, fluctuation, clearance, reference_scene):
    scene = reference_scene("G1s", 0.05)
    bearing = dataclasses.replace(scene.rig.bearing, contact_angle=angle, clearance=clearance)
    deep = dataclasses.replace(scene.spalls[0], depth=1e-4, entry_taper=0.0, exit_taper=0.0)
    run = dataclasses.replace(scene.operation, load_fluctuation=fluctuation, fluctuation_phase=math.pi)
    machine = dataclasses.replace(scene.rig, bearing=bearing)
    scene = dataclasses.replace(scene, rig=machine, operation=run, spalls=(deep,))
    sound = dataclasses.replace(scene, spalls=())
    edges = edges_of(scene)
    carried = equilibrium(sound, edges.time).ball_load[np.arange(edges.time.size), edges.row - 1, edges.ball - 1]
    assert edges.unloads.any()
    assert np.abs(edges.change[edges.unloads]) == pytest.approx(carried[edges.unloads], rel=1e-9)


def test_an_edge_of_a_shallow_spall_leaves_the_ball_what_its_law_gives_for_the_rest_of_its_compression(reference_scene):
    scene, depth, angle = reference_scene("G1", 0.1), 2e-6, 0.4
    bearing = dataclasses.replace(scene.rig.bearing, contact_angle=angle)
    shallow = dataclasses.replace(scene.spalls[0], depth=depth, entry_taper=0.0, exit_taper=0.0)
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=bearing), spalls=(shallow,))
    edges = edges_of(scene)
    carried = equilibrium(dataclasses.replace(scene, spalls=()), edges.time).ball_load
    carried = carried[np.arange(edges.time.size), edges.row - 1, edges.ball - 1]
    pressed = (carried / bearing.load_deflection) ** (1.0 / 1.5)  # along the contact normal
    left = bearing.load_deflection * (pressed - depth * math.cos(angle)) ** 1.5
    assert pressed.min() > 2.0 * depth
    assert np.abs(edges.change) == pytest.approx(carried - left, rel=1e-9)  # rounding
    assert not edges.unloads.any()


def test_a_narrow_gap_takes_off_what_a_ball_that_touches_both_lips_loses_however_deep_it_is(reference_scene):
    scene, half = reference_scene("G1", 0.1), 0.004
    gap = dataclasses.replace(
        scene.spalls[0], profile="ball_path", extent=2.0 * half, depth=1e-4, entry_taper=0.0, exit_taper=0.0
    )
    edges, bearing = edges_of(dataclasses.replace(scene, spalls=(gap,))), scene.rig.bearing
    race, ball = bearing.raceway_radius("outer"), bearing.ball_radius
    sunk = race * math.cos(half) - math.sqrt(ball**2 - (race * math.sin(half)) ** 2) - (race - ball)
    carried = equilibrium(dataclasses.replace(scene, spalls=()), edges.time).ball_load
    pressed = (carried[np.arange(edges.time.size), edges.row - 1, edges.ball - 1] / bearing.load_deflection) ** (2 / 3)
    left = bearing.load_deflection * np.maximum(pressed - sunk, 0.0) ** 1.5
    assert pressed.min() > sunk
    assert np.abs(edges.change) == pytest.approx(bearing.load_deflection * pressed**1.5 - left, rel=1e-2)
    assert not edges.unloads.any()


@pytest.mark.parametrize(("entry", "exit"), [(0.001, 0.02), (0.02, 0.001)])
def test_a_ball_sinks_and_rises_as_long_as_the_taper_of_that_edge_takes(entry, exit, reference_scene):
    scene, depth = reference_scene("G1", 0.1), 60e-6
    spall = dataclasses.replace(scene.spalls[0], extent=0.05, depth=depth, entry_taper=entry, exit_taper=exit)
    edges = edges_of(dataclasses.replace(scene, spalls=(spall,)))
    pressed = (np.abs(edges.change) / scene.rig.bearing.load_deflection) ** (2.0 / 3.0)
    # A taper goes down as (1 − cos πs) / 2 of the depth, s being the share of it.
    share = np.arccos(1.0 - 2.0 * pressed / depth) / np.pi
    expected = share * np.where(edges.change < 0.0, entry, exit) / scene.crossing_speed(spall)
    assert edges.unloads.all()
    assert edges.ramp == pytest.approx(expected, rel=5e-3)  # straight lines between 97 points of a taper


def test_a_spall_that_turns_with_the_cage_makes_no_impulses(reference_scene):
    scene = reference_scene("F1", 0.05)
    inner = dataclasses.replace(scene.spalls[0], race="inner")
    dragged = dataclasses.replace(scene.cage, nominal_speed=scene.operation.shaft_speed)
    scene = dataclasses.replace(scene, spalls=(inner,), cage=dragged)
    assert edges_of(scene).time.size == 0
    assert np.all(impulse_response(scene, RATE).acceleration == 0.0)


def test_impulses_of_an_inner_spall_are_modulated_by_the_load_zone(reference_scene):
    scene = reference_scene("G1", 0.5)
    inner = dataclasses.replace(scene, spalls=(dataclasses.replace(scene.spalls[0], race="inner"),))
    trace = impulse_response(inner, RATE)
    envelope = np.abs(trace.acceleration[:, 1]).reshape(-1, 256).max(axis=1)
    turn = 2.0 * np.pi / scene.operation.shaft_speed
    phase = (np.arange(envelope.size) * 256 / RATE) % turn / turn
    down, up = np.abs(phase - 0.5) > 0.3, np.abs(phase - 0.5) < 0.2
    assert envelope[down].max() > 5.0 * envelope[up].max()  # the spall is at the bottom at t = 0


def over_long_tapers(scene):
    """The scene without slip, its spall with tapers over which a ball sinks and rises for a while."""
    spall = dataclasses.replace(scene.spalls[0], extent=0.05, depth=60e-6, entry_taper=0.02, exit_taper=0.02)
    return dataclasses.replace(scene, spalls=(spall,))


@pytest.mark.parametrize("sign", [-1.0, 1.0], ids=["entry", "exit"])
def test_a_record_that_begins_while_a_ball_sinks_or_rises_has_the_edges_of_a_longer_one(sign, reference_scene):
    scene = over_long_tapers(reference_scene("G1", 0.2))
    edges = edges_of(scene)
    k = np.flatnonzero(edges.unloads & (sign * edges.change > 0.0))[1]
    for share in (-0.25, 0.25):
        begins = edges.time[k] + share * edges.ramp[k]
        left = scene.duration - begins
        cage = dataclasses.replace(scene.cage, start_angle=float(scene.cage.angle(begins)), duration=left)
        later, seen = edges_of(dataclasses.replace(scene, cage=cage)), edges.time >= begins
        assert later.time == pytest.approx(edges.time[seen] - begins, abs=1e-9)
        assert later.change == pytest.approx(edges.change[seen], rel=1e-6)


def test_no_change_of_contact_lies_outside_the_record(reference_scene):
    scene = over_long_tapers(reference_scene("G1", 0.2))
    edges = edges_of(scene)
    k = np.flatnonzero(edges.unloads & (edges.change < 0.0))[1]
    # A ball is let go of half a ramp behind the middle of the step of its force: here the record ends between them.
    for share, more in ((0.4, 0), (0.6, 1)):
        cage = dataclasses.replace(scene.cage, duration=float(edges.time[k] + share * edges.ramp[k]))
        changes = impulse_response(dataclasses.replace(scene, cage=cage), RATE).changes
        assert changes.time.max() < cage.duration
        before = edges.unloads & (edges.time - 0.5 * np.sign(edges.change) * edges.ramp >= 0.0)
        assert changes.time.size == np.count_nonzero(before[:k]) + more


def test_modes_above_half_the_rate_are_no_part_of_the_impulse_train(reference_scene):
    scene = reference_scene("G1", 0.2)
    fastest = coupled_resonator_frequency(scene.rig, rated_matrices(scene.rig)[0])
    assert RATE / 8.0 < fastest < RATE / 4.0  # 10.5 kHz, so that it would fold to 5.8 kHz
    all_modes, below = (impulse_response(scene, rate).acceleration[:, 1] for rate in (RATE, RATE / 4.0))
    missing = np.abs(np.fft.rfft(all_modes[::4] - below))
    frequency = np.fft.rfftfreq(below.size, 4.0 / RATE)
    assert frequency[np.argmax(missing)] == pytest.approx(RATE / 4.0 - fastest, rel=0.02)
    assert rms(all_modes[::4] - below) > 0.01 * rms(all_modes)


def test_modes_that_creep_back_under_a_strong_film_are_left_out_of_the_impulse_train(reference_scene):
    scene = reference_scene("G1", 0.1)
    strong = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, film_damping=1e5))
    acceleration = impulse_response(strong, RATE).acceleration
    assert np.isfinite(acceleration).all()
    assert acceleration.any()


@pytest.mark.parametrize("row", [1, 2])
def test_the_ball_at_an_edge_stands_at_the_spall_in_either_row(row, reference_scene):
    scene = reference_scene("G1", 0.1)
    spall = dataclasses.replace(scene.spalls[0], row=row)
    edges = edges_of(dataclasses.replace(scene, spalls=(spall,)))
    assert (edges.row == row).all()
    away = np.angle(np.exp(1j * (edges.angle - spall.angle)))
    assert edges.time.size > 5
    assert np.abs(away).max() < spall.extent < scene.rig.bearing.stagger / 2.0


def test_edges_of_several_spalls_are_those_of_each_in_the_order_of_time(reference_scene):
    scene = reference_scene("F1", 0.2)
    one = scene.spalls[0]
    other = dataclasses.replace(one, angle=one.angle + 0.4, depth=0.5 * one.depth)
    both, *each = (edges_of(dataclasses.replace(scene, spalls=spalls)) for spalls in ((one, other), (one,), (other,)))
    time, change = (np.concatenate([getattr(edges, name) for edges in each]) for name in ("time", "change"))
    order = np.argsort(time)
    assert not np.allclose(each[0].time[:4], each[1].time[:4], rtol=0.0, atol=1e-3)
    np.testing.assert_array_equal(both.time, time[order])
    np.testing.assert_array_equal(both.change, change[order])


def test_an_edge_takes_off_the_load_of_a_roller_by_its_own_law(reference_scene):
    scene = reference_scene("G1s", 0.05)
    bearing = dataclasses.replace(scene.rig.bearing, exponent=10.0 / 9.0, load_deflection=1e8)
    deep = dataclasses.replace(scene.spalls[0], depth=1e-4, entry_taper=0.0, exit_taper=0.0)
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=bearing), spalls=(deep,))
    edges = edges_of(scene)
    carried = equilibrium(dataclasses.replace(scene, spalls=()), edges.time).ball_load
    carried = carried[np.arange(edges.time.size), edges.row - 1, edges.ball - 1]
    assert edges.unloads.any()
    assert np.abs(edges.change[edges.unloads]) == pytest.approx(carried[edges.unloads], rel=1e-9)


def test_imperfections_of_balls_are_no_part_of_the_impulse_train(reference_scene):
    scene = reference_scene("G1", 0.05)
    unequal = Imperfections(ball_deviation=((1e-6, *(0.0,) * 11), (0.0,) * 12))
    sound, uneven = (
        impulse_response(each, RATE) for each in (scene, dataclasses.replace(scene, imperfections=unequal))
    )
    np.testing.assert_array_equal(uneven.acceleration, sound.acceleration)
    assert sound.acceleration.any()


def test_no_change_of_contact_lies_before_the_record(reference_scene):
    scene = over_long_tapers(reference_scene("G1", 0.2))
    edges = edges_of(scene)
    k = np.flatnonzero(edges.unloads & (edges.change > 0.0))[1]
    # A ball is touched again half a ramp before the middle of the step of its force: here the record begins between.
    begins = edges.time[k] - 0.25 * edges.ramp[k]
    cage = dataclasses.replace(
        scene.cage, start_angle=float(scene.cage.angle(begins)), duration=float(scene.duration - begins)
    )
    later = dataclasses.replace(scene, cage=cage)
    assert edges_of(later).time[0] == pytest.approx(0.25 * edges.ramp[k], abs=1e-9)
    assert impulse_response(later, RATE).changes.time.min() >= 0.0


def test_a_ball_that_stands_in_a_spall_at_first_does_not_touch(reference_scene):
    scene = reference_scene("G1", 0.05)
    spall = dataclasses.replace(scene.spalls[0], extent=0.35, depth=1e-4)
    # A ball in its middle, for longer than the record lasts.
    cage = dataclasses.replace(scene.cage, start_angle=spall.angle, duration=1e-3)
    scene = dataclasses.replace(scene, cage=cage, spalls=(spall,))
    initial = impulse_response(scene, RATE).changes.initial
    assert not initial[0, 0]
    assert initial.sum() == initial.size - 1
    assert not simulate(scene, RATE, Simpler("quasi-static")).changes.initial[0, 0]


def test_every_change_of_contact_of_the_impulse_train_changes_something(reference_scene):
    scene = reference_scene("G1", 0.2)
    for begins in np.linspace(0.0, 0.02, 41):  # also within passes
        cage = dataclasses.replace(scene.cage, start_angle=float(scene.cage.angle(begins)))
        changes = impulse_response(dataclasses.replace(scene, cage=cage), RATE).changes
        touching = changes.initial.copy()
        for row, ball, made in zip(changes.row - 1, changes.ball - 1, changes.made, strict=True):
            assert touching[row, ball] != made
            touching[row, ball] = made


def test_a_change_of_contact_before_the_end_is_logged_though_the_middle_of_its_step_lies_behind_it(reference_scene):
    scene = over_long_tapers(reference_scene("G1", 0.2))
    edges = edges_of(scene)
    k = np.flatnonzero(edges.unloads & (edges.change > 0.0))[1]
    begins = float(edges.time[k] - 0.5 * edges.ramp[k])
    cage = dataclasses.replace(scene.cage, duration=begins + 0.25 * float(edges.ramp[k]))
    changes = impulse_response(dataclasses.replace(scene, cage=cage), RATE).changes
    assert changes.time[-1] == pytest.approx(begins, abs=1e-9)
    assert (changes.row[-1], changes.ball[-1], changes.made[-1]) == (edges.row[k], edges.ball[k], True)
