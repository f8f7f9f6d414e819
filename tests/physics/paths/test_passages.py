"""Passages of balls over a point of a spall, against a ball-by-ball search on a fine grid of times."""

import dataclasses
import math

import numpy as np
import pytest
from variants import slipping_cage

from physics.cage import CagePath
from physics.paths.passages import passages
from physics.spall import Spall

RACES = pytest.mark.parametrize("race", ["outer", "inner"])
FINE = 200_001


def searched(scene, spall, arc, start, stop):
    """Times and balls at which a ball's arc from the spall's centre passes `arc`, by walking along a fine grid."""
    bearing, run = scene.rig.bearing, scene.operation
    path = scene.second_cage if spall.row == 2 and scene.second_cage is not None else scene.cage
    time = np.linspace(start, stop, FINE)
    inside = np.clip(time, 0.0, scene.duration)
    cage = path.angle(inside) + path.mean_speed * (time - inside)
    centre = spall.angle + (run.shaft_speed * time if spall.race == "inner" else 0.0)
    found = []
    for ball in range(bearing.balls):
        angle = cage + 2 * math.pi * ball / bearing.balls + (spall.row - 1) * math.pi / bearing.balls
        travelled = (angle - centre) * (1 if spall.race == "outer" else -1)
        turns = (travelled - arc) / (2 * math.pi)
        for k in np.flatnonzero(np.floor(turns[1:]) != np.floor(turns[:-1])):
            share = (math.floor(turns[k + 1]) - turns[k]) / (turns[k + 1] - turns[k])
            found.append((time[k] + share * (time[k + 1] - time[k]), ball + 1))
    return sorted(found)


def agree(scene, index, arc, start, stop):
    expected = searched(scene, scene.spalls[index], arc, start, stop)
    found = passages(scene, index, arc, start, stop)
    assert found.ball.tolist() == [ball for _, ball in expected]
    assert found.time == pytest.approx([time for time, _ in expected], abs=1e-9)  # straight lines over 3.5 µs
    return found


@RACES
@pytest.mark.parametrize("row", [1, 2])
@pytest.mark.parametrize("arc", [0.0, -0.3, 0.2])
def test_passages_over_any_point_are_those_of_a_ball_by_ball_search(gearbox, build_scene, race, row, arc):
    scene = build_scene(gearbox, Spall(race, row, 4.7, 0.7, 1e-5))
    scene = dataclasses.replace(scene, cage=slipping_cage(scene, 1, 0.37))
    assert agree(scene, 0, arc, 0.0, 0.5).time.size > 15


@RACES
def test_each_row_follows_its_own_cage(gearbox, build_scene, race):
    scene = build_scene(gearbox, Spall(race, 1, 4.7, 0.1, 1e-5), Spall(race, 2, 1.7, 0.1, 1e-5))
    scene = dataclasses.replace(scene, cage=slipping_cage(scene, 2, 0.1), second_cage=slipping_cage(scene, 3, -8.0))
    for index in range(2):
        assert agree(scene, index, 0.05, 0.0, 0.5).time.size > 15


@RACES
def test_before_and_after_the_record_the_cage_goes_on_at_its_mean_speed(gearbox, build_scene, race):
    scene = build_scene(gearbox, Spall(race, 1, 4.7, 0.1, 1e-5))
    scene = dataclasses.replace(scene, cage=slipping_cage(scene, 4, 50.0))
    found = agree(scene, 0, -0.05, -0.2, 0.8)
    assert found.time[0] < 0.0
    assert found.time[-1] > 0.5


@RACES
def test_without_slip_a_ball_passes_every_ball_pass_period(gearbox, build_scene, race):
    scene = build_scene(gearbox, Spall(race, 1, 4.7, 0.1, 1e-5))
    found = passages(scene, 0, 0.0, 0.0, 0.5)
    rate = (gearbox.bearing.bpfo if race == "outer" else gearbox.bearing.bpfi) * 7.0
    assert np.allclose(np.diff(found.time) * rate, 1.0, rtol=1e-9)  # rounding
    step = -1 if race == "outer" else 1
    assert np.all(np.diff(found.ball) % 12 == step % 12)
    assert found.ball.dtype == np.int64


def test_balls_are_counted_from_one_and_ball_1_of_row_1_is_at_the_cage_angle(gearbox, build_scene):
    scene = build_scene(gearbox, Spall("outer", 1, 1.0, 0.1, 1e-5))
    found = passages(scene, 0, 0.0, 0.0, 0.5)
    first = found.time[found.ball == 1]
    assert scene.cage.angle(first) == pytest.approx(1.0 + 2 * math.pi * np.arange(first.size), abs=1e-9)
    assert set(found.ball.tolist()) == set(range(1, 13))


def test_an_interval_between_two_passages_holds_none(gearbox, build_scene):
    scene = build_scene(gearbox, Spall("outer", 1, 1.0, 0.1, 1e-5))
    time = passages(scene, 0, 0.0, 0.0, 0.5).time
    between = passages(scene, 0, 0.0, time[3] + 1e-6, time[4] - 1e-6)
    assert between.time.size == between.ball.size == 0


def test_no_ball_passes_where_the_cage_turns_with_the_race_even_if_one_stands_there(gearbox, build_scene):
    """The tenth of twelve balls is at 270 degrees, and so is the centre of the spall."""
    scene = build_scene(gearbox, Spall("inner", 1, 9 * gearbox.bearing.spacing, 0.1, 1e-5))
    locked = dataclasses.replace(scene, cage=CagePath(scene.operation.shaft_speed, scene.duration))
    found = passages(locked, 0, 0.0, 0.0, 0.5)
    assert found.time.size == found.ball.size == 0
