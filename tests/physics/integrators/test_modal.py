"""The modal method: its linear part against matrix exponentials, its choice of steps against fine fixed ones."""

import dataclasses
import math
from operator import attrgetter

import numpy as np
import pytest
from kernels import (
    foretell,
    has_relief,
    mark_grazing,
    note_motion,
    press,
    reading,
    reset_contact,
    set_time,
    through_end,
    through_middle,
    touches,
    turn,
)
from scipy.linalg import expm

from physics.assembly import assemble
from physics.cage import CagePath
from physics.contact.forces import ACTIVE, COMPRESSION
from physics.imperfections import Imperfections, Waviness
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
from physics.integrators.modal.judgement import FOURTH_POWER_ERROR, REJECTED, may_shrink
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
from physics.integrators.modal.memory import STRIDES, ModalGrid, memory_for
from physics.integrators.modal.modal_march import begin, march_modal
from physics.integrators.modal.tables import tables_for
from physics.integrators.modal.weights import set_inside, set_step
from physics.integrators.output import DONE, LOGGED
from physics.motion import motion_model, starting_state
from physics.paths.profile import build_path
from physics.request import Accurate, FixedSteps, Reference
from physics.response.kinks import known_kinks
from physics.response.modal_case import March, case_of, mean_flow
from physics.response.single_march import empty_output
from physics.rms import relative_error, rms
from physics.simulate import simulate
from physics.statics.load_distribution import equilibrium, resting
from physics.trace import ACCELERATION_ALONE, Kept

RATE = 65536.0
STIFFNESS, DAMPING = (60e6, 95e6), (300.0, 500.0)
# Places of (xi, vi, xo, vo, xr, vr) of one axis in the state (12,).
PLACES = (0, 6, 2, 8, 4, 10)


def matrix(rig, axis, k=None, c=None):
    """(6, 6) of one axis, written down from the equations of motion with a spring and a damper for the balls."""
    k, c = STIFFNESS[axis] if k is None else k, DAMPING[axis] if c is None else c
    ko, co = (rig.support_stiffness_x, rig.support_damping_x) if axis == 0 else (
        rig.support_stiffness_y, rig.support_damping_y
    )  # fmt: skip
    stiff = np.array([[k, -k, 0], [-k, k + ko + rig.resonator_stiffness, -rig.resonator_stiffness],
                      [0, -rig.resonator_stiffness, rig.resonator_stiffness]])  # fmt: skip
    damp = np.array([[c, -c, 0], [-c, c + co + rig.resonator_damping, -rig.resonator_damping],
                     [0, -rig.resonator_damping, rig.resonator_damping]])  # fmt: skip
    mass = np.array([rig.inner_mass, rig.outer_mass, rig.resonator_mass])[:, None]
    full = np.zeros((6, 6))
    full[0::2, 1::2] = np.eye(3)
    full[1::2, 0::2], full[1::2, 1::2] = -stiff / mass, -damp / mass
    return full


@pytest.fixture
def quiet_flow(fan, build_scene):
    """Modes of the fan rig without a load, so that the state is that of the modes alone."""
    motion = motion_model(build_scene(fan, operation={"load": 0.0}))
    return linear_flow(motion, STIFFNESS, DAMPING)


def some_state():
    generator = np.random.default_rng(5)
    return np.concatenate([1e-6 * generator.standard_normal(6), 1e-2 * generator.standard_normal(6)])


def overdamped(rig):
    return dataclasses.replace(
        rig, resonator_damping=3.0 * 2.0 * math.sqrt(rig.resonator_mass * rig.resonator_stiffness)
    )


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


def test_readings_are_what_the_state_gives(fan, quiet_flow):
    state = some_state()
    modal = amplitudes_of(quiet_flow, state)
    assert reading(quiet_flow, DISPLACEMENT, modal, 1) == pytest.approx(state[1] - state[3], rel=1e-9)
    spring = fan.resonator_stiffness * (state[3] - state[5]) + fan.resonator_damping * (state[9] - state[11])
    assert reading(quiet_flow, OUTPUT, modal, 1) == pytest.approx(spring / fan.resonator_mass, rel=1e-9)


SCENES = ("G1", "G1p", "G2r", "F0", "F1", "F1s", "F2", "F2r")


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("accuracy", [1e-4, 2e-3])
def test_the_accuracy_asked_for_is_kept_and_the_error_known(name, accuracy, reference_scene, reference_trace):
    fine = reference_trace(name, 0.1, 16).acceleration
    trace = simulate(reference_scene(name, 0.1), RATE, Accurate(accuracy))
    error = relative_error(trace.acceleration, fine)
    assert error < accuracy
    assert trace.error_estimate < accuracy
    assert error < 4.0 * trace.error_estimate  # pushes are counted as if they were noise


def test_an_exact_response_is_as_exact_where_a_ball_is_lost_right_behind_an_edge(reference_scene):
    scene = reference_scene("F1", 0.12)
    speed = 3.0 * scene.operation.shaft_speed
    fast = dataclasses.replace(
        scene,
        operation=dataclasses.replace(scene.operation, shaft_speed=speed),
        cage=dataclasses.replace(scene.cage, nominal_speed=scene.rig.bearing.cage_speed(speed)),
    )
    fine = simulate(fast, RATE, FixedSteps(32)).acceleration
    trace = simulate(fast, RATE, Accurate(1e-5))
    assert rms(trace.acceleration - fine) < 1e-5 * rms(fine)  # 2e-5 or more if such steps are not judged


def variants(reference_scene):
    scene = reference_scene("F1", 0.08)
    bearing = scene.rig.bearing
    roller = dataclasses.replace(bearing, exponent=10.0 / 9.0, load_deflection=bearing.load_deflection * 4e-3)
    waves = (Waviness("outer", 11, 2e-7, 0.3), Waviness("inner", 5, 3e-7, 1.0))
    uneven = tuple(tuple(1e-7 * math.sin(3 * ball + row) for ball in range(bearing.balls)) for row in range(2))
    sharp = dataclasses.replace(scene.spalls[0], entry_taper=0.0, exit_taper=0.0)
    return {
        "without tension": dataclasses.replace(scene, contact_law="no_tension"),
        "rollers": dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, bearing=roller)),
        "edges without tapers": dataclasses.replace(scene, spalls=(sharp,)),
        "two cages": dataclasses.replace(scene, second_cage=scene.cage),
        "turning loads": dataclasses.replace(
            scene, operation=dataclasses.replace(scene.operation, unbalance_force=30.0, load_fluctuation=0.2)
        ),
        "waves and unequal balls": dataclasses.replace(scene, imperfections=Imperfections(waves, uneven)),
        "an overdamped resonator": dataclasses.replace(scene, rig=overdamped(scene.rig)),
    }


@pytest.mark.parametrize(
    "name",
    [
        "without tension",
        "rollers",
        "edges without tapers",
        "two cages",
        "turning loads",
        "waves and unequal balls",
        "an overdamped resonator",
    ],
)
def test_the_accuracy_is_kept_on_scenes_of_every_kind(name, reference_scene):
    scene = variants(reference_scene)[name]
    fine = simulate(scene, RATE, FixedSteps(16)).acceleration
    trace = simulate(scene, RATE)
    assert rms(trace.acceleration - fine) < 1e-3 * rms(fine)


@pytest.mark.parametrize("name", ["a line spall", "turning loads"])
def test_what_else_is_kept_moves_no_bit_and_agrees_with_fixed_steps(name, reference_scene):
    scene = variants(reference_scene).get(name, reference_scene("F1", 0.05))
    alone = simulate(scene, RATE)
    trace = simulate(scene, RATE, keep=Kept(state=True, force=True, outer=True))
    fine = simulate(scene, RATE, FixedSteps(8), keep=Kept(state=True, force=True, outer=True))
    assert np.array_equal(alone.acceleration, trace.acceleration)
    assert alone.contact_force is None
    for name in ("state", "contact_force", "outer.displacement", "outer.velocity", "outer.acceleration"):
        here, there = (attrgetter(name)(each) for each in (trace, fine))
        assert rms(here - there) < 1e-3 * rms(there), name  # the accuracy asked for, of the resonator's acceleration


@pytest.mark.parametrize(
    ("name", "slip_seed", "accuracies"),
    [
        ("G1", None, (1e-5, 1e-4, 1e-3, 1e-2)),
        (
            "F0",
            1,
            (1e-3, 2e-3, 3e-3, 4e-3, 6e-3, 1e-2),
        ),  # once lost to steps with short rests
    ],
)
def test_more_accuracy_takes_shorter_steps(name, slip_seed, accuracies, reference_scene):
    scene = reference_scene(name, 0.1, slip_seed=slip_seed)
    steps = [simulate(scene, RATE, Accurate(accuracy)).step * RATE for accuracy in accuracies]
    assert all(np.diff(steps) > 0.0)
    assert steps[0] > 1.0 / 16.0


def test_a_beginning_too_coarse_for_the_scene_is_made_again(reference_scene):
    scene = reference_scene("G1", 0.04)  # of which the beginning that says how sensitive the scene is takes four fifths
    scene = dataclasses.replace(scene, rig=dataclasses.replace(scene.rig, film_damping=1e4))
    fine = simulate(scene, RATE, FixedSteps(64)).acceleration
    assert rms(simulate(scene, RATE).acceleration - fine) < 0.7e-3 * rms(fine)  # 1.7e-3 if it is kept


def test_an_error_that_is_always_allowed_spares_steps(reference_scene):
    scene = reference_scene("G1", 0.1)
    strict, lax = simulate(scene, RATE, Accurate(1e-5)), simulate(scene, RATE, Accurate(1e-5, least_error=0.01))
    assert lax.step > 2.0 * strict.step
    assert rms(lax.acceleration - strict.acceleration) < 0.01


@pytest.mark.parametrize("load", [20.0, 60.0])
def test_a_touch_of_a_rough_spall_shorter_than_a_step_is_not_passed_over(load, reference_scene):
    scene = reference_scene("F2r", 0.06)
    operation = dataclasses.replace(scene.operation, load=load, shaft_speed=4.0 * scene.operation.shaft_speed)
    cage = dataclasses.replace(scene.cage, nominal_speed=4.0 * scene.cage.nominal_speed)
    scene = dataclasses.replace(scene, operation=operation, cage=cage, contact_law="no_tension")
    trace, fine = simulate(scene, RATE), simulate(scene, RATE, FixedSteps(32))
    assert trace.changes.time.size == fine.changes.time.size
    assert rms(trace.acceleration - fine.acceleration) < 1e-3 * rms(fine.acceleration)


@pytest.mark.parametrize(("name", "speed", "load"), [("F1s", 3.0, 0.3), ("F2r", 1.0, 3.0)])
def test_a_ball_that_changes_sides_and_back_within_a_step_is_not_passed_over(name, speed, load, reference_scene):
    scene = reference_scene(name, 0.1, speed_factor=speed)
    scene = dataclasses.replace(scene, operation=dataclasses.replace(scene.operation, load=load * scene.operation.load))
    found = simulate(scene, RATE, Accurate(repeat=False)).changes
    fine = simulate(scene, RATE, FixedSteps(32)).changes
    assert found.time.size == fine.time.size
    here, there = (np.lexsort((changes.time, changes.ball, changes.row)) for changes in (found, fine))
    assert np.array_equal(found.ball[here], fine.ball[there])
    assert np.abs(found.time[here] - fine.time[there]).max() < 0.1 / RATE  # of changes, not of their pairs


@pytest.mark.slow
def test_the_crest_of_a_wave_shorter_than_a_sample_is_not_passed_over(fan, build_scene):
    speed = 20000.0 * math.pi / 30.0
    operation, waves = {"shaft_speed": speed, "load": 100.0}, (Waviness("inner", 500, 1e-6),)
    cage = CagePath(nominal_speed=fan.bearing.cage_speed(speed), duration=0.05)
    scene = build_scene(fan, operation=operation, cage=cage, imperfections=Imperfections(waves))
    trace, fine = simulate(scene, RATE), simulate(scene, RATE, FixedSteps(32, "dormand_prince"))
    assert rms(trace.acceleration - fine.acceleration) < 1e-3 * rms(fine.acceleration)


def test_a_ball_that_touches_between_two_looks_at_a_rough_path_is_seen(reference_scene):
    scene = reference_scene("F2r", 0.2)
    spall, bearing, step = scene.spalls[0], scene.rig.bearing, 1.0 / RATE
    contacts, generator = assemble(scene), np.random.default_rng(1)
    noted, suspects = np.zeros((1, 2, contacts.balls.shape[2])), np.zeros((1, contacts.balls.shape[2]))
    shares, tried = np.linspace(0.0, 1.0, 65), 0

    def compression(share, across, ball):
        set_time(contacts, begin + share * step)
        press(contacts, 0.0, across, 0.0, 0.0)
        return contacts.balls[0, COMPRESSION, ball]

    while tried < 60:
        begin = generator.uniform(0.0, 0.19)
        angles = scene.cage.angle(np.array([begin])) + bearing.spacing * np.arange(bearing.balls) - spall.angle
        inside = np.abs((angles + np.pi) % (2.0 * np.pi) - np.pi) < 0.45 * spall.extent
        if not inside.any():
            continue
        ball = int(inside.argmax())
        course = np.array([compression(share, -1e-5, ball) for share in shares])
        top, ends = course[1:-1].max(), max(course[0], course[-1])
        if top <= ends:
            continue
        # The rings are moved until the ball is apart at both ends of the step and touches for an instant on the way.
        lift = generator.uniform(0.05, 0.5) * (top - ends)
        summit = shares[1 + course[1:-1].argmax()]
        yielding = (compression(summit, -1.01e-5, ball) - compression(summit, -1e-5, ball)) / -1e-7
        across = -1e-5 + (lift - top) / yielding
        apart = compression(0.0, across, ball) <= 0.0
        reset_contact(contacts)
        note_motion(contacts.balls, noted)
        if not apart or compression(1.0, across, ball) > 0.0:
            continue
        suspects[:] = 0.0
        mark_grazing(contacts, noted, begin, step, suspects)
        assert 0.0 < suspects[0, ball] < 1.0
        tried += 1


def test_a_ball_that_is_pressed_all_at_once_at_a_corner_of_its_path_is_seen_there(reference_scene):
    scene = reference_scene("F2r", 0.2)
    rolled = dataclasses.replace(scene.spalls[0], profile="ball_path", depth=20e-6)
    scene, step = dataclasses.replace(scene, spalls=(rolled,), contact_law="no_tension"), 1.0 / RATE
    bearing, path, contacts = scene.rig.bearing, build_path(rolled, scene.rig.bearing), assemble(scene)
    noted, suspects = np.zeros((1, 2, contacts.balls.shape[2])), np.zeros((1, contacts.balls.shape[2]))
    speed, generator, tried, compressed = scene.cage.mean_speed, np.random.default_rng(2), 0, 1e-8

    def pressed(time, across, falling, ball):
        set_time(contacts, time)
        press(contacts, 0.0, across, 0.0, falling)
        return touches(contacts, 0, ball)

    for corner in path.breaks[1:-1][np.abs(path.breaks[1:-1]) < 0.2]:
        ball, share = int(generator.integers(bearing.balls)), generator.uniform(0.05, 0.2)
        met = (rolled.angle + corner - bearing.spacing * ball) % (2.0 * np.pi) / speed
        if met > 0.19:
            continue
        before, behind = path.slope(corner + np.array([-1e-9, 1e-9]))
        # The ring leaves the ball so fast that the film just lets go of it before the corner, and presses it behind.
        spring = contacts.law.stiffness * compressed**bearing.exponent
        rate = -spring / contacts.law.damping + speed * (before + behind) / 2.0
        sine = np.sin(rolled.angle + corner)
        drop = path.depth(np.array([corner]))[0]
        across, falling, begin = (compressed + drop + bearing.clearance) / sine, rate / sine, met - share * step
        shares = np.linspace(0.0, 1.0, 2001)
        seen = [pressed(begin + s * step, across + (s - share) * step * falling, falling, ball) for s in shares]
        if not any(seen) or abs(shares[np.argmax(seen)] - share) > 1e-3:
            continue
        pressed(begin, across - share * step * falling, falling, ball)
        contacts.balls[:, ACTIVE] = 0.0
        note_motion(contacts.balls, noted)
        pressed(begin + step, across + (1.0 - share) * step * falling, falling, ball)
        suspects[:] = 0.0
        mark_grazing(contacts, noted, begin, step, suspects)
        assert suspects[0, ball] == pytest.approx(share, abs=1e-3)
        tried += 1
    assert tried > 10


def test_the_relief_of_a_path_bounds_how_far_it_strays_from_any_chord(reference_scene):
    scene = reference_scene("F2r", 0.01)
    path = build_path(scene.spalls[0], scene.rig.bearing)
    generator = np.random.default_rng(8)
    for level in range(path.relief.size - 1):
        width = path.cell * 2**level
        left = generator.uniform(path.breaks[0], path.breaks[-1] - width, 200)
        share = np.linspace(0.0, 1.0, 33)
        depth = path.depth((left[:, None] + share * width).ravel()).reshape(200, 33)
        chord = depth[:, :1] + share * (depth[:, -1:] - depth[:, :1])
        assert np.abs(depth - chord).max() <= 1.1 * path.relief[level]  # the bound sums what grid points stray
    assert np.all(np.diff(path.relief) >= 0.0)


def test_a_smooth_path_has_no_relief_and_is_not_searched(reference_scene):
    scene = reference_scene("G2", 0.01)
    assert not build_path(scene.spalls[0], scene.rig.bearing).relief.any()
    assert not has_relief(assemble(scene).track)
    assert has_relief(assemble(reference_scene("G2r", 0.01)).track)


def test_no_step_is_taken_back_for_ever():
    grid = ModalGrid(100, 1.0 / RATE, 3, 1e-9, 1e-9, 1.0, 512.0, 1.0)
    step, halvings = 8.0 / RATE, 0
    while may_shrink(grid, step):
        step, halvings = 0.5 * step, halvings + 1
    assert halvings <= 14  # from eight samples to a sixty-fourth of a unit, 2^13 times shorter


def test_the_finest_accuracy_that_may_be_asked_for_is_answered(reference_scene):
    scene = reference_scene("G1", 0.02)
    found, exact = simulate(scene, RATE, Accurate(1e-6)), simulate(scene, RATE, Reference())
    apart = relative_error(found.acceleration, exact.acceleration)
    assert apart < 1e-6
    assert found.error_estimate <= 1e-6


def test_the_sensitivity_of_a_tame_scene_is_small(reference_scene):
    trace = simulate(reference_scene("G1", 0.1), RATE)
    assert 0.0 < trace.sensitivity < 10.0
    assert not trace.chaotic


def test_under_loads_that_turn_the_acceleration_inside_strides_is_that_of_the_states(gearbox, build_scene):
    # A preloaded bearing without spalls lets the method take strides of many samples.
    run = {"shaft_speed": 2.0 * math.pi * 50.0, "unbalance_force": 100.0}
    scene = build_scene(gearbox, bearing={"clearance": -10e-6}, operation=run)
    trace = simulate(scene, 65536.0, keep=Kept(state=True))

    xo, xr, vo, vr = (trace.state[:, part : part + 2] for part in (2, 4, 8, 10))
    rig = gearbox
    expected = (rig.resonator_stiffness * (xo - xr) + rig.resonator_damping * (vo - vr)) / rig.resonator_mass
    assert trace.acceleration == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
