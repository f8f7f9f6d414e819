"""What fixed steps say of their error where a spall is passed within one of them."""

import dataclasses
import math

import pytest
from variants import changed

from physics.integrators.method_table import METHODS
from physics.outcome import Outcome, SimulationFailed
from physics.request import Accurate, FixedSteps, HalvedSteps
from physics.response.fixed_steps import MOST_HELD_AGAINST, default_substeps, steps_over_spalls
from physics.response.stability import longest_stable_step, require_stable, stable_substeps
from physics.rms import relative_error
from physics.simulate import simulate
from physics.statics.load_distribution import resting

RATE = 65536.0


def passed_at_once(reference_scene, degrees):
    """F1 at ten times its speed with a short spall: a tenth of a degree is passed in a third of a sample."""
    extent = math.radians(degrees)
    fast = reference_scene("F1", 0.04, speed_factor=10.0)
    return changed(fast, spall={"extent": extent, "entry_taper": 0.2 * extent, "exit_taper": 0.2 * extent})


def test_a_spall_that_ends_steps_oftener_than_they_come_is_no_less_wrong_for_halves_that_agree(reference_scene):
    scene = passed_at_once(reference_scene, 0.1)
    exact = simulate(scene, RATE, Accurate(1e-6)).acceleration
    one, two = (simulate(scene, RATE, FixedSteps(count)).acceleration for count in (1, 2))
    assert 100.0 * relative_error(one, two) < relative_error(one, exact)
    kept = simulate(scene, RATE, HalvedSteps(1e-4))
    assert relative_error(kept.acceleration, exact) < min(1e-4, 2.0 * kept.error_estimate)
    told = simulate(scene, RATE, FixedSteps(1, estimate_error=True))
    assert relative_error(told.acceleration, exact) < told.error_estimate


def test_a_spall_too_short_for_the_most_steps_is_refused_and_the_default_says_how_wrong_it_is(reference_scene):
    scene = passed_at_once(reference_scene, 0.02)
    with pytest.raises(SimulationFailed, match="with 32 steps") as failure:
        simulate(scene, RATE, HalvedSteps(1e-4))
    assert failure.value.outcome is Outcome.INACCURATE
    exact, trace = simulate(scene, RATE, Accurate(1e-6)), simulate(scene, RATE, Accurate(1e-3))
    assert relative_error(trace.acceleration, exact.acceleration) < trace.error_estimate < 1e-3


@pytest.mark.parametrize("name", ["G0", "G1", "F1", "F2"])
def test_at_the_rated_speed_halves_are_enough(name, reference_scene):
    assert steps_over_spalls(reference_scene(name, 0.02), RATE) == 1


def test_two_steps_are_asked_for_over_the_shortest_piece_of_a_spall(reference_scene):
    scene = passed_at_once(reference_scene, 0.1)
    speed = abs(scene.cage.mean_speed - scene.race_speed(scene.spalls[0].race))
    assert steps_over_spalls(scene, RATE) == math.ceil(2.0 * speed / (0.2 * math.radians(0.1) * RATE)) > 16
    walls = changed(scene, spall={"entry_taper": 0.0, "exit_taper": 0.0})
    assert steps_over_spalls(walls, RATE) == math.ceil(2.0 * speed / (math.radians(0.1) * RATE))
    sharp = changed(scene, spall={"entry_taper": 1e-9})
    assert steps_over_spalls(sharp, RATE) == math.ceil(2.0 * speed / (1e-9 * RATE)) > MOST_HELD_AGAINST


def test_the_exit_counts_as_the_entry_does(reference_scene):
    scene = reference_scene("F1", 0.02)
    for edge in ("entry_taper", "exit_taper"):
        sharp = changed(scene, spall={edge: 1e-6})
        # Two steps over 1e-6 rad at the cage speed of 34.441 rad/s.
        assert steps_over_spalls(sharp, RATE) == math.ceil(2.0 * 34.441 / (1e-6 * RATE))


def test_every_piece_of_a_table_counts(reference_scene):
    """Of nine pieces over 0.09 rad the shortest is 2e-4 rad; two steps over that at the cage speed of 34.441 rad/s."""
    angles = (-0.045, -0.035, -0.025, -0.015, -0.005, 0.005, 0.0052, 0.015, 0.03, 0.045)
    depths = (0.0, 2e-6, 1e-6, 5e-6, 4e-6, 9e-6, 8.9e-6, 3e-6, 2e-6, 0.0)
    measured = {"profile": "table", "extent": 0.09, "entry_taper": 0.0, "exit_taper": 0.0, "table_angle": angles}
    scene = changed(reference_scene("F1", 0.02), spall=measured | {"table_depth": depths, "depth": 9e-6})
    assert steps_over_spalls(scene, RATE / 16.0) == math.ceil(2.0 * 34.441 / (2e-4 * RATE / 16.0)) == 85


def test_a_floor_that_two_tapers_leave_nothing_of_is_no_piece(reference_scene):
    scene = changed(reference_scene("F1", 0.02), spall={"extent": 0.8, "entry_taper": 0.5, "exit_taper": 0.3})
    spall = scene.spalls[0]
    assert 0.0 < spall.extent - spall.entry_taper - spall.exit_taper < 1e-15
    assert steps_over_spalls(scene, RATE) == 1


@pytest.mark.parametrize(("rate", "steps"), [(65536.0, 1), (20000.0, 4), (10000.0, 7), (5000.0, 14)])
def test_about_six_steps_a_period_of_the_fastest_mode_are_the_least(rate, steps, reference_scene):
    # 6.2 steps of each of 10.548 kHz
    assert default_substeps(reference_scene("G0", 0.02), rate) == steps


def test_unless_told_otherwise_steps_are_as_many_as_are_stable(reference_scene):
    scene = reference_scene("G1", 0.005)
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, film_damping=3e4))
    with pytest.raises(SimulationFailed, match="step") as failure:
        simulate(scene, RATE, FixedSteps(default_substeps(scene, RATE)))
    assert failure.value.outcome is Outcome.UNSTABLE_STEP
    exact, stable = simulate(scene, RATE, Accurate(1e-6)).acceleration, simulate(scene, RATE, FixedSteps())
    assert stable.step < 1.0 / RATE
    assert relative_error(stable.acceleration, exact) < 1e-2


def test_a_method_that_misses_the_impulse_of_a_nearly_rectangular_edge_is_refused(reference_scene):
    scene, method = reference_scene("F1", 0.04), "generalised_alpha"
    taper = 1e-5 * scene.spalls[0].extent
    scene = changed(scene, spall={"entry_taper": taper, "exit_taper": taper})
    exact = simulate(scene, RATE, Accurate(1e-6)).acceleration
    # 6e-3 at any step: the impulse of the film comes from one place in the middle of each taper.
    half, wrong = (simulate(scene, RATE, FixedSteps(count, method=method)).acceleration for count in (16, 32))
    assert 2.0 * relative_error(half, wrong) < 4e-3 < relative_error(wrong, exact)
    with pytest.raises(SimulationFailed, match="generalised_alpha with 32 steps") as failure:
        simulate(scene, RATE, HalvedSteps(2e-3, method=method))
    assert failure.value.outcome is Outcome.INACCURATE
    kept = simulate(scene, RATE, HalvedSteps(2e-2, method=method))
    assert relative_error(kept.acceleration, exact) < kept.error_estimate
    assert relative_error(simulate(scene, RATE, HalvedSteps(1e-4)).acceleration, exact) < 1e-4


def test_1024_steps_a_sample_are_made_and_no_more():
    method = METHODS["runge_kutta4"]
    require_stable(method, RATE, 1024, 1024)
    with pytest.raises(SimulationFailed, match=r"takes 1025 steps a sample \(at most 1024 are made\)") as failure:
        require_stable(method, RATE, 1025, 1025)
    assert failure.value.outcome is Outcome.UNSTABLE_STEP


def test_steps_of_which_a_whole_number_makes_a_sample_are_not_made_shorter_by_rounding(reference_scene):
    scene, method = reference_scene("G0", 0.02), METHODS["runge_kutta4"]
    rest = resting(scene)
    longest = min(
        longest_stable_step(scene.rig, method, stiffness, damping)
        for stiffness, damping in zip(rest.stiffness, rest.damping, strict=True)
    )
    for steps in range(2, 40):
        assert stable_substeps(scene, method, rest, 1.0 / (steps * longest)) == steps
        assert stable_substeps(scene, method, rest, 0.999 / (steps * longest)) == steps + 1


def test_away_from_edges_the_estimate_of_a_method_of_second_order_is_its_error(reference_scene):
    scene = reference_scene("G0", 0.02)
    exact = simulate(scene, RATE, Accurate(1e-6)).acceleration
    told = simulate(scene, RATE, FixedSteps(8, method="generalised_alpha", estimate_error=True))
    assert told.error_estimate == pytest.approx(relative_error(told.acceleration, exact), rel=0.1)
