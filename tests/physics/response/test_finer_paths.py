"""Small accuracies over spalls, whose tabled paths and edges leave errors that no step makes good."""

from dataclasses import replace

import numpy as np
import pytest

from physics.catalog import rig
from physics.checks import InvalidParameter
from physics.paths.profile import build_path
from physics.paths.roughness import draw_roughness
from physics.reference_scenes import gap_line_spall, line_spall, reference_scene, rough_extended_spall
from physics.request import Accurate, FixedSteps
from physics.response.adaptive import respond_accurately
from physics.response.asked import Asked
from physics.response.attempts import to_accuracy
from physics.response.finer_paths import respond_on_finer_paths
from physics.response.goal import Goal
from physics.response.modal_case import March, case_of
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.statics.load_distribution import resting
from physics.trace import ACCELERATION_ALONE

RATE = 65536.0


def rolled_scene(duration, seed=1):
    """A long rough gap over which the ball is rolled, on the fan rig."""
    scene = reference_scene("F2", duration, slip_seed=1)
    (gap,) = scene.spalls
    values = draw_roughness(np.random.default_rng(seed), scene.rig.bearing, "outer", gap.extent, 2e-6, None)
    return replace(scene, spalls=(replace(gap, profile="ball_path", roughness=2e-6, roughness_values=values),))


def as_asked(scene, accuracy, fineness):
    asked = Asked(scene, resting(scene), RATE, scene.samples(RATE), accuracy, fineness=fineness)
    return respond_accurately(asked)


@pytest.mark.parametrize("spall", [line_spall("fan"), gap_line_spall("fan"), rough_extended_spall(rig("fan"), 1)])
def test_a_path_of_finer_cells_is_the_same_path(spall):
    bearing = rig("fan").bearing
    usual, fine = (build_path(spall, bearing, fineness) for fineness in (1, 4))
    assert fine.cells.sum() >= 3 * usual.cells.sum()
    arc = np.linspace(-spall.extent / 2.0, spall.extent / 2.0, 2001)
    np.testing.assert_allclose(fine.depth(arc), usual.depth(arc), atol=1e-9)
    assert build_path(spall, bearing) is usual


def test_what_a_table_of_a_rolled_path_leaves_is_in_the_estimate():
    scene = rolled_scene(0.05)
    exact, usual = (as_asked(scene, 1e-6, fineness) for fineness in (16, 1))
    found = simulate(scene, RATE, Accurate(1e-6))
    floor, error = (relative_error(one.acceleration, exact.acceleration) for one in (usual, found))
    assert floor > 1e-6 > usual.error_estimate
    assert error < min(0.25 * floor, found.error_estimate)


def test_a_step_to_a_kink_leaves_out_no_time():
    """Steps that did were wrong by 7.5e-9 on this scene, however small the tolerance."""
    scene = reference_scene("F1s", 0.05, slip_seed=1)
    exact = simulate(scene, RATE, FixedSteps(192)).acceleration
    errors = []
    for fine in (False, True):
        case = replace(case_of(scene, resting(scene), RATE), fine=fine)
        goal = Goal(case, scene.samples(RATE), 1e-9, 0.0, ACCELERATION_ALONE, March.go_on)
        output, _ = to_accuracy(goal, goal.begin(), rms(exact) ** 2, 0.0)
        errors.append(relative_error(output.acceleration, exact))
    assert errors[1] < 1e-9 < 3e-9 < errors[0]


def test_paths_are_made_finer_until_what_they_leave_is_allowed():
    scene = reference_scene("F1", 0.02)
    trace, asked = simulate(scene, RATE), []

    def respond(fineness):
        asked.append(fineness)
        return replace(trace, acceleration=trace.acceleration * (1.0 + 1e-3 / fineness), error_estimate=1e-7)

    left = {accuracy: respond_on_finer_paths(respond, accuracy, 0.0).error_estimate for accuracy in (1e-3, 1e-6)}
    assert asked == [1, 4, 1, 4, 16]
    assert left[1e-3] == pytest.approx(7.5e-4, rel=1e-3)
    assert left[1e-6] == pytest.approx(1.875e-4, rel=1e-3)


def test_an_error_that_is_allowed_anyway_needs_no_paths_of_a_fineness_of_16():
    trace, asked = simulate(reference_scene("F1", 0.02), RATE), []

    def respond(fineness):
        asked.append(fineness)
        return replace(trace, acceleration=trace.acceleration * (1.0 + 1e-3 / fineness), error_estimate=1e-2)

    found = respond_on_finer_paths(respond, 1e-6, 1e-3 * rms(trace.acceleration))
    assert asked == [1, 4]
    assert found.error_estimate == 1e-2  # the paths leave 7.5e-4, but the steps more


def test_a_chaotic_response_is_made_over_the_usual_paths_alone():
    trace, asked = replace(simulate(reference_scene("F1", 0.02), RATE), chaotic=True), []
    assert respond_on_finer_paths(lambda fineness: asked.append(fineness) or trace, 1e-6, 0.0) is trace
    assert asked == [1]


def test_no_other_fineness_is_allowed():
    with pytest.raises(InvalidParameter, match="path_fineness"):
        Accurate(path_fineness=32)
