"""Located changes of contact and forces of single balls, computed again from the states with formulas typed here."""

import dataclasses

import numpy as np
import pytest
from variants import changed

from physics.request import FixedSteps
from physics.simulate import simulate
from physics.trace import Kept

FINE_RATE = 2.0**20
RATE = 65536.0


def ball_angle(scene, time, row, ball):
    """Angle (rad) of balls counted from 1, staggered rows on one cage that does not slip."""
    bearing = scene.rig.bearing
    return scene.cage.mean_speed * time + 2.0 * np.pi * (ball - 1) / bearing.balls + (row - 1) * np.pi / bearing.balls


def tukey_depth(spall, angle):
    """Depth (m) and its derivative to the angle (m/rad) of an outer Tukey spall."""
    arc = (angle - spall.angle + np.pi) % (2.0 * np.pi) - np.pi
    depth, slope = np.full(arc.shape, spall.depth), np.zeros(arc.shape)
    for taper, inside, sign in (
        (spall.entry_taper, arc + spall.extent / 2.0, 1.0),
        (spall.exit_taper, spall.extent / 2.0 - arc, -1.0),
    ):
        on = inside < taper
        depth[on] = spall.depth * (0.5 - 0.5 * np.cos(np.pi * inside[on] / taper))
        slope[on] = sign * spall.depth * 0.5 * np.pi / taper * np.sin(np.pi * inside[on] / taper)
    outside = np.abs(arc) > spall.extent / 2.0
    return np.where(outside, 0.0, depth), np.where(outside, 0.0, slope)


def compression_and_law(scene, state, time, row, ball):
    """Compression (m) of balls at their instants, and what the contact law says if they touch (N)."""
    angle = ball_angle(scene, time, row, ball)
    depth, slope = tukey_depth(scene.spalls[0], angle)
    in_spall = row == scene.spalls[0].row
    dx, dy, vx, vy = (state[..., i] - state[..., i + 2] for i in (0, 1, 6, 7))
    c, s, speed = np.cos(angle), np.sin(angle), scene.cage.mean_speed
    compression = dx * c + dy * s - in_spall * depth - scene.rig.bearing.clearance
    rate = vx * c + vy * s + speed * (dy * c - dx * s) - in_spall * slope * speed
    spring = scene.rig.bearing.load_deflection * np.maximum(compression, 0.0) ** scene.rig.bearing.exponent
    return compression, spring + scene.rig.film_damping * rate


def states_between_samples(trace, time):
    """States (N, 12) at any times: cubic Hermite interpolation of displacements, straight lines for velocities."""
    place = np.minimum((time * trace.rate).astype(int), trace.time.size - 2)
    x = (time * trace.rate - place)[:, None]
    here, there = trace.state[place], trace.state[place + 1]
    blend = 3.0 * x**2 - 2.0 * x**3
    shift = (x**3 - 2.0 * x**2 + x) * here[:, 6:] + (x**3 - x**2) * there[:, 6:]
    displacement = here[:, :6] + blend * (there - here)[:, :6] + shift / trace.rate
    return np.hstack([displacement, here[:, 6:] + x * (there - here)[:, 6:]])


@pytest.fixture(scope="module")
def fine_fan(reference_scene):
    """The fan rig's line spall at a rate that lets states between samples be interpolated."""
    scene = reference_scene("F1", 0.06)
    return scene, simulate(scene, FINE_RATE, FixedSteps(1), keep=Kept(state=True, force=True))


@pytest.fixture(scope="module")
def fine_fan_without_tension(reference_scene):
    scene = dataclasses.replace(reference_scene("F1", 0.06, speed_factor=3.0), contact_law="no_tension")
    return scene, simulate(scene, FINE_RATE, FixedSteps(1), keep=Kept(state=True, force=True))


def test_every_located_change_is_where_the_compression_is_zero(fine_fan):
    scene, trace = fine_fan
    changes = trace.changes
    state = states_between_samples(trace, changes.time)
    compression, _ = compression_and_law(scene, state, changes.time, changes.row, changes.ball)
    assert changes.time.size > 40
    assert np.abs(compression).max() < 1e-12  # m; the interpolation over a microsecond, the balls are pressed 5e-6 m


def test_without_tension_every_change_is_where_compression_or_force_is_zero(fine_fan_without_tension):
    scene, trace = fine_fan_without_tension
    changes = trace.changes
    state = states_between_samples(trace, changes.time)
    compression, law = compression_and_law(scene, state, changes.time, changes.row, changes.ball)
    at_zero_compression = np.abs(compression) < 1e-12  # m, as above
    at_zero_force = np.abs(law) < 1e-3  # N; speeds between samples are interpolated on straight lines
    assert np.all(at_zero_compression | at_zero_force)
    assert at_zero_compression.any()
    assert (~at_zero_compression).any()


@pytest.mark.parametrize("name", ["G1", "F1", "F1s", "F2"])
def test_each_ball_makes_and_loses_contact_in_turn(name, reference_trace):
    trace = reference_trace(name, 0.5)
    changes = trace.changes
    assert np.all(np.diff(changes.time) >= 0.0)
    assert trace.unlocated_changes == 0
    for row in (1, 2):
        for ball in range(1, trace.changes.initial.shape[1] + 1):
            made = changes.made[(changes.row == row) & (changes.ball == ball)]
            states = np.append(changes.initial[row - 1, ball - 1], made)
            assert np.all(states[1:] != states[:-1])


def test_a_balls_force_is_zero_exactly_while_the_log_says_that_it_does_not_touch(fine_fan):
    scene, trace = fine_fan
    for row in (1, 2):
        for ball in range(1, scene.rig.bearing.balls + 1):
            own = (trace.changes.row == row) & (trace.changes.ball == ball)
            states = np.append(trace.changes.initial[row - 1, ball - 1], trace.changes.made[own])
            touches = states[np.searchsorted(trace.changes.time[own], trace.time, side="right")]
            near = np.min(np.abs(trace.time[:, None] - np.append(trace.changes.time[own], -1.0)), axis=1) < 1e-12
            assert np.all((trace.contact_force[:, row - 1, ball - 1] != 0.0) == touches, where=~near)


@pytest.mark.parametrize("law", ["paper", "no_tension"])
def test_forces_are_those_of_the_contact_law(law, fine_fan, fine_fan_without_tension):
    scene, trace = fine_fan if law == "paper" else fine_fan_without_tension
    row, ball = np.meshgrid([1, 2], np.arange(1, scene.rig.bearing.balls + 1), indexing="ij")
    some = slice(None, None, 7)
    time, state = trace.time[some, None, None], trace.state[some, None, None, :]
    compression, expected = compression_and_law(scene, state, time, row, ball)
    touches = compression > 0.0 if law == "paper" else (compression > 0.0) & (expected > 0.0)
    error = np.abs(trace.contact_force[some] - np.where(touches, expected, 0.0))
    assert error.max() < 2e-4  # N: cubic cells of a taper's 48th miss 3e-13 m of its cosine and 1e-6 of its slope
    assert np.median(error) < 1e-12


def test_the_paper_law_pulls_while_a_ball_unloads(reference_scene):
    force = simulate(reference_scene("F1", 0.1), RATE, keep=Kept(force=True)).contact_force
    assert force.min() < -1.0  # N: the film's 150 N s/m at some cm/s


def test_the_no_tension_law_never_pulls(fine_fan_without_tension, reference_scene):
    _, trace = fine_fan_without_tension
    assert trace.contact_force.min() >= 0.0
    assert trace.tension_share == 0.0
    coarse = dataclasses.replace(reference_scene("F1", 0.1), contact_law="no_tension")
    assert simulate(coarse, RATE, keep=Kept(force=True)).contact_force.min() >= 0.0


def test_without_tension_a_ball_that_is_let_go_of_within_a_step_is_seen(reference_scene):
    scene = reference_scene("G1", 0.1, slip_seed=3)
    # One of its losses lasts 1.35 samples, and strides there are longer.
    loose = changed(
        scene,
        rig={"film_damping": 3.45 * scene.rig.film_damping},
        operation={"load": 0.21 * scene.operation.load},
        contact_law="no_tension",
    )
    trace, exact = simulate(loose, 48000.0), simulate(loose, 48000.0, FixedSteps(64))
    assert trace.changes.time.size == exact.changes.time.size == 26
    assert np.sort(trace.changes.time) == pytest.approx(np.sort(exact.changes.time), abs=1e-7)


def test_the_tension_share_is_the_share_of_contact_time_in_which_forces_pull(reference_scene):
    trace = simulate(reference_scene("F1", 0.2), RATE, FixedSteps(1), keep=Kept(force=True))
    in_contact = np.count_nonzero(trace.contact_force)
    assert trace.tension_share == pytest.approx(np.sum(trace.contact_force < 0.0) / in_contact, rel=1e-12)


@pytest.mark.parametrize("name", ["G1s", "G1p", "F1", "F2r"])
def test_strides_know_how_long_forces_pull_between_samples(name, reference_scene):
    scene = reference_scene(name, 0.1)
    strides = simulate(scene, RATE)
    counted = simulate(scene, 32.0 * RATE, FixedSteps(1))  # at every step, 0.5 µs apart
    assert strides.tension_share == pytest.approx(counted.tension_share, rel=0.01)  # some 10 counts a pass


@pytest.mark.parametrize(("rpm", "expected"), [(300.0, 0.006), (2400.0, 0.05)])
def test_on_the_fan_rig_some_ball_pulls_in_under_one_step_in_a_hundred_when_slow_and_in_some_when_fast(
    rpm, expected, reference_scene
):
    """An independent implementation measured 0.6 % of steps at 300 rpm and 5 % at 2400 rpm, without naming the defect.

    Read as: the line spall F1, and the share of samples from 0.1 s on in which the force of at least one ball pulls.
    That gives 0.94 % and 7.2 %; of the reference scenes F1p lies as near, F0 lower when fast, F2 higher when slow.
    """
    scene = reference_scene("F1", 0.5, speed_factor=rpm / 800.0)
    force = simulate(scene, RATE, keep=Kept(force=True)).contact_force[round(0.1 * RATE) :]
    share = np.mean((force < 0.0).any(axis=(1, 2)))
    assert share == pytest.approx(expected, rel=0.7)  # 1.57 and 1.43 times: neither scene nor count is known
