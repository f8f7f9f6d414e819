"""A march that can be gone on with, and the one case that several share."""

from dataclasses import replace

import numpy as np
import pytest

from physics.cage import CagePath
from physics.response.goal import steady
from physics.response.modal_case import March, case_of, resting
from physics.statics.stiffness import stiffness_trace

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


@pytest.mark.parametrize("periods", [63, 64, 126])
def test_no_period_of_the_stiffness_hides_between_the_resting_positions(reference_scene, periods):
    scene = reference_scene("G1", 1.0)
    cage = CagePath(scene.cage.nominal_speed, periods * scene.rig.bearing.spacing / scene.cage.nominal_speed, 0.1)
    swing = resting(replace(scene, cage=cage)).stiffness[:, 1]
    long = stiffness_trace(replace(scene, cage=cage), np.linspace(0.0, cage.duration, 5001))[:, 1]
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
