"""Responses so small that they are nothing but rounding of the contact forces."""

import math
from dataclasses import replace

import numpy as np
import pytest

from physics.imperfections import Imperfections, Waviness
from physics.paths.roughness import draw_roughness
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps, LeadIn
from physics.response.silence import largest_forces, silence
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.spall import Spall

RATE, LEAD_IN = 32768.0, LeadIn(0.5)


def preloaded(name, load, clearance=-5e-6, imperfections=None):
    scene = reference_scene(name, 0.2)
    bearing = replace(scene.rig.bearing, clearance=clearance)
    return replace(
        scene,
        rig=replace(scene.rig, bearing=bearing),
        operation=replace(scene.operation, load=load),
        imperfections=imperfections or scene.imperfections,
        spalls=(),
    )


@pytest.mark.parametrize("load", [0.0, 1e-3, 1.0, 346.0])
@pytest.mark.parametrize("name", ["G0", "F0"])
def test_preload_all_round_leaves_silence_by_every_method(name, load):
    scene = preloaded(name, load)
    trace, by_steps = simulate(scene, RATE, lead_in=LEAD_IN), simulate(scene, RATE, FixedSteps(8), lead_in=LEAD_IN)
    assert rms(by_steps.acceleration) < 1e-8  # m/s², a ten thousandth of the quietest healthy bearing without preload
    assert trace.silent
    assert not trace.chaotic
    assert rms(trace.acceleration) <= silence(scene)
    assert trace.error_estimate <= 1.0


def test_waves_that_press_all_balls_alike_leave_silence():
    scene = preloaded("G0", 0.0, imperfections=Imperfections(waviness=(Waviness("outer", 12, 1e-6),)))
    trace = simulate(scene, RATE, lead_in=LEAD_IN)
    assert rms(trace.acceleration) <= silence(scene)
    assert not trace.chaotic


@pytest.mark.parametrize(("name", "load", "clearance"), [("G0", 1e-6, 0.0), ("F0", 430.0, 0.0), ("G1", 346.0, -5e-6)])
def test_what_is_more_than_rounding_is_known_to_the_accuracy(name, load, clearance):
    scene = replace(preloaded(name, load, clearance), spalls=reference_scene(name).spalls)
    trace = simulate(scene, RATE, lead_in=LEAD_IN)
    exact = simulate(scene, RATE, FixedSteps(32), lead_in=LEAD_IN)
    assert not trace.silent
    assert relative_error(trace.acceleration, exact.acceleration) < 1e-3


def test_nothing_at_all_is_exact_and_no_rounding():
    trace = simulate(preloaded("G0", 0.0, clearance=0.0), RATE)
    assert not trace.acceleration.any()
    assert not trace.silent
    assert trace.error_estimate == 0.0


@pytest.mark.parametrize("seed", [0, 5])
def test_unloaded_balls_that_just_touch_a_rough_spall_move_nothing(seed):
    scene = preloaded("G0", 0.0, clearance=0.0)
    heights = draw_roughness(np.random.default_rng(seed), scene.rig.bearing, "outer", 0.68, 1e-6, None)
    spall = Spall("outer", 1, 4.71, 0.68, 3e-6, profile="ball_path", roughness=1e-6, roughness_values=heights)
    trace = simulate(replace(scene, spalls=(spall,)), RATE)
    assert trace.changes.time.size > 0
    assert not trace.acceleration.any()
    assert trace.error_estimate == 0.0


def test_forces_of_preload_and_waves_follow_from_the_contact_law():
    load_deflection = preloaded("G0", 0.0).rig.bearing.load_deflection  # of 2 rows of 12 balls, contact angle 0
    both = Imperfections(waviness=(Waviness("outer", 12, 1e-6), Waviness("inner", 3, 2e-6)))
    assert largest_forces(preloaded("G0", -50.0)) == pytest.approx(50.0 + 24 * load_deflection * 5e-6**1.5)
    assert largest_forces(preloaded("G0", 0.0, 1e-6, both)) == pytest.approx(24 * load_deflection * 2e-6**1.5)
    assert largest_forces(preloaded("G0", 346.0, 1e-5, both)) == 346.0


def test_silence_is_what_forces_known_so_well_do_to_the_outer_ring():
    scene = preloaded("G0", 300.0, clearance=1e-5)
    heavy = replace(scene, rig=replace(scene.rig, outer_mass=2.0 * scene.rig.outer_mass))
    light = replace(scene, rig=replace(scene.rig, inner_mass=0.5 * scene.rig.inner_mass))
    assert silence(scene) == pytest.approx(300e-12 / 10.268)  # N, kg
    assert silence(heavy) == 0.5 * silence(scene)
    assert silence(light) == silence(scene)


def test_the_largest_ball_stands_proud_as_waves_do():
    machine = preloaded("G0", 0.0).rig.bearing  # 2 rows of 12 balls, contact angle 0
    balls = ((4e-6, *(-9e-6,) * 11), (0.0,) * 12)
    both = Imperfections((Waviness("outer", 12, 1e-6),), balls)
    assert largest_forces(preloaded("G0", 0.0, 3e-6, both)) == pytest.approx(24 * machine.load_deflection * 2e-6**1.5)
    steep = preloaded("G0", 0.0, 3e-6, Imperfections(ball_deviation=balls))
    steep = replace(steep, rig=replace(steep.rig, bearing=replace(steep.rig.bearing, contact_angle=math.radians(60.0))))
    # Along a normal at 60 degrees 4 µm are 8 µm of radial way, and K is K cos^2.5 60° of it.
    assert largest_forces(steep) == pytest.approx(24 * machine.load_deflection * 0.5**2.5 * 5e-6**1.5)
    small = Imperfections(ball_deviation=((-9e-6,) * 12, (-9e-6,) * 12))
    assert largest_forces(preloaded("G0", 0.0, -8e-6, small)) == 0.0


def test_a_load_that_swings_and_turns_counts_at_its_largest():
    scene = preloaded("G0", -300.0, clearance=1e-5)
    run = replace(scene.operation, load_fluctuation=0.5, unbalance_force=20.0)
    assert largest_forces(replace(scene, operation=run)) == 470.0
