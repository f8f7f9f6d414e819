"""The edges of the stability maps from both sides: inside a method keeps the accuracy asked for, outside it says no."""

import pytest

from datagen.charts.stability import DURATION, RATE, SWEEPS
from physics.outcome import Outcome, SimulationFailed
from physics.reference_scenes import reference_scene
from physics.request import Accurate, FixedSteps, HalvedSteps
from physics.rms import relative_error
from physics.simulate import simulate

# Method, quantity, accuracy asked for, and neighbouring values of the maps: the last at which up to 32 steps a
# sample keep it, and the first at which they do not.
EDGES = (
    ("exponential_rk4", "contact stiffness K", 1e-3, 1e4, 1e5),
    ("runge_kutta4", "contact stiffness K", 1e-3, 1e4, 1e5),
    ("exponential_adams2", "contact stiffness K", 1e-4, 1.0, 10.0),
    ("generalised_alpha", "resonator stiffness", 1e-3, 0.1, 0.3),
    ("exponential_adams4", "film damping", 1e-5, 1e4, 3e4),
    ("generalised_alpha", "load", 5e-3, 1.0, 0.1),
    ("generalised_alpha", "load", 5e-3, 30.0, 100.0),
    ("generalised_alpha", "clearance", 2e-3, 5.0, -5.0),
    ("exponential_adams3", "speed", 3e-6, 3.0, 10.0),
    ("exponential_rk4", "spall length", 1e-5, 0.1, 0.01),
    ("generalised_alpha", "spall depth", 5e-3, 12.0, 30.0),
)
EDGE = pytest.mark.parametrize(("method", "quantity", "accuracy", "inside", "outside"), EDGES)
FINE_STEPS = 256


def scene_with(quantity, value):
    [sweep] = [sweep for sweep in SWEEPS if sweep.name == quantity]
    return sweep.apply(reference_scene("G1", DURATION), value)


def error(trace, scene):
    """RMS error of the acceleration over its RMS, against a run with many short steps."""
    exact = simulate(scene, RATE, FixedSteps(FINE_STEPS)).acceleration
    return relative_error(trace.acceleration, exact)


@EDGE
def test_just_inside_an_edge_the_accuracy_is_kept(method, quantity, accuracy, inside, outside):
    scene = scene_with(quantity, inside)
    trace = simulate(scene, RATE, HalvedSteps(accuracy, method=method))
    assert trace.error_estimate <= accuracy
    assert error(trace, scene) <= accuracy


@EDGE
def test_just_outside_an_edge_the_method_is_refused_and_the_default_keeps_the_accuracy(
    method, quantity, accuracy, inside, outside
):
    scene = scene_with(quantity, outside)
    with pytest.raises(SimulationFailed, match=f"{method} with [0-9]+ steps .* {accuracy:g} is asked") as failure:
        simulate(scene, RATE, HalvedSteps(accuracy, method=method))
    assert failure.value.outcome is Outcome.INACCURATE
    assert error(simulate(scene, RATE, Accurate(accuracy)), scene) <= accuracy


@pytest.mark.slow
def test_where_own_steps_become_too_short_they_are_given_up_with_a_typed_outcome():
    kept = simulate(scene_with("contact stiffness K", 1e5), RATE, HalvedSteps(method="dormand_prince"))
    assert error(kept, scene_with("contact stiffness K", 1e5)) <= 1e-3
    with pytest.raises(SimulationFailed, match="used up its steps") as failure:
        simulate(scene_with("contact stiffness K", 1e6), RATE, HalvedSteps(method="dormand_prince"))
    assert failure.value.outcome is Outcome.TOO_MANY_STEPS


@pytest.mark.parametrize(("quantity", "value"), [("resonator stiffness", 0.3), ("film damping", 3e4)])
def test_own_steps_bounded_by_the_samples_are_told_as_wrong_as_they_are(quantity, value):
    """Where only the sampling limits steps, a smaller tolerance would change nothing, and tell no error."""
    scene = scene_with(quantity, value)
    trace = simulate(scene, RATE, FixedSteps(1, "dormand_prince", estimate_error=True))
    assert error(trace, scene) <= 2.0 * trace.error_estimate
