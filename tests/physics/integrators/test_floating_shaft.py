"""A shaft that floats in a wide clearance, without any static load, moves as closed forms say, by every method."""

import math

import numpy as np
import pytest
from variants import changed

from physics.cage import CagePath
from physics.integrators.method_table import MARCHES, METHODS
from physics.integrators.output import Grid
from physics.reference_scenes import reference_scene
from physics.response.single_march import respond, respond_by_reference
from physics.spall import Spall
from physics.trace import Kept

CLEARANCE = 1e-4
STEP = 3e-5
TURN = 300.0  # rad/s, of the shaft
SAMPLES = 400
BOTTOM = math.radians(270.0)


def floating(**changes):
    return changed(reference_scene("F0", SAMPLES * STEP), bearing={"clearance": CLEARANCE}, **changes)


def start_at(place, speed=(0.0, 0.0)):
    start = np.zeros(12)
    start[:2], start[6:8] = place, speed
    return start


def circle():
    """A scene whose unbalance turns, the path of the shaft's centre (T, 2) that it makes, and its radius (m)."""
    scene = floating(operation={"load": 0.0, "shaft_speed": TURN, "unbalance_force": 3.0, "unbalance_phase": 0.7})
    radius = 3.0 / (scene.rig.inner_mass * TURN**2)
    angle = TURN * STEP * np.arange(SAMPLES) + 0.7
    return scene, -radius * np.column_stack([np.cos(angle), np.sin(angle)]), radius


def start_of_circle(path, radius):
    return start_at(path[0], radius * TURN * np.array([math.sin(0.7), -math.cos(0.7)]))


@pytest.mark.parametrize("method", MARCHES)
def test_under_an_unbalance_alone_the_shaft_goes_round_in_a_circle(method):
    scene, path, radius = circle()
    trace = respond(scene, start_of_circle(path, radius), Grid(SAMPLES, 1, STEP), method, Kept(state=True))
    assert radius < 0.5 * CLEARANCE
    assert trace.changes.time.size == 0
    # The error of a method of order p is some share of the turn per step to the power of p; here 0.15 or less.
    assert np.abs(trace.state[:, :2] - path).max() < radius * (TURN * STEP) ** METHODS[method].order


def test_under_an_unbalance_alone_the_reference_goes_round_in_a_circle():
    scene, path, radius = circle()
    trace = respond_by_reference(scene, start_of_circle(path, radius), 1.0 / STEP, SAMPLES, keep_state=True)
    assert np.abs(trace.state[:, :2] - path).max() < 1e-7 * radius  # a relative tolerance of 1e-9 a step


@pytest.mark.parametrize("method", MARCHES)
def test_a_ball_that_rolls_over_a_lip_within_one_step_touches_the_shaft_as_long_as_its_circle_says(method):
    passed, overlap = 20.5 * STEP, 5e-9
    lip = {"table_angle": (-0.01, -0.001, 0.0, 0.001, 0.01), "table_depth": (0.0, 0.0, -3e-6, 0.0, 0.0)}
    scene = floating(operation={"load": 0.0}, spalls=(Spall("outer", 1, BOTTOM, 0.02, 3e-6, profile="table", **lip),))
    speed, bearing = scene.cage.mean_speed, scene.rig.bearing
    scene = changed(scene, cage=CagePath(speed, SAMPLES * STEP, BOTTOM - speed * passed))
    start = start_at((0.0, -(CLEARANCE - 3e-6) - overlap))
    changes = respond(scene, start, Grid(41, 1, STEP), method).changes
    # A ball on a point of the outer race rises from it by the square of the angle, until the overlap is used up.
    ball, race = bearing.ball_diameter / 2.0, (bearing.pitch_diameter + bearing.ball_diameter) / 2.0
    half = math.sqrt(2.0 * overlap / (race**2 / ball - race)) / speed
    assert half < 0.26 * STEP
    assert list(zip(changes.row, changes.ball, changes.made, strict=True)) == [(1, 1, True), (1, 1, False)]
    assert changes.time == pytest.approx([passed - half, passed + half], abs=1e-3 * half)  # the lip pushes the shaft
