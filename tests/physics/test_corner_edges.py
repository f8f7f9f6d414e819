"""Corners where methods fail, from both sides: inside a method keeps the accuracy asked for, outside it says no."""

import math

import pytest
from variants import changed

from physics.outcome import Outcome, SimulationFailed
from physics.request import Accurate, FixedSteps, HalvedSteps
from physics.rms import relative_error
from physics.simulate import simulate

RATE = 65536.0
FINE_STEPS = 256


def extended(scene, degrees):
    return changed(scene, spall={"extent": math.radians(degrees), "depth": 20e-6})


def reversed_load(scene, newtons):
    return changed(scene, operation={"load": -newtons}, spall={"angle": math.pi / 2.0})


def edges(scene, share):
    taper = share * scene.spalls[0].extent
    return changed(scene, spall={"entry_taper": taper, "exit_taper": taper})


def rollers(scene, factor):
    return changed(scene, bearing={"exponent": 10.0 / 9.0, "load_deflection": factor})


def clearance(scene, metres):
    return changed(scene, bearing={"clearance": metres})


def chatter(scene, film_damping):
    return changed(scene, rig={"film_damping": film_damping}, contact_law="no_tension")


# What is changed on F1, method, accuracy asked for, and a value at which up to 32 steps a sample keep it and one at
# which they do not.
EDGES = {
    "loaded balls leave an extended spall that held them all": (extended, "exponential_adams3", 3e-6, 180.0, 90.0),
    "a clearance that leaves one ball a row loaded grows": (clearance, "exponential_adams3", 1e-5, 200e-6, 400e-6),
    "a reversed load goes to zero": (reversed_load, "exponential_adams3", 3e-6, 100.0, 10.0),
    "edges become rectangular": (edges, "exponential_adams3", 2e-5, 0.2, 0.01),
    "rollers become stiff": (rollers, "generalised_alpha", 5e-3, 1e9, 1e10),
    "a film that makes contact chatter grows": (chatter, "exponential_adams2", 1e-4, 1e4, 3e4),
}


def exact(scene):
    return simulate(scene, RATE, FixedSteps(FINE_STEPS)).acceleration


@pytest.mark.parametrize("corner", EDGES)
def test_just_inside_a_corner_the_accuracy_is_kept(corner, reference_scene):
    change, method, accuracy, inside, _ = EDGES[corner]
    scene = change(reference_scene("F1", 0.04), inside)
    trace = simulate(scene, RATE, HalvedSteps(accuracy, method=method))
    assert trace.error_estimate <= accuracy
    assert relative_error(trace.acceleration, exact(scene)) <= accuracy


@pytest.mark.parametrize("corner", EDGES)
def test_just_outside_a_corner_the_method_is_refused_and_the_default_keeps_the_accuracy(corner, reference_scene):
    change, method, accuracy, _, outside = EDGES[corner]
    scene = change(reference_scene("F1", 0.04), outside)
    with pytest.raises(SimulationFailed, match=f"{method} with [0-9]+ steps .* {accuracy:g} is asked") as failure:
        simulate(scene, RATE, HalvedSteps(accuracy, method=method))
    assert failure.value.outcome is Outcome.INACCURATE
    assert relative_error(simulate(scene, RATE, Accurate(accuracy)).acceleration, exact(scene)) <= accuracy
