"""Records whose errors grow from ball pass to ball pass keep the accuracy all the same, or say that they cannot."""

import dataclasses

import pytest

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.request import Accurate, FixedSteps
from physics.response import adaptive
from physics.response.attempts import CHAOTIC
from physics.rms import relative_error
from physics.simulate import simulate


def _drawn(seed, record):
    return draw_scenario(load_recipe("corpus").model_copy(update={"seed": seed}), record)


def _apart(one, other):
    return relative_error(one.acceleration, other.acceleration)


def _shortened(scene, seconds):
    first, second = (cage and dataclasses.replace(cage, duration=seconds) for cage in (scene.cage, scene.second_cage))
    return dataclasses.replace(scene, cage=first, second_cage=second)


def test_the_error_of_a_record_whose_errors_grow_is_within_its_estimate():
    drawn = _drawn(20261125, 4700)  # its slowest mode takes a quarter of a second to decay
    trace, exact = simulate(drawn.scene, drawn.rate), simulate(drawn.scene, drawn.rate, Accurate(1e-5))
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_a_record_that_makes_hundreds_of_every_error_is_marched_until_it_keeps_the_accuracy():
    drawn = _drawn(20261126, 2200)
    trace = simulate(drawn.scene, drawn.rate)
    exact = simulate(drawn.scene, drawn.rate, FixedSteps(64))
    assert trace.sensitivity > CHAOTIC
    assert not trace.chaotic
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_errors_of_rings_that_part_are_found_however_calm_the_beginning_was():
    drawn = _drawn(20261222, 200)  # for 0.5 % of the time no ball of this healthy bearing touches
    trace = simulate(drawn.scene, drawn.rate)
    exact = simulate(drawn.scene, drawn.rate, FixedSteps(128))
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_errors_that_grow_while_the_record_is_quiet_are_not_hidden_by_those_of_its_loud_part():
    drawn = _drawn(20261130, 2130)
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_errors_that_begin_to_grow_late_in_a_mode_that_decays_soon_are_found():
    drawn = _drawn(20261130, 1230)  # its slowest mode takes 30 ms, and growth begins after as long
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(128))
    assert trace.sensitivity > CHAOTIC
    assert _apart(trace, exact) <= trace.error_estimate


def test_errors_that_grow_late_where_a_single_ball_holds_the_ring_are_found():
    drawn = _drawn(20261225, 1900)  # calm for half a second, and a thousandfold after that
    trace = simulate(drawn.scene, drawn.rate)
    exact = simulate(drawn.scene, drawn.rate, FixedSteps(64))
    assert _apart(trace, exact) <= 1e-3
    assert trace.error_estimate <= 1e-3


def test_a_single_ball_s_growing_errors_are_found_where_a_coarse_response_happens_to_come_near():
    drawn = _drawn(20271201, 3684)  # its coarse response is two errors of its steps away, the truth twenty
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_errors_that_a_coarse_response_makes_too_are_found_where_they_grow():
    drawn = _drawn(20290101, 4826)  # both begin with the same steps, and what these miss grows a thousandfold
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, Accurate(1e-5))
    assert trace.sensitivity > CHAOTIC
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_rings_that_part_are_doubted_where_a_coarse_response_is_far_away():
    drawn = _drawn(777, 207)  # ten times as sensitive as its coarse response says
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(128))
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


@pytest.mark.parametrize("record", [3684, 4139])
def test_a_coarse_response_that_is_far_away_is_doubted_where_much_is_allowed_too(record):
    drawn = _drawn(20271201, record)  # the coarse response is 5 and 6 % away, less than twice and three times 3 %
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate, Accurate(3e-2))
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    assert _apart(trace, exact) <= trace.error_estimate <= 3e-2


def test_rings_that_part_are_not_marched_again_where_a_coarse_response_is_near(monkeypatch):
    drawn = _drawn(20271202, 735)
    scene = _shortened(drawn.scene, 0.1)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    monkeypatch.delattr(adaptive, "confirm_doubtful")
    trace = simulate(scene, drawn.rate)
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3


def test_steps_in_which_no_ball_touches_are_judged_before_errors_grow_on_them():
    drawn = _drawn(20270105, 3457)  # its rings part, and what a step in flight misses grows by some thousands
    scene = _shortened(drawn.scene, 0.1)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    assert not trace.chaotic
    assert _apart(trace, exact) <= trace.error_estimate <= 1e-3
