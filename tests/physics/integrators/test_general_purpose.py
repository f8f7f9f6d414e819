"""Right-hand sides as C functions, for solvers written in other languages."""

import ctypes
import gc

import numpy as np
import pytest

from physics.integrators.rivals.general_purpose import (
    BALL_BY_BALL,
    CONTACT_KERNEL,
    absolute_tolerance,
    c_right_hand_side,
    right_hand_side,
)
from physics.motion import motion_model, starting_state
from physics.reference_scenes import reference_scene
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
