"""Scenes that the equations of motion cannot tell apart: their responses are the same, or turned, or scaled."""

import dataclasses
import math

import numpy as np
import pytest
from variants import changed

from physics.imperfections import Imperfections, Waviness
from physics.request import LeadIn
from physics.rms import rms
from physics.simulate import simulate

RATE = 65536.0
ROUNDING = 1e-6  # of the RMS: round-off decides which of two balls that change sides at one instant goes first
ACCURACY = 1e-3  # of the RMS: what `simulate` keeps where the two take different steps
CONTACT_ANGLE = math.radians(25.0)
DEVIATIONS = tuple(map(tuple, np.random.default_rng(3).normal(0.0, 5e-7, (2, 12))))  # m, of the gearbox rig's balls


def apart(one, other, rate=RATE, **options):
    """How far the responses of two scenes are apart, over the RMS of the other."""
    here, there = (simulate(scene, rate, **options).acceleration for scene in (one, other))
    return rms(here - there) / rms(there)


def on_both_rows(scene):
    return tuple(dataclasses.replace(scene.spalls[0], row=row) for row in (1, 2))


def test_two_staggered_rows_with_the_same_spall_are_one_row_of_twice_the_balls(reference_scene):
    two = reference_scene("G1", 0.1)
    bearing = two.rig.bearing
    two = changed(two, bearing={"ball_diameter": 0.5 * bearing.ball_diameter}, spalls=on_both_rows(two))
    two = dataclasses.replace(two, imperfections=Imperfections(ball_deviation=DEVIATIONS))
    one = changed(
        two,
        bearing={"rows": 1, "balls": 2 * bearing.balls},
        spalls=two.spalls[:1],
        imperfections=Imperfections(ball_deviation=(tuple(np.transpose(DEVIATIONS).ravel()),)),
    )
    assert apart(one, two) < ROUNDING


def test_two_rows_in_line_with_the_same_spall_are_one_row_twice_as_stiff(reference_scene):
    two = reference_scene("F2", 0.1)
    two = changed(two, bearing={"row_offset": 0.0}, spalls=on_both_rows(two))
    stiff = {"rows": 1, "load_deflection": 2.0 * two.rig.bearing.load_deflection}
    one = changed(two, bearing=stiff, rig={"film_damping": 2.0 * two.rig.film_damping}, spalls=two.spalls[:1])
    assert apart(one, two) < ACCURACY


def test_a_contact_angle_is_a_softer_contact_with_larger_deviations(reference_scene):
    """F cos α = K (δ cos α)ⁿ cos α + c_d δ̇ cos² α, with deviations along the contact normal."""
    scene, cosine = reference_scene("G1", 0.1), math.cos(CONTACT_ANGLE)
    angular = changed(
        scene, bearing={"contact_angle": CONTACT_ANGLE}, imperfections=Imperfections(ball_deviation=DEVIATIONS)
    )
    bearing = scene.rig.bearing
    radial = changed(
        scene,
        bearing={"load_deflection": bearing.load_deflection * cosine ** (bearing.exponent + 1.0)},
        rig={"film_damping": scene.rig.film_damping * cosine**2},
        imperfections=Imperfections(ball_deviation=tuple(tuple(np.divide(row, cosine)) for row in DEVIATIONS)),
    )
    assert apart(radial, angular) < ROUNDING


def test_clearance_is_balls_that_are_all_too_small(reference_scene):
    loose = reference_scene("F1", 0.1)
    bearing = loose.rig.bearing
    small = tuple((-bearing.clearance,) * bearing.balls for _ in range(bearing.rows))
    tight = changed(loose, bearing={"clearance": 0.0}, imperfections=Imperfections(ball_deviation=small))
    assert apart(tight, loose) < ROUNDING


def test_one_wave_around_the_outer_race_moves_the_shaft_and_nothing_else(reference_scene):
    round_ = reference_scene("F1", 0.1)
    shifted = dataclasses.replace(round_, imperfections=Imperfections((Waviness("outer", 1, 5e-6, 0.7),)))
    assert apart(shifted, round_) < ROUNDING


def test_one_wave_around_the_inner_race_is_an_unbalance(reference_scene):
    """In the coordinate of the race's centre the shaft's mass, off by A, pulls with m A ω²."""
    scene, amplitude, phase = reference_scene("F1", 0.1, speed_factor=5.0), 5e-6, 0.7
    eccentric = dataclasses.replace(scene, imperfections=Imperfections((Waviness("inner", 1, amplitude, phase),)))
    force = scene.rig.inner_mass * amplitude * scene.operation.shaft_speed**2
    unbalanced = changed(scene, operation={"unbalance_force": force, "unbalance_phase": -phase})
    assert apart(scene, unbalanced, lead_in=LeadIn(0.5)) > 10 * ACCURACY
    assert apart(eccentric, unbalanced, lead_in=LeadIn(0.5)) < ACCURACY


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_a_machine_without_a_direction_of_its_own_answers_turned_when_it_is_turned(reference_scene, race):
    scene, turn = reference_scene("G1", 0.1), 1.1
    support = {"support_stiffness_x": scene.rig.support_stiffness_y, "support_damping_x": scene.rig.support_damping_y}
    run = {"load": 0.0, "unbalance_force": 200.0}
    scene = changed(scene, bearing={"clearance": -3e-6}, rig=support, operation=run, spall={"race": race})
    turned = changed(
        scene,
        operation={"unbalance_phase": turn},
        spall={"angle": scene.spalls[0].angle + turn},
        cage=dataclasses.replace(scene.cage, start_angle=turn),
    )
    here, there = (simulate(s, RATE).acceleration for s in (scene, turned))
    cosine, sine = math.cos(turn), math.sin(turn)
    assert rms(here @ np.array([[cosine, sine], [-sine, cosine]]) - there) < ACCURACY * rms(there)


def test_a_machine_twice_as_large_whose_forces_grow_alike_does_the_same_twice_as_far(reference_scene):
    scene = reference_scene("F1p", 0.1)
    bearing, run = scene.rig.bearing, scene.operation
    double = {name: 2.0 * getattr(bearing, name) for name in ("pitch_diameter", "ball_diameter", "clearance")}
    large = changed(
        scene,
        bearing=double | {"load_deflection": bearing.load_deflection * 2.0 ** (1.0 - bearing.exponent)},
        operation={"load": 2.0 * run.load},
        spall={"depth": 2.0 * scene.spalls[0].depth},
    )
    here, there = (simulate(s, RATE).acceleration for s in (scene, large))
    assert rms(there - 2.0 * here) < ROUNDING * rms(there)
