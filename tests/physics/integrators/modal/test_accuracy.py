"""The modal method keeps the accuracy asked for, and knows its error."""

import dataclasses
import math
from operator import attrgetter

import numpy as np
import pytest
from axis_matrices import overdamped

from physics.imperfections import Imperfections, Waviness
from physics.integrators.modal.judgement import may_shrink
from physics.integrators.modal.memory import ModalGrid
from physics.request import Accurate, FixedSteps, Reference
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0
SCENES = ("G1", "G1p", "G2r", "F0", "F1", "F1s", "F2", "F2r")


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("accuracy", [1e-4, 2e-3])
def test_the_accuracy_asked_for_is_kept_and_the_error_known(name, accuracy, reference_scene, reference_trace):
    fine = reference_trace(name, 0.1, 16).acceleration
    trace = simulate(reference_scene(name, 0.1), RATE, Accurate(accuracy))
    error = relative_error(trace.acceleration, fine)
    assert error < accuracy
    assert trace.error_estimate < accuracy
    assert error < 4.0 * trace.error_estimate  # pushes are counted as if they were noise


def test_an_exact_response_is_as_exact_where_a_ball_is_lost_right_behind_an_edge(reference_scene):
    scene = reference_scene("F1", 0.12)
    speed = 3.0 * scene.operation.shaft_speed
    fast = dataclasses.replace(
        scene,
        operation=dataclasses.replace(scene.operation, shaft_speed=speed),
        cage=dataclasses.replace(scene.cage, nominal_speed=scene.rig.bearing.cage_speed(speed)),
    )
    fine = simulate(fast, RATE, FixedSteps(32)).acceleration
    trace = simulate(fast, RATE, Accurate(1e-5))
    assert rms(trace.acceleration - fine) < 1e-5 * rms(fine)  # 2e-5 or more if such steps are not judged


def variants(reference_scene):
    scene = reference_scene("F1", 0.08)
    bearing = scene.rig.bearing
    roller = dataclasses.replace(bearing, exponent=10.0 / 9.0, load_deflection=bearing.load_deflection * 4e-3)
    waves = (Waviness("outer", 11, 2e-7, 0.3), Waviness("inner", 5, 3e-7, 1.0))
    uneven = tuple(tuple(1e-7 * math.sin(3 * ball + row) for ball in range(bearing.balls)) for row in range(2))
    sharp = dataclasses.replace(scene.spalls[0], entry_taper=0.0, exit_taper=0.0)
    return {
        "without tension": dataclasses.replace(scene, contact_law="no_tension"),
        "rollers": dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=roller)),
        "edges without tapers": dataclasses.replace(scene, spalls=(sharp,)),
        "two cages": dataclasses.replace(scene, second_cage=scene.cage),
        "turning loads": dataclasses.replace(
            scene, operation=dataclasses.replace(scene.operation, unbalance_force=30.0, load_fluctuation=0.2)
        ),
        "waves and unequal balls": dataclasses.replace(scene, imperfections=Imperfections(waves, uneven)),
        "an overdamped resonator": dataclasses.replace(scene, rig=overdamped(scene.rig)),
    }


@pytest.mark.parametrize(
    "name",
    [
        "without tension",
        "rollers",
        "edges without tapers",
        "two cages",
        "turning loads",
        "waves and unequal balls",
        "an overdamped resonator",
    ],
)
def test_the_accuracy_is_kept_on_scenes_of_every_kind(name, reference_scene):
    scene = variants(reference_scene)[name]
    fine = simulate(scene, RATE, FixedSteps(16)).acceleration
    trace = simulate(scene, RATE)
    assert rms(trace.acceleration - fine) < 1e-3 * rms(fine)


@pytest.mark.parametrize("name", ["a line spall", "turning loads"])
def test_what_else_is_kept_moves_no_bit_and_agrees_with_fixed_steps(name, reference_scene):
    scene = variants(reference_scene).get(name, reference_scene("F1", 0.05))
    alone = simulate(scene, RATE)
    trace = simulate(scene, RATE, keep=Kept(state=True, force=True, outer=True))
    fine = simulate(scene, RATE, FixedSteps(8), keep=Kept(state=True, force=True, outer=True))
    assert np.array_equal(alone.acceleration, trace.acceleration)
    assert alone.contact_force is None
    for name in ("state", "contact_force", "outer.displacement", "outer.velocity", "outer.acceleration"):
        here, there = (attrgetter(name)(each) for each in (trace, fine))
        assert rms(here - there) < 1e-3 * rms(there), name  # the accuracy asked for, of the resonator's acceleration


@pytest.mark.parametrize(
    ("name", "slip_seed", "accuracies"),
    [
        ("G1", None, (1e-5, 1e-4, 1e-3, 1e-2)),
        (
            "F0",
            1,
            (1e-3, 2e-3, 3e-3, 4e-3, 6e-3, 1e-2),
        ),  # once lost to steps with short rests
    ],
)
def test_more_accuracy_takes_shorter_steps(name, slip_seed, accuracies, reference_scene):
    scene = reference_scene(name, 0.1, slip_seed=slip_seed)
    steps = [simulate(scene, RATE, Accurate(accuracy)).step * RATE for accuracy in accuracies]
    assert all(np.diff(steps) > 0.0)
    assert steps[0] > 1.0 / 16.0


def test_a_beginning_too_coarse_for_the_scene_is_made_again(reference_scene):
    scene = reference_scene("G1", 0.04)  # of which the beginning that says how sensitive the scene is takes four fifths
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, film_damping=1e4))
    fine = simulate(scene, RATE, FixedSteps(64)).acceleration
    assert rms(simulate(scene, RATE).acceleration - fine) < 0.7e-3 * rms(fine)  # 1.7e-3 if it is kept


def test_an_error_that_is_always_allowed_spares_steps(reference_scene):
    scene = reference_scene("G1", 0.1)
    strict, lax = simulate(scene, RATE, Accurate(1e-5)), simulate(scene, RATE, Accurate(1e-5, least_error=0.01))
    assert lax.step > 2.0 * strict.step
    assert rms(lax.acceleration - strict.acceleration) < 0.01


def test_no_step_is_taken_back_for_ever():
    grid = ModalGrid(100, 1.0 / RATE, 3, 1e-9, 1e-9, 1.0, 512.0, 1.0)
    step, halvings = 8.0 / RATE, 0
    while may_shrink(grid, step):
        step, halvings = 0.5 * step, halvings + 1
    assert halvings <= 14  # from eight samples to a sixty-fourth of a unit, 2^13 times shorter


def test_the_finest_accuracy_that_may_be_asked_for_is_answered(reference_scene):
    scene = reference_scene("G1", 0.02)
    found, exact = simulate(scene, RATE, Accurate(1e-6)), simulate(scene, RATE, Reference())
    apart = relative_error(found.acceleration, exact.acceleration)
    assert apart < 1e-6
    assert found.error_estimate <= 1e-6


def test_the_sensitivity_of_a_tame_scene_is_small(reference_scene):
    trace = simulate(reference_scene("G1", 0.1), RATE)
    assert 0.0 < trace.sensitivity < 10.0
    assert not trace.chaotic
