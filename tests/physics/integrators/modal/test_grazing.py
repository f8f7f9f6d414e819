"""Balls that touch, or let go, between the ends of a step."""

import dataclasses
import math

import numpy as np
import pytest
from kernels import (
    has_relief,
    mark_grazing,
    note_motion,
    press,
    reset_contact,
    set_time,
    touches,
)

from physics.assembly import assemble
from physics.cage import CagePath
from physics.contact.forces import ACTIVE, COMPRESSION
from physics.imperfections import Imperfections, Waviness
from physics.paths.profile import build_path
from physics.request import Accurate, FixedSteps
from physics.rms import rms
from physics.simulate import simulate

RATE = 65536.0


@pytest.mark.parametrize("load", [20.0, 60.0])
def test_a_touch_of_a_rough_spall_shorter_than_a_step_is_not_passed_over(load, reference_scene):
    scene = reference_scene("F2r", 0.06)
    operation = dataclasses.replace(scene.operation, load=load, shaft_speed=4.0 * scene.operation.shaft_speed)
    cage = dataclasses.replace(scene.cage, nominal_speed=4.0 * scene.cage.nominal_speed)
    scene = dataclasses.replace(scene, operation=operation, cage=cage, contact_law="no_tension")
    trace, fine = simulate(scene, RATE), simulate(scene, RATE, FixedSteps(32))
    assert trace.changes.time.size == fine.changes.time.size
    assert rms(trace.acceleration - fine.acceleration) < 1e-3 * rms(fine.acceleration)


@pytest.mark.parametrize(("name", "speed", "load"), [("F1s", 3.0, 0.3), ("F2r", 1.0, 3.0)])
def test_a_ball_that_changes_sides_and_back_within_a_step_is_not_passed_over(name, speed, load, reference_scene):
    scene = reference_scene(name, 0.1, speed_factor=speed)
    scene = dataclasses.replace(scene, operation=dataclasses.replace(scene.operation, load=load * scene.operation.load))
    found = simulate(scene, RATE, Accurate(repeat=False)).changes
    fine = simulate(scene, RATE, FixedSteps(32)).changes
    assert found.time.size == fine.time.size
    here, there = (np.lexsort((changes.time, changes.ball, changes.row)) for changes in (found, fine))
    assert np.array_equal(found.ball[here], fine.ball[there])
    assert np.abs(found.time[here] - fine.time[there]).max() < 0.1 / RATE  # of changes, not of their pairs


@pytest.mark.slow
def test_the_crest_of_a_wave_shorter_than_a_sample_is_not_passed_over(fan, build_scene):
    speed = 20000.0 * math.pi / 30.0
    operation, waves = {"shaft_speed": speed, "load": 100.0}, (Waviness("inner", 500, 1e-6),)
    cage = CagePath(nominal_speed=fan.bearing.cage_speed(speed), duration=0.05)
    scene = build_scene(fan, operation=operation, cage=cage, imperfections=Imperfections(waves))
    trace, fine = simulate(scene, RATE), simulate(scene, RATE, FixedSteps(32, "dormand_prince"))
    assert rms(trace.acceleration - fine.acceleration) < 1e-3 * rms(fine.acceleration)


def test_a_ball_that_touches_between_two_looks_at_a_rough_path_is_seen(reference_scene):
    scene = reference_scene("F2r", 0.2)
    spall, bearing, step = scene.spalls[0], scene.rig.bearing, 1.0 / RATE
    contacts, generator = assemble(scene), np.random.default_rng(1)
    noted, suspects = np.zeros((1, 2, contacts.balls.shape[2])), np.zeros((1, contacts.balls.shape[2]))
    shares, tried = np.linspace(0.0, 1.0, 65), 0

    def compression(share, across, ball):
        set_time(contacts, begin + share * step)
        press(contacts, 0.0, across, 0.0, 0.0)
        return contacts.balls[0, COMPRESSION, ball]

    while tried < 60:
        begin = generator.uniform(0.0, 0.19)
        angles = scene.cage.angle(np.array([begin])) + bearing.spacing * np.arange(bearing.balls) - spall.angle
        inside = np.abs((angles + np.pi) % (2.0 * np.pi) - np.pi) < 0.45 * spall.extent
        if not inside.any():
            continue
        ball = int(inside.argmax())
        course = np.array([compression(share, -1e-5, ball) for share in shares])
        top, ends = course[1:-1].max(), max(course[0], course[-1])
        if top <= ends:
            continue
        # The rings are moved until the ball is apart at both ends of the step and touches for an instant on the way.
        lift = generator.uniform(0.05, 0.5) * (top - ends)
        summit = shares[1 + course[1:-1].argmax()]
        yielding = (compression(summit, -1.01e-5, ball) - compression(summit, -1e-5, ball)) / -1e-7
        across = -1e-5 + (lift - top) / yielding
        apart = compression(0.0, across, ball) <= 0.0
        reset_contact(contacts)
        note_motion(contacts.balls, noted)
        if not apart or compression(1.0, across, ball) > 0.0:
            continue
        suspects[:] = 0.0
        mark_grazing(contacts, noted, begin, step, suspects)
        assert 0.0 < suspects[0, ball] < 1.0
        tried += 1


def test_a_ball_that_is_pressed_all_at_once_at_a_corner_of_its_path_is_seen_there(reference_scene):
    scene = reference_scene("F2r", 0.2)
    rolled = dataclasses.replace(scene.spalls[0], profile="ball_path", depth=20e-6)
    scene, step = dataclasses.replace(scene, spalls=(rolled,), contact_law="no_tension"), 1.0 / RATE
    bearing, path, contacts = scene.rig.bearing, build_path(rolled, scene.rig.bearing), assemble(scene)
    noted, suspects = np.zeros((1, 2, contacts.balls.shape[2])), np.zeros((1, contacts.balls.shape[2]))
    speed, generator, tried, compressed = scene.cage.mean_speed, np.random.default_rng(2), 0, 1e-8

    def pressed(time, across, falling, ball):
        set_time(contacts, time)
        press(contacts, 0.0, across, 0.0, falling)
        return touches(contacts, 0, ball)

    for corner in path.breaks[1:-1][np.abs(path.breaks[1:-1]) < 0.2]:
        ball, share = int(generator.integers(bearing.balls)), generator.uniform(0.05, 0.2)
        met = (rolled.angle + corner - bearing.spacing * ball) % (2.0 * np.pi) / speed
        if met > 0.19:
            continue
        before, behind = path.slope(corner + np.array([-1e-9, 1e-9]))
        # The ring leaves the ball so fast that the film just lets go of it before the corner, and presses it behind.
        spring = contacts.law.stiffness * compressed**bearing.exponent
        rate = -spring / contacts.law.damping + speed * (before + behind) / 2.0
        sine = np.sin(rolled.angle + corner)
        drop = path.depth(np.array([corner]))[0]
        across, falling, begin = (compressed + drop + bearing.clearance) / sine, rate / sine, met - share * step
        shares = np.linspace(0.0, 1.0, 2001)
        seen = [pressed(begin + s * step, across + (s - share) * step * falling, falling, ball) for s in shares]
        if not any(seen) or abs(shares[np.argmax(seen)] - share) > 1e-3:
            continue
        pressed(begin, across - share * step * falling, falling, ball)
        contacts.balls[:, ACTIVE] = 0.0
        note_motion(contacts.balls, noted)
        pressed(begin + step, across + (1.0 - share) * step * falling, falling, ball)
        suspects[:] = 0.0
        mark_grazing(contacts, noted, begin, step, suspects)
        assert suspects[0, ball] == pytest.approx(share, abs=1e-3)
        tried += 1
    assert tried > 10


def test_the_relief_of_a_path_bounds_how_far_it_strays_from_any_chord(reference_scene):
    scene = reference_scene("F2r", 0.01)
    path = build_path(scene.spalls[0], scene.rig.bearing)
    generator = np.random.default_rng(8)
    for level in range(path.relief.size - 1):
        width = path.cell * 2**level
        left = generator.uniform(path.breaks[0], path.breaks[-1] - width, 200)
        share = np.linspace(0.0, 1.0, 33)
        depth = path.depth((left[:, None] + share * width).ravel()).reshape(200, 33)
        chord = depth[:, :1] + share * (depth[:, -1:] - depth[:, :1])
        assert np.abs(depth - chord).max() <= 1.1 * path.relief[level]  # the bound sums what grid points stray
    assert np.all(np.diff(path.relief) >= 0.0)


def test_a_smooth_path_has_no_relief_and_is_not_searched(reference_scene):
    scene = reference_scene("G2", 0.01)
    assert not build_path(scene.spalls[0], scene.rig.bearing).relief.any()
    assert not has_relief(assemble(scene).track)
    assert has_relief(assemble(reference_scene("G2r", 0.01)).track)
