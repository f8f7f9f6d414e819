"""When a response is made again, with what tolerance, and when none is known: on responses chosen beforehand."""

import math

import numpy as np
import pytest
from stand_ins import SAMPLES, World, a_goal, an_output, tolerance

from physics.outcome import Outcome, SimulationFailed
from physics.response.attempts import confirm_doubtful, to_accuracy

ACCURACY = 1e-3


def wrong_by(sensitivity, pushed=1.0, **fields):
    """Responses of 1 m/s² wrong by `sensitivity` times their tolerance; the errors of steps are `pushed` times it."""

    def response(asked, number):
        return an_output(np.full((SAMPLES, 2), 1.0 + sensitivity * asked), pushed * asked, **fields)

    return World(response)


def begun(world, accuracy=ACCURACY):
    goal = a_goal(world, accuracy)
    return goal, goal.begin()


def test_a_first_attempt_that_is_exact_enough_goes_on_with_the_march_that_has_begun():
    goal, march = begun(world := wrong_by(0.0))
    output, grid = to_accuracy(goal, march, 1.0, 0.0)
    assert world.asked == [pytest.approx(0.1 * ACCURACY, rel=1e-9)]  # a tenth of the accuracy, error 3.5 times that
    assert world.marches[0] is march
    assert tolerance(grid) == world.asked[0]
    assert goal.error(output, 0.0) == pytest.approx(0.35 * ACCURACY, rel=1e-9)


def test_a_second_attempt_aims_at_seven_tenths_of_the_error_allowed_with_a_march_of_its_own():
    goal, march = begun(world := wrong_by(0.0, pushed=5.0))
    output, _ = to_accuracy(goal, march, 1.0, 0.0)
    # At first 3.5 · 5 · 1e-4 = 1.75e-3, so 0.7 · 1e-3 / 1.75e-3 = 0.4 times the tolerance.
    assert world.asked == pytest.approx([1e-4, 0.4e-4], rel=1e-3)
    assert world.marches[1] is not march
    assert goal.error(output, 0.0) == pytest.approx(0.7 * ACCURACY, rel=1e-3)


def test_the_tolerance_is_at_least_halved_and_no_attempt_follows_one_that_left_more_than_half_the_error():
    always = World(lambda asked, number: an_output(np.ones((SAMPLES, 2)), pushed=1.2 * ACCURACY / 3.5))
    goal, march = begun(always)
    to_accuracy(goal, march, 1.0, 0.0)
    assert always.asked == pytest.approx([1e-4, 0.5e-4], rel=1e-9)


def test_no_more_than_four_attempts_are_made():
    slow = World(lambda asked, number: an_output(np.ones((SAMPLES, 2)), pushed=0.4**number))
    goal, march = begun(slow)
    to_accuracy(goal, march, 1.0, 0.0)
    assert len(slow.asked) == 4


def test_a_beginning_that_was_too_coarse_for_the_sensitivity_is_not_gone_on_with():
    goal, march = begun(world := wrong_by(0.0))
    to_accuracy(goal, march, 1.0, 7.0)
    assert world.asked == [pytest.approx(1e-4 / 12.0, rel=1e-9)]  # 6 · 7 / 3.5 times more exact
    assert world.marches[0] is not march


def coarse_of(world, sensitivity):
    """A goal, a response at a tolerance of 1e-4, its grid, and its sensitivity, as `confirm_doubtful` takes them."""
    goal = a_goal(world, ACCURACY)
    grid = goal.aimed(1.0, 0.1, 0.0)
    return goal, world.response(tolerance(grid), 0), grid, sensitivity


def test_a_doubtful_response_is_said_again_as_much_finer_as_it_is_sensitive():
    world = wrong_by(5.0)
    again, error, sensitivity = confirm_doubtful(*coarse_of(world, 5.0))
    share = 3.5 / (6.0 * 5.0)
    assert world.asked == [pytest.approx(share * 1e-4, rel=1e-9)]
    assert again.acceleration[0, 0] == pytest.approx(1.0 + 5.0 * share * 1e-4, rel=1e-12)
    assert error == pytest.approx(6.0 * 5.0 * share * 1e-4, rel=1e-9)
    assert sensitivity == 5.0  # both are apart by 5 · (1 − share) tolerances, which is less


def test_a_second_response_that_shows_more_sensitivity_is_made_once_more_to_it():
    world = wrong_by(40.0)
    _, error, sensitivity = confirm_doubtful(*coarse_of(world, 5.0))
    found = 40.0 * (1.0 - 3.5 / 30.0)
    assert sensitivity == pytest.approx(found, rel=1e-6)
    assert world.asked[1] == pytest.approx(1e-4 * 3.5 / (6.0 * found), rel=1e-6)
    assert error == pytest.approx(6.0 * found * world.asked[1], rel=1e-6)
    assert error <= ACCURACY


def test_a_chaotic_response_is_confirmed_by_one_so_much_finer_as_their_distance_asks_for():
    world = wrong_by(60.0)
    fine, error, sensitivity = confirm_doubtful(*coarse_of(world, 60.0))
    first = 60.0 * 1e-4 * 15.0 / 16.0  # from a tolerance of 1e-4 to a sixteenth
    next_share = (ACCURACY / (6.0 * first * 0.25)) ** 2  # errors fall with the root of the tolerance until shown
    assert world.asked == pytest.approx([1e-4 / 16.0, 1e-4 / 16.0 * next_share], rel=1e-3)
    assert error == pytest.approx(6.0 * 60.0 * (world.asked[0] - world.asked[1]) * math.sqrt(next_share), rel=1e-3)
    assert fine.acceleration[0, 0] == pytest.approx(1.0 + 60.0 * world.asked[1], rel=1e-12)
    assert sensitivity == 60.0


def test_a_response_that_finer_ones_leave_nothing_of_ends_as_nothing():
    late = np.arange(SAMPLES)[:, None] >= 0.9 * SAMPLES
    vanishing = World(lambda asked, number: an_output(np.where(late, asked, 0.0) * [1.0, 1.0] * (asked > 2e-5), asked))
    fine, error, _ = confirm_doubtful(*coarse_of(vanishing, 60.0))
    assert not fine.acceleration.any()
    assert error == pytest.approx(6.0 * 60.0 * vanishing.asked[-1], rel=1e-9)  # of the steps: both are alike


def test_a_response_of_exactly_zero_is_not_asked_for_again_and_again():
    nothing = World(lambda asked, number: an_output(np.zeros((SAMPLES, 2)), asked))
    goal, march = begun(nothing)
    to_accuracy(goal, march, 1.0, 0.0)
    assert len(nothing.asked) == 1


@pytest.mark.parametrize("near", [(1.0, 1.00001, 1.00002), (1.0, 1.0, 1.00001)])
def test_one_near_to_the_one_before_whose_steps_erred_as_much_confirms_nothing(near):
    pushed = [1e-4, 1e-4, 1e-7]
    world = World(lambda asked, number: an_output(np.full((SAMPLES, 2), near[number]), pushed[number]))
    fine, error, _ = confirm_doubtful(*coarse_of(world, 60.0))
    assert fine.acceleration[0, 0] == near[2]  # 6 · 60 · 1e-4 is 36 times the accuracy, 6 · 60 · 1e-7 is within it
    assert error == pytest.approx(6.0 * 60.0 * 1e-7, rel=1e-3)


def test_rings_that_part_are_confirmed_however_little_sensitive():
    world = wrong_by(1.0, made=(False, False))
    confirm_doubtful(*coarse_of(world, 1.0))
    assert world.asked[0] == pytest.approx(1e-4 / 16.0, rel=1e-9)


def flipping(alike):
    """Responses of which every other one has the opposite sign behind the share `alike` of the samples."""

    def response(asked, number):
        signal = np.ones((SAMPLES, 2))
        signal[round(alike * SAMPLES) :] *= (-1.0) ** number
        return an_output(signal, asked)

    return World(response)


@pytest.mark.parametrize(("alike", "calls"), [(0.1, 1), (0.3, 2), (0.9, 3)])
def test_of_responses_that_part_too_soon_none_is_known(alike, calls):
    """Two more attempts would be needed from a share of 0.15 on, one from 0.4 on; then there are none left."""
    world = flipping(alike)
    _, error, _ = confirm_doubtful(*coarse_of(world, 60.0))
    assert len(world.asked) == calls
    assert math.isinf(error)


def test_what_cannot_be_made_finer_keeps_the_error_that_was_seen():
    plain = wrong_by(60.0)

    def response(asked, number):
        if number == 2:
            raise SimulationFailed(Outcome.TOO_MANY_STEPS, "enough")
        return plain.response(asked, number)

    world = World(response)
    fine, error, _ = confirm_doubtful(*coarse_of(world, 60.0))
    assert len(world.asked) == 2
    assert error == pytest.approx(6.0 * 60.0 * 1e-4 * 15.0 / 16.0 * 0.25, rel=1e-3)
    assert fine.acceleration[0, 0] == pytest.approx(1.0 + 60.0 * 1e-4 / 16.0, rel=1e-12)


def test_none_is_made_after_one_that_took_seven_times_the_steps():
    plain = wrong_by(60.0)
    world = World(lambda asked, number: plain.response(asked, number)._replace(tally=np.array([0, 0, 1 + 7 * number])))
    confirm_doubtful(*coarse_of(world, 60.0))
    assert len(world.asked) == 1
