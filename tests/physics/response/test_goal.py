"""What a response is to reach: tolerances, estimates and what two responses tell, on numbers worked out by hand."""

import math

import numpy as np
import pytest
from stand_ins import LOAD, MASS, PRELOAD, PUSH, RATE, SAMPLES, World, a_case, a_goal, an_output, tolerance

from physics.response.goal import fewest_touching, finer, observed_sensitivity, rms_distance, safety_factor, steady

ONES = np.ones((SAMPLES, 2))


def test_the_error_allowed_is_a_share_of_the_signal_or_the_least_error():
    assert a_goal(accuracy=0.01, least_error=0.05).allowed(2.0) == 0.05
    assert a_goal(accuracy=0.01, least_error=0.05).allowed(20.0) == pytest.approx(0.2, rel=1e-12)


def test_a_scene_counts_as_tame_until_six_times_its_sensitivity_exceeds_the_usual_factor():
    assert safety_factor(0.0) == safety_factor(0.58) == 1.0  # 6 · 0.58 < 3.5
    assert safety_factor(7.0) == pytest.approx(12.0, rel=1e-12)  # 6 · 7 / 3.5


def test_the_estimate_is_the_usual_factor_or_six_times_the_sensitivity_of_what_steps_add_up_to():
    output = an_output(ONES, pushed=0.1)
    assert a_goal().error(output, 0.0) == pytest.approx(0.35, rel=1e-12)
    assert a_goal().error(output, 7.0) == pytest.approx(4.2, rel=1e-12)


@pytest.mark.parametrize(("aim", "sensitivity"), [(0.1, 0.0), (0.03, 0.0), (0.1, 7.0)])
def test_steps_that_spend_what_the_grid_grants_leave_three_quarters_of_the_error_allowed(aim, sensitivity):
    goal = a_goal(accuracy=0.01)
    grid = goal.aimed(4.0, aim, sensitivity)
    assert math.sqrt(grid.seen / 2.0) == pytest.approx(2.0)  # of both axes, a signal of 2 m/s² along each
    one_step = grid.share * math.sqrt(grid.seen)
    spent = an_output(ONES)._replace(spent=np.array([SAMPLES * grid.spending * one_step**2]))
    assert goal.error(spent, sensitivity) == pytest.approx(0.75 * goal.allowed(2.0), rel=1e-12)


def test_no_tolerance_is_below_the_least_error_nor_below_what_forces_are_known_to():
    floor = 0.1 * 0.01 * 1e-8 * LOAD / MASS  # of the acceleration of the load
    assert a_goal(accuracy=0.01).aimed(1.0, 0.1, 0.0).least == pytest.approx(PUSH * floor, rel=1e-12)
    assert a_goal(accuracy=0.01, least_error=0.5).aimed(1.0, 0.1, 0.0).least == pytest.approx(PUSH * 0.05, rel=1e-12)
    assert a_goal(accuracy=1e-9).aimed(1.0, 0.1, 0.0).least == pytest.approx(1e-13 * (LOAD + PRELOAD) / RATE, rel=1e-12)


def test_a_finer_grid_has_a_share_of_both_tolerances_and_a_steady_one_grants_any_number_of_errors():
    grid = steady(a_case(), SAMPLES, 1e-3, 2.0)
    assert tolerance(grid) == pytest.approx(1e-3, rel=1e-12)
    assert grid.spending > 1e6
    halved = finer(grid, 0.5)
    assert (halved.share, halved.least) == (0.5 * grid.share, 0.5 * grid.least)
    assert halved._replace(share=grid.share, least=grid.least) == grid


@pytest.mark.parametrize(("accuracy", "size", "share"), [(1e-4, 2.0, 1e-3), (0.05, 2.0, 0.05), (0.05, 0.0, 1e-3)])
def test_a_coarse_response_is_made_to_a_thousandth_or_to_what_is_allowed_if_that_is_more(accuracy, size, share):
    world = World(lambda tolerance, number: an_output(ONES))
    a_goal(world, accuracy).coarse(size)
    assert world.asked == [pytest.approx(share, rel=1e-12)]


def test_a_coarse_response_sets_out_with_one_error_of_a_step_which_counts():
    world = World(lambda tolerance, number: an_output(ONES))
    output = a_goal(world).coarse(2.0)
    push = 2e-3 * PUSH  # of a step for an error of a thousandth of 2 m/s²
    assert world.marches[0].push == pytest.approx(push, rel=1e-12)
    assert output.spent[0] == pytest.approx(push**2, rel=1e-12)
    assert a_goal().begin().push == 0.0


def test_two_responses_are_apart_by_their_difference_as_long_as_both_last():
    other = ONES.copy()
    other[SAMPLES // 4 :] += 3.0
    one, long = an_output(ONES), an_output(np.vstack([other, other]))
    assert rms_distance(one, long) == pytest.approx(3.0 * math.sqrt(0.75), rel=1e-12)
    assert rms_distance(one, long, 0.25) == 0.0
    assert rms_distance(one, long, 0.5) == pytest.approx(3.0 * math.sqrt(0.5), rel=1e-12)


def test_the_sensitivity_shown_is_the_distance_over_what_the_coarse_ones_steps_add_up_to():
    assert observed_sensitivity(a_case(), an_output(ONES, pushed=0.1), an_output(ONES + 0.5)) == pytest.approx(
        5.0, rel=1e-12
    )
    assert observed_sensitivity(a_case(), an_output(ONES), an_output(ONES + 0.5)) == 0.0


def test_the_fewest_balls_that_touch_at_once_are_counted_through_the_logged_changes():
    assert fewest_touching(an_output(ONES)) == 2
    assert fewest_touching(an_output(ONES, made=(True, False, False, False, True))) == 0  # 2, 3, 2, 1, 0, 1
    assert fewest_touching(an_output(ONES, initial=(0.0, 0.0, 0.0), made=(True, True))) == 0
