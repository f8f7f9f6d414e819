"""Records of rough spalls: a ball that leaps from bump to bump, and one that drops off an edge."""

import dataclasses

import numpy as np

from datagen.recipes.recipe import load_recipe
from datagen.scenarios.sampling import draw_scenario
from physics.integrators.modal.memory import STRIDES, ModalGrid
from physics.request import Accurate, FixedSteps
from physics.response.modal_case import March, case_of
from physics.rms import relative_error
from physics.simulate import simulate
from physics.statics.load_distribution import resting


def _drawn(seed, record):
    return draw_scenario(load_recipe("corpus").model_copy(update={"seed": seed}), record)


def test_a_ball_that_meets_a_bump_is_not_told_to_leave_it_at_the_same_instant():
    drawn = _drawn(20261226, 154)  # changes sides 42 000 times a second
    trace = simulate(drawn.scene, drawn.rate)
    changes = trace.changes
    order = np.lexsort((changes.time, changes.ball, changes.row))
    time, place = changes.time[order], np.stack([changes.row[order], changes.ball[order]])
    at_once = (np.diff(time) < 1e-12) & (np.diff(place) == 0).all(axis=0)
    assert not (at_once[1:] & at_once[:-1]).any()
    assert trace.unlocated_changes == 0


def _shortened(drawn, seconds=0.1):
    return dataclasses.replace(drawn.scene, cage=dataclasses.replace(drawn.scene.cage, duration=seconds))


def test_a_change_of_contact_that_comes_after_the_next_sample_does_not_pass_it_over():
    drawn = _drawn(20270101, 3074)  # a ball that is to let go just before a sample does so 30 ns behind it
    scene = _shortened(drawn)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    # At 2730.7 samples a ball touches 0.16 samples before a trial step, wrong by millions of tolerances, said it would.
    for accuracy in (3e-3, 1e-3, 3e-4, 1e-4):
        trace = simulate(scene, drawn.rate, Accurate(accuracy))
        error = relative_error(trace.acceleration, exact.acceleration)
        assert error <= trace.error_estimate <= accuracy
        assert trace.acceleration.any(axis=1).all()


def test_steps_to_the_end_of_a_contact_follow_the_bumps_behind_an_edge():
    drawn = _drawn(20261229, 4033)  # the film's force changes sides thrice between the edge and the loss of contact
    scene = _shortened(drawn)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(32))
    error = relative_error(trace.acceleration, exact.acceleration)
    assert error <= trace.error_estimate <= 1e-3


def test_a_step_whose_halves_add_up_to_a_corner_of_the_path_ends_there():
    drawn = _drawn(20270105, 4898)  # at 154.4 samples, by the tolerance of the coarser one of the two marches
    scene, samples, size = _shortened(drawn, 0.0052), round(0.0052 * drawn.rate), 8.56  # m/s², RMS of 0.1 s
    case = case_of(scene, resting(scene), drawn.rate)
    coarse, fine = (
        March(case, samples).go_on(
            ModalGrid(samples, 1.0 / drawn.rate, len(STRIDES), 0.0, share * size * case.push, 0.0, 1.0, 1e9)
        )
        for share in (1e-10, 1e-12)
    )
    # A corner that is passed over is wrong by some N over a thousandth of a sample: 8e-6 here, and 2e-8 without it.
    assert np.abs(coarse.acceleration - fine.acceleration).max() < 2e-7 * size


def test_a_ball_that_is_held_again_at_a_corner_of_the_path_is_taken_at_its_word():
    drawn = _drawn(20270105, 5695)  # without tension the force of a ball jumps past zero there, and is never near it
    scene = _shortened(drawn, 0.02)
    trace = simulate(scene, drawn.rate)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    error = relative_error(trace.acceleration, exact.acceleration)
    assert error <= trace.error_estimate <= 1e-3
    assert trace.unlocated_changes == 0


def test_bumps_between_the_instants_of_a_step_are_not_passed_over():
    drawn = _drawn(777, 3075)  # rolled over bumps some cells of its path long, where steps are as long
    scene = _shortened(drawn)
    exact = simulate(scene, drawn.rate, FixedSteps(64))
    for accuracy in (1e-3, 1e-4):  # 1.1e-3 and 4.1e-4 wrong if only the force at three instants is looked at
        trace = simulate(scene, drawn.rate, Accurate(accuracy))
        error = relative_error(trace.acceleration, exact.acceleration)
        assert error <= trace.error_estimate <= accuracy
