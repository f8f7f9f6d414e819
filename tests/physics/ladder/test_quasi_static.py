"""The quasi-static model: loads and stiffness of statics, and no vibration."""

import dataclasses
import math

import numpy as np
import pytest
from fine_runs import RATE, nonlinear

from physics.ladder.contact_sets import changes_between_samples
from physics.request import Simpler
from physics.rms import rms
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium, require_equilibrium
from physics.statics.stiffness import stiffness_at
from physics.trace import Kept


def test_the_quasi_static_model_has_the_stiffness_and_loads_of_statics_and_no_vibration(reference_scene):
    scene = reference_scene("G1", 0.05)
    trace = simulate(scene, RATE, Simpler("quasi-static"), keep=Kept(state=True, force=True))
    assert np.all(trace.acceleration == 0.0)
    displacement = trace.state[:, 0:2] - trace.state[:, 2:4]
    stiffness = stiffness_at(scene, trace.time, displacement)
    expected = require_equilibrium(scene, trace.time).stiffness
    assert np.allclose(stiffness, expected, rtol=0.0, atol=1e-9 * expected.max())  # what Newton's method leaves
    vertical = -(trace.contact_force * np.sin(ball_angles(scene, trace.time))).sum(axis=(1, 2))
    assert vertical == pytest.approx(scene.operation.load, rel=1e-6)  # the solver's tolerance


def ball_angles(scene, time):
    """Angles (T, rows, balls) of all balls on staggered rows, rad."""
    bearing = scene.rig.bearing
    row, ball = np.arange(bearing.rows)[:, None], np.arange(bearing.balls)
    return scene.cage.angle(time)[:, None, None] + 2.0 * np.pi * ball / bearing.balls + row * np.pi / bearing.balls


def test_the_quasi_static_support_gives_way_to_a_turning_load_and_carries_the_resonator_along(reference_scene):
    scene = reference_scene("G0", 0.1)
    force, load, share, speed = 100.0, scene.operation.load, 0.2, scene.operation.shaft_speed
    turning = {"unbalance_force": force, "load_fluctuation": share, "fluctuation_phase": 0.7}
    along, across = scene.rig.support_stiffness_x, 3.0 * scene.rig.support_stiffness_y
    scene = dataclasses.replace(
        scene,
        rig=dataclasses.replace(scene.rig, support_stiffness_y=across),
        operation=dataclasses.replace(scene.operation, **turning),
    )
    trace = simulate(scene, RATE, Simpler("quasi-static"), keep=Kept(state=True))
    turned = speed * trace.time
    swing = force * np.sin(turned) - load * share * np.cos(turned + 0.7)
    assert trace.acceleration[:, 0] == pytest.approx(-(speed**2) * force / along * np.cos(turned), rel=1e-9)
    assert trace.acceleration[:, 1] == pytest.approx(-(speed**2) * swing / across, abs=1e-12)  # rounding
    assert trace.state[:, 3] == pytest.approx((swing - load) / across, rel=1e-9)
    np.testing.assert_array_equal(trace.state[:, 4:6], trace.state[:, 2:4])  # nothing stretches its spring


def test_quasi_static_ball_loads_along_the_contact_normals_carry_the_load(reference_scene):
    scene, angle = reference_scene("G1", 0.02), 0.4
    bearing = dataclasses.replace(scene.rig.bearing, contact_angle=angle)
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=bearing))
    force = simulate(scene, RATE, Simpler("quasi-static"), keep=Kept(force=True)).contact_force
    vertical = -(force * math.cos(angle) * np.sin(ball_angles(scene, np.arange(force.shape[0]) / RATE))).sum(
        axis=(1, 2)
    )
    assert vertical == pytest.approx(scene.operation.load, rel=1e-6)  # the solver's tolerance


def test_quasi_static_contact_changes_are_those_of_motion_to_a_sample_where_nothing_rings(reference_scene):
    scene = reference_scene("G0", 0.15)
    found, exact = simulate(scene, RATE, Simpler("quasi-static")).changes, nonlinear(scene).changes
    found, exact = ([(c.ball[k], c.row[k], c.time[k]) for k in np.flatnonzero(c.time > 0.05)] for c in (found, exact))
    found, exact = np.array(sorted(found)), np.array(sorted(exact))
    assert np.array_equal(found[:, :2], exact[:, :2])
    assert np.abs(found[:, 2] - exact[:, 2]).max() < 2e-5  # s; a sample lasts 15 µs


def test_the_quasi_static_state_moves_as_the_cage_turns_it(reference_scene):
    """Without slip a position depends on the cage's angle alone: its rate is the cage's speed times the slope there."""
    scene = reference_scene("G0", 0.02)
    trace = simulate(scene, RATE, Simpler("quasi-static"), keep=Kept(state=True))
    velocity = trace.state[:, 6:8] - trace.state[:, 8:10]  # of the inner relative to the outer ring
    turned = 1e-5  # rad
    ahead, behind = (
        equilibrium(dataclasses.replace(scene, cage=dataclasses.replace(scene.cage, start_angle=angle)), trace.time)
        for angle in (scene.cage.start_angle + turned, scene.cage.start_angle - turned)
    )
    expected = (ahead.displacement - behind.displacement) / (2.0 * turned) * scene.cage.mean_speed
    assert rms(expected) > 0.0
    assert rms(velocity[1:-1] - expected[1:-1]) < 0.01 * rms(expected)


def test_contact_changes_between_samples_lie_half_way():
    touching = np.zeros((3, 1, 2), dtype=bool)
    touching[1:, 0, 1] = True
    changes = changes_between_samples(touching, np.array([0, 2, 3]), 10.0)
    assert changes.time.tolist() == [0.15]  # samples at 0.1 and 0.2 s
    assert (changes.row.tolist(), changes.ball.tolist(), changes.made.tolist()) == ([1], [2], [True])
    assert not changes.initial.any()


def test_quasi_static_positions_are_the_same_whether_forces_are_kept_too_or_not(reference_scene):
    scene, model = reference_scene("G1", 0.05), Simpler("quasi-static")
    alone, both = (simulate(scene, RATE, model, keep=Kept(state=True, force=force)) for force in (False, True))
    np.testing.assert_array_equal(alone.state, both.state)
