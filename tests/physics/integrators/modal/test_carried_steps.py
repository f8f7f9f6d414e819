"""Steps that carry forces along: their order, and marches made of them."""

import dataclasses
import math

import numpy as np
import pytest
from axis_matrices import matrix
from kernels import (
    foretell,
    through_end,
    through_middle,
)
from scipy.linalg import expm

from physics.assembly import assemble
from physics.integrators.modal.flow import (
    amplitudes_of,
    physical_state,
)
from physics.integrators.modal.judgement import FOURTH_POWER_ERROR, REJECTED
from physics.integrators.modal.memory import STRIDES, ModalGrid, memory_for
from physics.integrators.modal.modal_march import begin, march_modal
from physics.integrators.modal.tables import tables_for
from physics.integrators.output import DONE, LOGGED
from physics.motion import motion_model, starting_state
from physics.response.kinks import known_kinks
from physics.response.modal_case import March, case_of, mean_flow
from physics.response.single_march import empty_output
from physics.rms import rms
from physics.statics.load_distribution import equilibrium, resting
from physics.trace import ACCELERATION_ALONE

RATE = 65536.0


@pytest.mark.parametrize("ratio", [0.25, 1.0, 2.0, 37.0])
def test_the_course_of_a_carried_step_runs_through_five_forces(ratio):
    force = np.polynomial.Polynomial([0.3, -1.2, 2.0, 0.7, -0.9])
    powers = foretell(force(-ratio), force(-0.5 * ratio), force(0.0), ratio)
    for share in (-ratio, -0.5 * ratio, 0.0):
        assert np.polyval([*powers[::-1], force(0.0)], share) == pytest.approx(force(share), rel=1e-12)
    powers = through_middle(force(0.0), *powers, force(0.5), ratio)
    powers = through_end(force(0.0), *powers, force(1.0), ratio)
    assert powers == pytest.approx(force.coef[1:], rel=1e-9)  # a quartic through five points is the quartic


def test_the_error_of_a_quartic_force_is_that_of_simpsons_rule():
    force = np.polynomial.Polynomial([0.0, 0.0, 0.0, 0.0, 1.0])
    simpson = (force(0.0) + 4.0 * force(0.5) + force(1.0)) / 6.0 - 1.0 / 5.0
    assert pytest.approx(simpson, rel=1e-12) == FOURTH_POWER_ERROR


def marched(scene, samples, interval):
    """Acceleration (samples, 2) by carried steps of one `interval` (s) throughout, from the static equilibrium."""
    contacts, motion = assemble(scene), motion_model(scene)
    flow = mean_flow(motion, resting(scene))
    grid = ModalGrid(samples, interval, 0, 0.0, 1e9, 0.0, 1.0, 1e9)
    start = amplitudes_of(flow, starting_state(motion, equilibrium(scene, np.zeros(1)).displacement[0]))
    output = empty_output(contacts, samples, 64, ACCELERATION_ALONE)
    memory = memory_for(flow, start, tables_for(flow, interval), contacts.balls.shape)
    begin(contacts, flow, grid, memory, output)
    assert march_modal(contacts, flow, grid, known_kinks(scene, contacts), memory, output) == DONE
    assert output.tally[LOGGED] == 0
    return output.acceleration


def test_carried_steps_are_of_order_five_while_no_contact_changes(fan, build_scene):
    scene = build_scene(
        fan, bearing={"clearance": -20e-6}, operation={"load": 2000.0, "unbalance_force": 800.0}
    )  # loaded all round, and shaken hard so that the error is far above round-off
    fine = marched(scene, 8193, 1.0 / RATE / 64.0)[::64]
    errors = [rms(marched(scene, 128 * k + 1, 1.0 / k / RATE)[::k] - fine) for k in (1, 2, 4)]
    assert -np.diff(np.log2(errors)) == pytest.approx(5.0, abs=0.1)


LOAD, THROW = 500.0, 0.05


@pytest.fixture
def flight(fan, build_scene):
    """A fan rig whose shaft is thrown up from the middle of its clearance: its case on a grid of `interval` (s), and
    the exact state (7,) of (xi, vi, xo, vo, xr, vr, 1) along y after some seconds, by the matrix exponential."""
    scene = build_scene(fan, bearing={"clearance": 40e-6}, operation={"load": LOAD})
    rest, start, free = resting(scene), np.zeros(12), np.zeros((7, 7))
    start[7] = THROW
    free[:6, :6], free[1, 6] = matrix(fan, 1, 0.0, 0.0), -LOAD / fan.inner_mass
    begin = np.array([0.0, THROW, 0.0, 0.0, 0.0, 0.0, 1.0])
    return (
        lambda interval: dataclasses.replace(case_of(scene, rest, 1.0 / interval), start=start),
        lambda time: expm(time * free) @ begin,
    )


def test_a_step_that_knows_none_before_it_is_of_order_four(flight):
    case_on, exact = flight
    errors = []
    for interval in (1.0 / RATE, 0.5 / RATE, 0.25 / RATE):
        case, state = case_on(interval), np.empty(12)
        march = March(case, 2)
        march.go_on(ModalGrid(2, interval, 0, 0.0, 1e9, 0.0, 1.0, 1e9))
        physical_state(case.flow, interval, march._memory.states[0], state)
        errors.append(abs(state[7] - exact(interval)[1]))
    assert -np.diff(np.log2(errors)) == pytest.approx(5.0, abs=0.2)  # of one step, one more than of many


@pytest.mark.parametrize("push", [1e-8, 1e-10, 1e-12])
def test_steps_in_which_no_ball_touches_are_as_exact_as_was_asked_for(flight, fan, push):
    case_on, exact = flight
    read = np.array([0, 0, fan.resonator_stiffness, fan.resonator_damping, -fan.resonator_stiffness,
                     -fan.resonator_damping, 0]) / fan.resonator_mass  # fmt: skip
    output = March(case_on(1.0 / RATE), 10).go_on(ModalGrid(10, 1.0 / RATE, len(STRIDES), 0.0, push, 0.0, 1.0, 1e9))
    assert output.tally[LOGGED] == 0  # no ball has touched
    # What one such push (N s) of the outer ring leaves in the resonator's acceleration at most.
    most = push / fan.outer_mass * math.sqrt(fan.resonator_stiffness / fan.resonator_mass)
    error = np.abs(output.acceleration[:, 1] - [read @ exact(k / RATE) for k in range(10)]).max()
    assert error < REJECTED * most  # a step may be wrong by so many times what was asked for


def test_a_march_that_pauses_goes_on_as_if_it_had_not(reference_scene, reference_trace):
    scene, samples = reference_scene("F1", 0.1), round(0.1 * RATE)
    grid = ModalGrid(samples, 1.0 / RATE, len(STRIDES), 0.0, 1e-9, 0.0, 1.0, 1e9)
    once, paused = (March(case_of(scene, resting(scene), RATE), samples) for _ in range(2))
    once.go_on(grid)
    for until in (1, 700, 701, 2048, samples):
        paused.go_on(grid._replace(samples=until))
    fine = reference_trace("F1", 0.1, 16)
    for march in (once, paused):
        assert rms(march.output.acceleration - fine.acceleration) < 1e-3 * rms(fine.acceleration)  # 1e-9 N s a step
        assert march.output.tally[LOGGED] == fine.changes.time.size
