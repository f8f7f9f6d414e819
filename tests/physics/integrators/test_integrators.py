"""Order of convergence of the exponential Runge-Kutta march, smooth, with contact changes and over sharp edges."""

import dataclasses
import math

import numpy as np
import pytest
from smooth import always_in_contact

from physics.request import FixedSteps
from physics.rms import relative_error
from physics.simulate import simulate

RATE = 65536.0
FINEST = 96


def errors(scene, substeps):
    """Relative RMS error of the acceleration for each number of steps a sample, against a much finer run."""
    finest = simulate(scene, RATE, FixedSteps(FINEST)).acceleration
    runs = [simulate(scene, RATE, FixedSteps(count)).acceleration for count in substeps]
    return np.array([relative_error(run, finest) for run in runs])


def order(substeps, error):
    """Slope of the straight line through log error over log step."""
    return -np.polyfit(np.log(substeps), np.log(error), 1)[0]


def with_spall(scene, **changes):
    return dataclasses.replace(scene, spalls=(dataclasses.replace(scene.spalls[0], **changes),))


def with_bearing(scene, **changes):
    bearing = dataclasses.replace(scene.rig.bearing, **changes)
    return dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=bearing))


def test_the_order_is_4_where_every_ball_keeps_contact(reference_scene):
    scene = always_in_contact(reference_scene, 0.1)
    substeps = (2, 3, 4, 6, 8)
    error = errors(scene, substeps)
    slopes = -np.diff(np.log(error)) / np.diff(np.log(substeps))
    assert slopes == pytest.approx(4.0, abs=0.15)  # 4.13 to 4.04; from 12 steps on round-off is in sight


def test_the_order_is_4_on_the_extended_spall_where_no_ball_leaves_contact_abruptly(reference_scene):
    substeps = (1, 2, 3)
    error = errors(reference_scene("G2", 0.15), substeps)
    assert order(substeps, error) == pytest.approx(4.0, abs=0.15)  # from 4 steps on round-off is in sight


@pytest.mark.parametrize("name", ["F1", "G1s", "G1p", "F1p"])
def test_the_order_is_n_plus_1_where_balls_lose_and_make_contact(name, reference_scene):
    scene = reference_scene(name, 0.15)
    substeps = (1, 2, 3, 4, 6, 8, 12)
    expected = min(4.0, scene.rig.bearing.exponent + 1.0)
    assert order(substeps, errors(scene, substeps)) > expected - 0.1  # single slopes scatter with where steps fall


def test_the_order_with_rollers_is_that_of_their_softer_contact(reference_scene):
    scene = with_bearing(reference_scene("G1", 0.15), exponent=10.0 / 9.0, load_deflection=1e8)
    substeps = (1, 2, 3, 4, 6, 8, 12)
    assert order(substeps, errors(scene, substeps)) > 10.0 / 9.0 + 1.0 - 0.1


@pytest.mark.parametrize(
    "edges",
    [
        {"profile": "ball_path", "depth": 4e-6, "entry_taper": 0.0, "exit_taper": 0.0},
        {"depth": 4e-6, "entry_taper": 0.0, "exit_taper": 0.0},
        {"entry_taper": 0.0, "exit_taper": 0.0},
    ],
    ids=["kink where the floor begins", "step in contact", "step that ends contact"],
)
def test_edges_known_beforehand_cost_no_order(edges, reference_scene):
    substeps = (1, 2, 3, 4, 6)
    error = errors(with_spall(reference_scene("G1", 0.1), **edges), substeps)
    assert error[0] < 1e-4  # first order, as from edges met inside a step, starts at 1e-2
    assert order(substeps[1:], error[1:]) == pytest.approx(4.0, abs=0.15)  # 4.2 between one and two steps


@pytest.mark.parametrize("taper", [3e-4, 1e-4, 1e-5, 1e-6])
def test_an_edge_shorter_than_a_step_is_crossed_as_exactly_as_a_long_one(taper, reference_scene):
    scene = with_spall(reference_scene("G1", 0.05), entry_taper=taper, exit_taper=taper)
    step = 1.0 / RATE
    assert taper / scene.cage.mean_speed < 1.2 * step  # 1.1 steps to 0.4 % of one
    assert errors(scene, (1,))[0] < 2e-3  # a rise of 12 um in 56 ns is met with a force of 20 kN


def test_ten_times_the_rated_speed_leaves_the_error_of_the_fan_rigs_line_spall_below_1e_3(reference_scene):
    scene = reference_scene("F1", 0.05, speed_factor=10.0)
    assert errors(scene, (1,))[0] < 1e-3  # the goal at rated speed; a taper of 0.3 degrees lasts one step here


def test_half_the_step_of_one_run_is_the_step_of_the_other(reference_scene):
    scene = reference_scene("G1", 0.02)
    one, two = (simulate(scene, RATE, FixedSteps(count)) for count in (1, 2))
    assert one.step == 1.0 / RATE
    assert two.step == one.step / 2.0
    assert math.isnan(one.error_estimate)
