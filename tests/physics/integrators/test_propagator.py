"""The exact linear part: its weights against matrix exponentials, and a free decay without contact."""

import dataclasses

import numpy as np
import pytest
from scipy.linalg import expm

from physics.cage import CagePath
from physics.integrators.output import Grid
from physics.integrators.propagator import (
    CUBE,
    FIRST,
    HALF,
    LAST,
    MIDDLE,
    TO_2_3,
    TO_3_4,
    TO_4,
    WEIGHT_ROWS,
    WHOLE,
    linear_matrix,
    power_series,
    reach,
    set_step,
)
from physics.motion import motion_model
from physics.operation import Operation
from physics.response.single_march import respond
from physics.scene import Scene
from physics.trace import Kept

OUTER_AND_RESONATOR = {0: [2, 8, 4, 10], 1: [3, 9, 5, 11]}


def unloaded_scene(machine, duration=0.01):
    """A shaft that floats in the middle of a large clearance, different supports along x and y."""
    bearing = dataclasses.replace(machine.bearing, clearance=1e-4)
    floating = dataclasses.replace(
        machine, bearing=bearing, support_stiffness_x=2.0 * machine.support_stiffness_x, support_damping_y=50.0
    )
    cage = CagePath(bearing.cage_speed(machine.rated_speed), duration)
    return Scene(floating, Operation(machine.rated_speed, 0.0), cage)


def matrix_by_hand(machine, axis):
    """L of (xo, vo, xr, vr) typed from the equations of motion."""
    mo, mr, kr, cr = (
        machine.outer_mass,
        machine.resonator_mass,
        machine.resonator_stiffness,
        machine.resonator_damping,
    )
    ko = (machine.support_stiffness_x, machine.support_stiffness_y)[axis]
    co = (machine.support_damping_x, machine.support_damping_y)[axis]
    outer = [-(ko + kr) / mo, -(co + cr) / mo, kr / mo, cr / mo]
    return np.array([[0.0, 1.0, 0.0, 0.0], outer, [0.0, 0.0, 0.0, 1.0], [kr / mr, cr / mr, -kr / mr, -cr / mr]])


def units(matrix):
    """Units (4,) of (xo, vo, xr, vr) in which the motion has entries of like size: velocities by the fastest mode."""
    fastest = np.abs(np.linalg.eigvals(matrix)).max()
    return np.array([1.0, fastest, 1.0, fastest])


def exponential(matrix, step):
    """exp(step · L), computed in balanced units."""
    unit = units(matrix)
    return expm(step * matrix * unit / unit[:, None]) * unit[:, None] / unit


def phi_kicks(matrix, step, outer_mass):
    """φm(step · L) b step for m = 1 to 4 as rows (4, 4): the corner of the exponential of an augmented matrix."""
    unit = units(matrix)
    chain = np.zeros((8, 8))
    chain[:4, :4] = step * matrix * unit / unit[:, None]
    chain[1, 4] = chain[4, 5] = chain[5, 6] = chain[6, 7] = 1.0
    return expm(chain)[:4, 4:].T * (step / outer_mass / unit[1]) * unit


@pytest.mark.parametrize("share", [1.0, 0.37, 1e-3])
@pytest.mark.parametrize("radians", [0.3, 1.0, 7.9])
@pytest.mark.parametrize("name", ["gearbox", "fan"])
def test_the_weights_of_a_step_are_krogstads_combinations_of_phi_functions(name, radians, share, request):
    scene = unloaded_scene(request.getfixturevalue(name))
    motion = motion_model(scene)
    full = radians / reach(motion, 1.0)
    step = share * full
    weights = np.zeros((2, WEIGHT_ROWS, 4))
    set_step(power_series(motion, full), weights, share)
    for axis in range(2):
        matrix = matrix_by_hand(scene.rig, axis)
        unit = units(matrix)
        one, two, three, four = phi_kicks(matrix, step, scene.rig.outer_mass)
        half_one, half_two, *_ = phi_kicks(matrix, step / 2.0, scene.rig.outer_mass)
        flow = np.concatenate([exponential(matrix, step), exponential(matrix, step / 2.0)[:2]])
        error = np.abs(weights[axis, WHOLE : HALF + 2] - flow) * unit / np.resize(unit, 6)[:, None]
        assert error.max() < 1e-12  # round-off of terms up to e^8 = 3000
        kicks = {
            FIRST: one - 3.0 * two + 4.0 * three,
            MIDDLE: 2.0 * two - 4.0 * three,
            LAST: 4.0 * three - two,
            TO_2_3: np.concatenate([half_one[:2], half_one[:2] - 2.0 * half_two[:2]]),
            TO_3_4: np.concatenate([2.0 * half_two[:2], one[:2] - 2.0 * two[:2]]),
            TO_4: 2.0 * two[:2],
            CUBE: four,
        }
        for row, expected in kicks.items():
            error = np.abs(weights[axis, row, : expected.size] - expected) / np.resize(unit, expected.size)
            assert error.max() < 1e-12 * np.abs(one / unit).max(), row  # the same round-off


def test_the_linear_matrix_is_that_of_the_equations_of_motion(gearbox):
    scene = unloaded_scene(gearbox)
    for axis in range(2):
        typed = matrix_by_hand(scene.rig, axis)
        assert linear_matrix(motion_model(scene), axis) == pytest.approx(typed, rel=1e-15)  # the same divisions


@pytest.mark.parametrize("radians", [0.05, 1.0, 7.9])
@pytest.mark.parametrize("name", ["gearbox", "fan"])
def test_without_contact_outer_ring_and_resonator_decay_as_the_matrix_exponential_for_any_step(name, radians, request):
    machine = request.getfixturevalue(name)
    scene = unloaded_scene(machine)
    step = radians / reach(motion_model(scene), 1.0)
    start = np.zeros(12)
    start[2:6], start[8:12] = [1e-6, -2e-6, 3e-6, 0.5e-6], [1e-3, 2e-3, -1e-2, 3e-2]
    samples = 100
    trace = respond(scene, start, Grid(samples, 1, step), "exponential_rk4", Kept(state=True))
    assert trace.changes.time.size == 0
    for axis, places in OUTER_AND_RESONATOR.items():
        matrix = matrix_by_hand(scene.rig, axis)
        one_step = exponential(matrix, step)
        exact = np.array([np.linalg.matrix_power(one_step, k) @ start[places] for k in range(samples)])
        largest = np.abs(exact).max(axis=0)
        error = np.abs(trace.state[:, places] - exact) / largest
        assert error.max() < 1e-10  # exact but for the round-off of 100 steps


def test_without_contact_and_load_the_shaft_flies_straight(gearbox):
    scene = unloaded_scene(gearbox)
    start = np.zeros(12)
    start[[0, 1, 6, 7]] = [1e-6, -1e-6, 1e-4, 2e-4]
    trace = respond(scene, start, Grid(100, 1, 1e-5), "exponential_rk4", Kept(state=True))
    time = 1e-5 * np.arange(100)
    straight = start[:2] + time[:, None] * start[6:8]
    assert trace.state[:, :2] == pytest.approx(straight, abs=1e-19)  # round-off of 1e-6 m
    assert np.all(trace.state[:, 2:6] == 0.0)
