"""Right-hand sides as C functions, for solvers written in other languages."""

import ctypes
import gc

import numpy as np
import pytest
from variants import changed, slipping_cage

from physics.imperfections import Imperfections, Waviness
from physics.integrators.reference.equations import contact_set, slopes, write_equations
from physics.integrators.rivals.general_purpose import (
    BALL_BY_BALL,
    CONTACT_KERNEL,
    absolute_tolerance,
    c_right_hand_side,
    right_hand_side,
)
from physics.motion import motion_model, starting_state
from physics.reference_scenes import reference_scene
from physics.spall import Spall
from physics.statics.load_distribution import equilibrium

C_SIGNATURE = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.c_void_p] * 3)


@pytest.mark.parametrize("kind", [BALL_BY_BALL, CONTACT_KERNEL])
@pytest.mark.parametrize("scene", ["G2r", "F1"])
def test_a_c_function_gives_the_rates_that_python_gets_of_the_same_state(scene, kind):
    scene = reference_scene(scene)
    start = starting_state(motion_model(scene), equilibrium(scene, np.zeros(1)).displacement[0])
    callback, scale = c_right_hand_side(scene, kind, start), absolute_tolerance(scene, 1.0)
    gc.collect()
    call, rate = C_SIGNATURE(callback.address), np.zeros(12)
    slope, model = right_hand_side(scene, kind)
    random = np.random.default_rng(20261122)
    for time in (0.0, 0.0123, 0.3):
        deviation = random.normal(0.0, 30.0, 12)
        for _ in range(200):  # arrays whose owner was taken for gone or for theirs would be freed by one of many calls
            call(time, deviation.ctypes.data, rate.ctypes.data, callback.data.ctypes.data)
        expected = slope(model, time, start + scale * deviation) / scale
        np.testing.assert_allclose(rate, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())  # one rounding


def everything(law):
    """A scene with all that a scene can have at once: separate cages, two inner spalls, waves, unequal balls, ..."""
    scene = reference_scene("F0", 0.5)
    rig, deviation = scene.rig, np.random.default_rng(1).normal(0.0, 3e-7, (2, scene.rig.bearing.balls))
    waves = Waviness("outer", 15, 3e-7, 0.4), Waviness("inner", 40, 1e-7, 2.0)
    loads = {"unbalance_force": 30.0, "unbalance_phase": 0.7, "load_fluctuation": 0.2, "fluctuation_phase": 1.1}
    supports = {
        "support_stiffness_y": 3.0 * rig.support_stiffness_y,
        "support_damping_x": 2.0 * rig.support_damping_x,
    }
    return changed(
        scene,
        bearing={"contact_angle": 0.2},
        rig=supports,
        operation=loads,
        spalls=(Spall("inner", 1, 4.0, 0.8, 8e-6, 0.1, 0.05), Spall("inner", 2, 1.0, 0.3, 8e-6, 0.1, 0.05)),
        cage=slipping_cage(scene, 3),
        second_cage=slipping_cage(scene, 4, 0.9),
        imperfections=Imperfections(waves, tuple(tuple(row) for row in deviation.tolist())),
        contact_law=law,
    )


@pytest.mark.parametrize("kind", [BALL_BY_BALL, CONTACT_KERNEL])
@pytest.mark.parametrize("law", ["paper", "no_tension"])
def test_the_reference_and_its_rivals_read_the_same_rates_of_a_scene_that_has_everything(law, kind):
    scene = everything(law)
    equations, (slope, model) = write_equations(scene), right_hand_side(scene, kind)
    random, found, expected = np.random.default_rng(5), [], []
    for time in random.uniform(0.0, 0.45, 40):
        displacement, speed = random.normal(0.0, 6e-6, 2), random.normal(0.0, 5e-3, 6)
        # Inner ring, then outer ring and resonator, whose springs are far stiffer.
        state = np.concatenate([displacement, random.normal(0.0, 1e-8, 4), speed])
        expected.append(slopes(equations, contact_set(equations, time, state), time, state))
        found.append(slope(model, time, state))
    error = np.abs(np.array(found) - expected).max(axis=0) / np.abs(expected).max(axis=0)
    assert error.max() < 1e-8  # tables of waves
