"""A march that can be gone on with, and the one case that several share."""

import math
from dataclasses import replace

import numpy as np
import pytest

from physics.cage import CagePath
from physics.imperfections import Imperfections, Waviness
from physics.outcome import Outcome, SimulationFailed
from physics.response.goal import rms_distance, steady
from physics.response.modal_case import March, case_of
from physics.statics.load_distribution import require_equilibrium, resting

RATE, SAMPLES, SIZE = 65536.0, 400, 0.01


@pytest.fixture
def case(reference_scene):
    scene = reference_scene("G1", 0.02)
    return case_of(scene, resting(scene), RATE)


def test_a_march_gone_on_with_is_the_march_made_at_once(case):
    at_once = March(case, SAMPLES).go_on(steady(case, SAMPLES, 1e-3, SIZE)).acceleration
    march = March(case, SAMPLES)
    # The first part ends within a stride of the whole, so steps, not the response, may differ.
    march.go_on(steady(case, SAMPLES // 2, 1e-3, SIZE))
    in_parts = march.go_on(steady(case, SAMPLES, 1e-3, SIZE)).acceleration
    assert np.abs(in_parts - at_once).max() < 0.01 * np.abs(at_once).max()


def test_a_march_that_stops_being_finite_is_refused(case):
    lost = replace(case, start=np.where(np.arange(12) == 7, math.nan, case.start))
    with pytest.raises(SimulationFailed, match="stopped being finite") as failure:
        March(lost, SAMPLES).go_on(steady(lost, SAMPLES, 1e-3, SIZE))
    assert failure.value.outcome is Outcome.NOT_FINITE


@pytest.mark.parametrize("periods", [63, 64, 126])
def test_no_period_of_the_stiffness_hides_between_the_resting_positions(reference_scene, periods):
    scene = reference_scene("G1", 1.0)
    cage = CagePath(scene.cage.nominal_speed, periods * scene.rig.bearing.spacing / scene.cage.nominal_speed, 0.1)
    swing = resting(replace(scene, cage=cage)).stiffness[:, 1]
    long = require_equilibrium(replace(scene, cage=cage), np.linspace(0.0, cage.duration, 5001)).stiffness[:, 1]
    assert swing.std() == pytest.approx(long.std(), rel=0.3)
    assert swing.mean() == pytest.approx(long.mean(), rel=0.01)


@pytest.mark.parametrize("done", [0, 1000])
def test_a_march_is_the_same_while_another_of_its_case_runs(done, reference_scene):
    scene, samples = reference_scene("G1", 0.05), 3000
    alone, disturbed = (March(case_of(scene, resting(scene), RATE), samples) for _ in range(2))
    for march in (alone, disturbed):
        if done:
            march.go_on(steady(march.case, done, 1e-3, SIZE))
        if march is disturbed:
            # It ends where other balls touch.
            March(march.case, samples).go_on(steady(march.case, samples, 1e-4, SIZE))
        march.go_on(steady(march.case, samples, 1e-3, SIZE))
    np.testing.assert_array_equal(disturbed.output.acceleration, alone.output.acceleration)
    np.testing.assert_array_equal(disturbed.output.change_time, alone.output.change_time)


@pytest.mark.parametrize("name", ["G0", "F0"])
def test_two_marches_of_which_one_was_pushed_are_as_far_apart_as_such_errors_are_said_to_add_up_to(
    name, reference_scene
):
    scene, push = reference_scene(name, 0.05), 1e-5  # N s, between the rings
    case, samples = case_of(scene, resting(scene), RATE), round(0.05 * RATE)
    grid = steady(case, samples, 1e-7, SIZE)
    alone, pushed = March(case, samples).go_on(grid), March(case, samples, push=push).go_on(grid)
    pushed.spent[0] = push**2
    # A push half-way between x and y; what is said is of the direction that rings more.
    assert rms_distance(alone, pushed) == pytest.approx(case.pushed(pushed), rel=0.04)


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_no_step_takes_a_ball_over_more_than_half_of_the_shortest_wave(race, reference_scene):
    scene = reference_scene("G0", 0.02)
    waves = (Waviness(race, 7, 1e-7), Waviness(race, 40, 1e-8))
    scene = replace(scene, second_cage=CagePath(0.9 * scene.cage.nominal_speed, 0.02))
    wavy = replace(scene, imperfections=Imperfections(waves))
    turning = scene.operation.shaft_speed if race == "inner" else 0.0
    speed = max(abs(cage.nominal_speed - turning) for cage in scene.cages)
    assert case_of(wavy, resting(wavy), RATE).longest == pytest.approx(math.pi / (40 * speed), rel=1e-12)
    assert case_of(scene, resting(scene), RATE).longest == math.inf
