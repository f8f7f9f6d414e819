"""The linear motion of the modes and the weights of forces, against matrix exponentials."""

import dataclasses
import math

import numpy as np
import pytest
from axis_matrices import DAMPING, STIFFNESS, matrix, overdamped
from kernels import (
    reading,
    turn,
)
from scipy.linalg import expm

from physics.integrators.modal.error_growth import ringing
from physics.integrators.modal.flow import (
    AMPLITUDES,
    DISPLACEMENT,
    OUTER_ACCELERATION,
    OUTPUT,
    PER_AXIS,
    amplitudes_of,
    linear_flow,
    physical_state,
)
from physics.integrators.modal.layout import (
    AT_END,
    AT_HALF,
    HALF_POWERS,
    INSIDE_KICKS,
    INSIDE_OTHER,
    INSIDE_READINGS,
    INSIDE_TURN,
    INSIDE_WEIGHTS,
    KICKS,
    OTHER,
    POWERS,
    POWERS_AT,
    SECTION,
    STEP_WEIGHTS,
    TURN,
)
from physics.integrators.modal.weights import set_inside, set_step
from physics.motion import motion_model
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0
# Places of (xi, vi, xo, vo, xr, vr) of one axis in the state (12,).
PLACES = (0, 6, 2, 8, 4, 10)


@pytest.fixture
def quiet_flow(fan, build_scene):
    """Modes of the fan rig without a load, so that the state is that of the modes alone."""
    motion = motion_model(build_scene(fan, operation={"load": 0.0}))
    return linear_flow(motion, STIFFNESS, DAMPING)


def some_state():
    generator = np.random.default_rng(5)
    return np.concatenate([1e-6 * generator.standard_normal(6), 1e-2 * generator.standard_normal(6)])


@pytest.mark.parametrize("change", [lambda rig: rig, overdamped])
def test_amplitudes_give_back_the_state(fan, build_scene, change):
    scene = build_scene(change(fan), operation={"unbalance_force": 20.0, "load_fluctuation": 0.3})
    flow, state = linear_flow(motion_model(scene), STIFFNESS, DAMPING), some_state()
    found = np.empty(12)
    physical_state(flow, 0.0, amplitudes_of(flow, state), found)
    assert found == pytest.approx(state, rel=1e-9, abs=1e-14)  # condition of the modes' basis times round-off


def step_weights(flow, step):
    weights = np.empty(STEP_WEIGHTS)
    set_step(flow, weights, step, np.empty((2, POWERS + 1, AMPLITUDES)))
    return weights


def kicked(weights, first, stride, power):
    """Amplitudes (12,) that one power of the force adds."""
    places = first + power + POWERS * np.arange(PER_AXIS)
    return np.concatenate([weights[places], weights[stride + places]])


@pytest.mark.parametrize("change", [lambda rig: rig, overdamped])
@pytest.mark.parametrize("step", [1e-7, 1.0 / RATE, 8.0 / RATE])
def test_the_free_turn_is_the_matrix_exponential(fan, build_scene, step, change):
    rig = change(fan)
    flow = linear_flow(motion_model(build_scene(rig, operation={"load": 0.0})), STIFFNESS, DAMPING)
    end, found = np.empty(AMPLITUDES), np.empty(12)
    turn(step_weights(flow, step), TURN, OTHER, amplitudes_of(flow, some_state()), end)
    physical_state(flow, 0.0, end, found)
    for axis in range(2):
        here = [place + axis for place in PLACES]
        expected = expm(step * matrix(rig, axis)) @ some_state()[here]
        assert found[here] == pytest.approx(expected, rel=1e-7, abs=1e-12)  # round-off times the modes' condition


def pushed(rig, axis, step, power, until=1.0):
    """State (6,) of one axis at `until` of a step from rest under the contact force (t / step)^power, by expm."""
    chain = np.zeros((7 + power, 7 + power))
    chain[:6, :6] = matrix(rig, axis)
    chain[[1, 3], 6] = -1.0 / rig.inner_mass, 1.0 / rig.outer_mass
    # Entry 6 is the force; each of the following is the derivative of the one before, to the share of the step.
    for order in range(power):
        chain[6 + order, 7 + order] = 1.0 / step
    start = np.zeros(7 + power)
    start[-1] = math.factorial(power)
    return (expm(until * step * chain) @ start)[:6]


@pytest.mark.parametrize("power", range(POWERS))
@pytest.mark.parametrize("change", [lambda rig: rig, overdamped])
@pytest.mark.parametrize("step", [1e-7, 1.0 / RATE, 8.0 / RATE])
def test_every_power_of_the_force_does_what_the_matrix_exponential_says(fan, build_scene, step, change, power):
    rig, found = change(fan), np.empty(12)
    flow = linear_flow(motion_model(build_scene(rig, operation={"load": 0.0})), STIFFNESS, DAMPING)
    weights = step_weights(flow, step)
    physical_state(flow, 0.0, kicked(weights, KICKS, OTHER, power), found)
    for axis in range(2):
        expected = pushed(rig, axis, step, power)
        scale = np.abs(expected).max()
        assert found[[place + axis for place in PLACES]] == pytest.approx(expected, rel=1e-7, abs=1e-11 * scale)
        for first, until, powers in ((AT_END, 1.0, POWERS), (AT_HALF, 0.5, HALF_POWERS)):
            if power < powers:
                place = axis * OTHER + first + 2 * power
                xi, vi, xo, vo, _, _ = pushed(rig, axis, step, power, until)
                assert weights[place : place + 2] == pytest.approx([xi - xo, vi - vo], rel=1e-7, abs=1e-11 * scale)


def test_a_sample_inside_a_stride_is_the_exact_response_up_to_there(fan, quiet_flow):
    inside, found = np.empty((7, INSIDE_WEIGHTS)), np.empty(12)
    set_inside(quiet_flow, inside, 8.0 / RATE, np.empty((POWERS + 1, AMPLITUDES)))
    for k in range(1, 8):
        weights = step_weights(quiet_flow, k / RATE)
        for power in range(POWERS):
            kicks = kicked(inside[k - 1], INSIDE_KICKS, INSIDE_OTHER, power)
            physical_state(quiet_flow, 0.0, kicks, found)
            for axis in range(2):
                expected = pushed(fan, axis, 8.0 / RATE, power, k / 8)
                scale = np.abs(expected).max()
                assert found[[place + axis for place in PLACES]] == pytest.approx(expected, rel=1e-7, abs=1e-11 * scale)
                for section, row in enumerate(INSIDE_READINGS):
                    read = inside[k - 1, axis * INSIDE_OTHER + SECTION * section + POWERS_AT + power]
                    direct = (k / 8) ** power / fan.outer_mass if row == OUTER_ACCELERATION else 0.0
                    assert read - direct == pytest.approx(reading(quiet_flow, row, kicks, axis), rel=1e-9)
        for axis in range(2):
            here, there = axis * INSIDE_OTHER + INSIDE_TURN, axis * OTHER + TURN
            assert inside[k - 1, here : here + 12] == pytest.approx(weights[there : there + 12], abs=1e-13)


def test_the_ringing_of_a_push_is_the_energy_of_its_response(fan, quiet_flow):
    time = np.arange(0.0, 0.5, 1e-6)
    energy = []
    for axis in range(2):
        values, vectors = np.linalg.eig(matrix(fan, axis))
        start = np.linalg.solve(vectors, np.array([0, -1.0 / fan.inner_mass, 0, 1.0 / fan.outer_mass, 0, 0]))
        read = np.array([0, 0, fan.resonator_stiffness, fan.resonator_damping, -fan.resonator_stiffness,
                         -fan.resonator_damping]) / fan.resonator_mass  # fmt: skip
        response = sum((read @ vectors[:, k] * start[k] * np.exp(values[k] * time)).real for k in range(6))
        energy.append(np.sum(response**2) * 1e-6)
    assert ringing(quiet_flow, 10.0) == pytest.approx(max(energy), rel=1e-3)  # Riemann sum of 100 samples a period


def test_without_damping_a_push_rings_as_long_as_the_scene(fan, build_scene):
    free = dataclasses.replace(
        fan, film_damping=0.0, support_damping_x=0.0, support_damping_y=0.0, resonator_damping=0.0
    )
    motion = motion_model(build_scene(free, operation={"load": 0.0}))
    flow = linear_flow(motion, STIFFNESS, (0.0, 0.0))
    assert 0.0 < ringing(flow, 0.1) < np.inf
    assert ringing(flow, 0.2) == pytest.approx(2.0 * ringing(flow, 0.1), rel=1e-2)  # other modes' beats hardly count


def test_readings_are_what_the_state_gives(fan, quiet_flow):
    state = some_state()
    modal = amplitudes_of(quiet_flow, state)
    assert reading(quiet_flow, DISPLACEMENT, modal, 1) == pytest.approx(state[1] - state[3], rel=1e-9)
    spring = fan.resonator_stiffness * (state[3] - state[5]) + fan.resonator_damping * (state[9] - state[11])
    assert reading(quiet_flow, OUTPUT, modal, 1) == pytest.approx(spring / fan.resonator_mass, rel=1e-9)


def test_under_loads_that_turn_the_acceleration_inside_strides_is_that_of_the_states(gearbox, build_scene):
    # A preloaded bearing without spalls lets the method take strides of many samples.
    run = {"shaft_speed": 2.0 * math.pi * 50.0, "unbalance_force": 100.0}
    scene = build_scene(gearbox, bearing={"clearance": -10e-6}, operation=run)
    trace = simulate(scene, 65536.0, keep=Kept(state=True))

    xo, xr, vo, vr = (trace.state[:, part : part + 2] for part in (2, 4, 8, 10))
    rig = gearbox
    expected = (rig.resonator_stiffness * (xo - xr) + rig.resonator_damping * (vo - vr)) / rig.resonator_mass
    assert trace.acceleration == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
