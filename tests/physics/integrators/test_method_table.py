"""Every numerical method shows the order it states, smooth and over line spalls, and stays close to the others."""

import dataclasses

import numpy as np
import pytest
from smooth import always_in_contact
from variants import changed, with_rollers

from physics.integrators.generalised_alpha import ALPHA_F, ALPHA_M, BETA, GAMMA, RADIUS_AT_INFINITY
from physics.integrators.method_table import MARCHES, METHODS, MODAL, REFERENCE
from physics.outcome import Outcome, SimulationFailed
from physics.request import FixedSteps, Reference
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0
# Steps a sample between which each method is past its first, coarse steps and above round-off.
SMOOTH = {
    "exponential_rk4": (2, 3, 4, 6, 8),
    "runge_kutta4": (3, 4, 6, 8, 12),
    "dormand_prince": (4, 6, 8, 10),
    "generalised_alpha": (16, 24, 32, 48),
    "exponential_adams2": (8, 12, 16, 24),
    "exponential_adams3": (6, 8, 12, 16),
    "exponential_adams4": (4, 6, 8, 12),
}
ON_LINE_SPALLS = {
    "exponential_rk4": (1, 2, 3, 4, 6, 8, 12),
    "runge_kutta4": (3, 4, 6, 8, 12),
    "dormand_prince": (3, 4, 6, 8),
    "generalised_alpha": (8, 12, 16, 24, 32),
    "exponential_adams2": (4, 6, 8, 12, 16, 24),
    "exponential_adams3": (6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32),
    "exponential_adams4": (3, 4, 6, 8, 12, 16, 24, 32),
}
# With rollers contact starts more abruptly: errors of these methods scatter more from one number of steps to the next,
# and fall by their last order from finer steps on. On G1 for 0.4 s the line through 6 to 32 steps a sample of
# exponential_adams3 has the order 1.98, that through 16 to 96 has 2.05, and n + 1 is 2.11.
MANY = (16, 18, 20, 22, 24, 28, 32, 36, 40, 44, 48, 56, 64, 72, 80, 88, 96)
WITH_ROLLERS = ON_LINE_SPALLS | {
    "exponential_adams2": (8, 12, 16, 24, 32, 48),
    "exponential_adams3": MANY,
    "exponential_adams4": MANY,
}
SECONDS_WITH_ROLLERS = {"G1": 0.4, "F1s": 0.1}  # so long that many passes average the scatter


def response(scene, method, substeps):
    return simulate(scene, RATE, FixedSteps(substeps, method)).acceleration


def order(scene, method, substeps, finest):
    """Slope of the straight line through log error over log step, against a much finer run of an order-4 method."""
    exact = response(scene, "exponential_rk4", finest)
    error = [rms(response(scene, method, count) - exact) for count in substeps]
    return -np.polyfit(np.log(substeps), np.log(error), 1)[0]


def test_every_march_and_the_reference_state_their_contract():
    assert set(METHODS) == {*MARCHES, MODAL, REFERENCE}
    for name, method in METHODS.items():
        assert method.name == name
        assert method.order >= 2.0
        assert method.controls_step == np.isnan(method.stability_limit)
        assert method.controls_step or method.stability_limit >= 0.05
        assert [least for least, _ in method.damped_limits] == sorted(least for least, _ in method.damped_limits)
        assert all((method.title, method.limits, method.dense_output, method.events, method.purpose, method.source))


def shaken(scene):
    """`scene` on supports that differ along x and y, under loads that turn fast."""
    rig = scene.rig
    supports = {
        "support_stiffness_y": 3.0 * rig.support_stiffness_y,
        "support_damping_x": 2.0 * rig.support_damping_x,
    }
    loads = {"unbalance_force": 200.0, "unbalance_phase": 0.7, "load_fluctuation": 0.5, "fluctuation_phase": 1.1}
    return changed(scene, rig=supports, operation={"shaft_speed": 1000.0, **loads})


@pytest.mark.parametrize("method", MARCHES)
def test_the_order_is_the_stated_one_where_the_motion_is_smooth(method, reference_scene):
    scene = shaken(always_in_contact(reference_scene, 0.05))
    found = order(scene, method, SMOOTH[method], finest=96)
    assert found == pytest.approx(METHODS[method].order, abs=0.1)  # the promise of the table


@pytest.mark.parametrize("name", ["G1", "F1s"])
@pytest.mark.parametrize("method", MARCHES)
def test_the_order_on_line_spalls_is_the_stated_one_or_n_plus_1(method, name, reference_scene):
    scene = reference_scene(name, 0.1)
    least = min(METHODS[method].order, scene.rig.bearing.exponent + 1.0)
    # Contact starts like (t − t0)^n, so the located start of contact costs an error of order n + 1.
    assert order(scene, method, ON_LINE_SPALLS[method], finest=96) > least - 0.1


@pytest.mark.slow
@pytest.mark.parametrize("name", SECONDS_WITH_ROLLERS)
@pytest.mark.parametrize("method", MARCHES)
def test_the_order_on_line_spalls_under_rollers_is_the_stated_one_or_n_plus_1(method, name, reference_scene):
    scene = with_rollers(reference_scene(name, SECONDS_WITH_ROLLERS[name]))
    least = min(METHODS[method].order, scene.rig.bearing.exponent + 1.0)
    assert order(scene, method, WITH_ROLLERS[method], finest=256) > least - 0.1


OF_ORDER_2 = ("exponential_adams2", "generalised_alpha")


@pytest.mark.parametrize("method", sorted(set(MARCHES) - set(OF_ORDER_2)))
def test_every_method_finds_the_same_contact_changes(method, reference_scene):
    scene = reference_scene("F1", 0.03)
    expected = simulate(scene, RATE, Reference()).changes
    assert expected.time.size > 20
    found = simulate(scene, RATE, FixedSteps(6, method)).changes
    assert np.array_equal(found.ball, expected.ball)
    assert np.array_equal(found.made, expected.made)
    assert np.abs(found.time - expected.time).max() < 2e-8  # s; the loosest pair has an error of 1e-5 of the RMS


@pytest.mark.parametrize("method", OF_ORDER_2)
def test_methods_of_order_2_find_the_contact_changes_of_their_order(method, reference_scene):
    scene = reference_scene("F1", 0.03)
    expected = simulate(scene, RATE, Reference()).changes
    assert expected.time.size > 20
    found = simulate(scene, RATE, FixedSteps(16, method)).changes
    assert np.array_equal(found.ball, expected.ball)
    assert np.abs(found.time - expected.time).max() < 2e-6  # s; its error of acceleration is 0.3 % at this step


@pytest.mark.parametrize("method", MARCHES)
def test_every_method_obeys_both_contact_laws(method, reference_scene):
    scene = dataclasses.replace(reference_scene("F1", 0.05), contact_law="no_tension")
    exact = response(scene, "exponential_rk4", 32)
    trace = simulate(scene, RATE, FixedSteps(16, method), keep=Kept(force=True))
    assert trace.contact_force.min() >= 0.0
    assert trace.unlocated_changes == 0
    assert rms(trace.acceleration - exact) < 1e-2 * rms(exact)  # the implicit method's 0.5 % at 16 steps a sample


def test_the_implicit_method_damps_unresolved_modes_by_its_stated_radius_and_is_of_order_2():
    order_2 = 0.5 - ALPHA_M + ALPHA_F
    assert order_2 == pytest.approx(GAMMA, rel=1e-15)  # round-off
    assert ALPHA_M <= ALPHA_F <= 0.5  # the condition of unconditional stability
    matrix = amplification(1e6)
    assert np.abs(np.linalg.eigvals(matrix)).max() == pytest.approx(RADIUS_AT_INFINITY, rel=1e-3)  # ω h of 1e6


def amplification(angle):
    """Matrix over one step of (x, h v, h² a) of an undamped mode that turns `angle` (rad) a step."""
    square = angle**2
    implicit = np.array([[1, 0, -BETA], [0, 1, -GAMMA], [square * (1 - ALPHA_F), 0, 1 - ALPHA_M]])
    explicit = np.array([[1, 1, 0.5 - BETA], [0, 1, 1 - GAMMA], [-square * ALPHA_F, 0, -ALPHA_M]])
    return np.linalg.solve(implicit, explicit)


def test_the_adaptive_method_takes_shorter_steps_where_asked_for_more_accuracy(reference_scene):
    scene = reference_scene("G1", 0.05)
    exact = response(scene, "exponential_rk4", 32)
    error = [relative_error(response(scene, "dormand_prince", count), exact) for count in (1, 2, 4)]
    assert error[0] < 1e-2  # a local error of 2e-3 of the largest motion
    assert error[0] > 2.0 * error[1] > 4.0 * error[2]


def test_samples_of_the_adaptive_method_do_not_depend_on_where_its_steps_end(reference_scene):
    scene = reference_scene("F1", 0.02)
    rare = simulate(scene, RATE, FixedSteps(8, "dormand_prince"), keep=Kept(state=True))
    often = simulate(scene, 3 * RATE, FixedSteps(8, "dormand_prince"), keep=Kept(state=True))
    assert rms(rare.state[:, 4] - often.state[::3, 4]) < 1e-5 * rms(rare.state[:, 4] - rare.state[0, 4])


def test_a_scene_too_stiff_for_the_adaptive_method_ends_with_a_typed_outcome(reference_scene):
    scene = reference_scene("G1", 0.02)
    rig = dataclasses.replace(scene.rig, film_damping=1e7)  # decays at 1e8 a second, so steps of 30 ns
    with pytest.raises(SimulationFailed) as failure:
        simulate(dataclasses.replace(scene, rig=rig), RATE, FixedSteps(1, "dormand_prince"))
    assert failure.value.outcome is Outcome.TOO_MANY_STEPS
