"""The package's slow reference method against closed forms and against the independent replay."""

import math

import numpy as np
import pytest
from reference_scenes import reference_scene_json
from replay import contact_sum, initial_state, read_machine, replay
from scipy.linalg import expm

from physics.cage import CagePath
from physics.catalog import rig
from physics.integrators.reference import integrate as reference
from physics.integrators.reference.integrate import integrate_reference
from physics.operation import Operation
from physics.outcome import Outcome, SimulationFailed
from physics.reference_scenes import reference_scene
from physics.request import FixedSteps, Reference
from physics.rms import relative_error
from physics.scene import Scene
from physics.simulate import simulate
from physics.spall import Spall

RATE = 65536.0
METHODS = "exponential_rk4", "runge_kutta4"
FAN = rig("fan")


def fan_scene(*spalls, duration=0.05, load=100.0, law="paper"):
    cage = CagePath(FAN.bearing.cage_speed(FAN.rated_speed), duration)
    return Scene(FAN, Operation(FAN.rated_speed, load), cage, spalls, contact_law=law)


def line_spall():
    return Spall("outer", 1, math.radians(270.0), math.radians(2.6), 12e-6, math.radians(0.3), math.radians(0.3))


def solve_line(times, law="paper"):
    scene = reference_scene_json("F1") | {"contact_law": law}
    start = initial_state(read_machine(scene), np.zeros(2))
    return read_machine(scene), integrate_reference(fan_scene(line_spall(), law=law), start, times)


def test_without_contact_the_reference_follows_the_matrix_exponential():
    start = np.zeros(12)
    start[[2, 5, 8, 11]] = 1e-7, -2e-7, 3e-4, 1e-4
    times = np.linspace(0.0, 4e-3, 9)
    found = integrate_reference(fan_scene(load=0.0), start, times)
    inverse = np.linalg.inv(FAN.mass_matrix())
    flow = np.block(
        [[np.zeros((6, 6)), np.eye(6)], [-inverse @ FAN.stiffness_matrix(), -inverse @ FAN.damping_matrix()]]
    )
    expected = np.array([expm(flow * t) @ start for t in times])
    error = np.abs(found.state - expected).max(axis=0) / np.maximum(np.abs(expected).max(axis=0), 1e-12)
    assert error.max() < 1e-7  # relative tolerance of 1e-9 a step, some 200 steps
    assert found.changes == []


@pytest.mark.parametrize("law", ["paper", "no_tension"])
def test_the_reference_agrees_with_the_independent_replay(law):
    scene = reference_scene_json("F1", duration=0.03) | {"contact_law": law}
    found = simulate(fan_scene(line_spall(), law=law, duration=0.03), RATE, Reference()).acceleration
    expected = replay(scene, substeps=64)["acceleration"]
    error = np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2))
    assert error < 2e-3  # the replay's own error: 5e-4 over half a second, more over a few passes


@pytest.mark.parametrize("name", ["G1", "G2", "F2"])
def test_the_reference_is_as_near_as_the_finest_steps_of_two_other_methods_can_tell(name):
    scene = reference_scene(name, 0.03)
    fine, other = (simulate(scene, RATE, FixedSteps(128, method)).acceleration for method in METHODS)
    assert relative_error(other, fine) < 5e-8
    assert relative_error(simulate(scene, RATE, Reference()).acceleration, fine) < 1.5e-7


def test_the_located_changes_happen_where_the_compression_is_zero():
    _, solution = solve_line(np.array([0.0, 0.03]))
    times = np.array([change[0] for change in solution.changes])
    machine, at_changes = solve_line(np.append(times, 0.03))
    machine = machine._replace(c_d=0.0, n=1.0, K=1.0)
    speed = FAN.bearing.cage_speed(FAN.rated_speed)
    assert times.size > 10
    for change, state in zip(solution.changes, at_changes.state, strict=False):
        compression = np.zeros((2, 14))
        contact_sum(machine._replace(c=machine.c - 1e-6), state, change[0], *cage_at(change[0], speed), compression)
        # The replay reads the taper by linear interpolation every 0.25 µm, which is up to 2.4e-11 m off.
        assert compression[change[1] - 1, change[2] - 1] == pytest.approx(1e-6, abs=3e-11)


def cage_at(time, speed):
    return np.full(2, speed * time), np.full(2, speed)


def test_every_ball_takes_turns_between_touching_and_not():
    _, solution = solve_line(np.array([0.0, 0.05]))
    touching = solution.initial.copy()
    for time, row, ball, made in solution.changes:
        assert 0.0 < time <= 0.05
        assert touching[row - 1, ball - 1] != made
        touching[row - 1, ball - 1] = made
    assert [change[0] for change in solution.changes] == sorted(change[0] for change in solution.changes)


def test_the_reference_gives_the_same_states_whatever_times_are_asked_for():
    _, often = solve_line(np.linspace(0.0, 0.02, 401))
    _, once = solve_line(np.array([0.005, 0.02]))
    np.testing.assert_array_equal(once.state, often.state[[100, 400]])


def test_the_reference_stops_with_a_typed_failure_when_its_steps_are_used_up(monkeypatch):
    monkeypatch.setattr(reference, "SPARE_STEPS", 0)
    monkeypatch.setattr(reference, "MOST_STEPS_PER_LONGEST", 1)
    with pytest.raises(SimulationFailed, match="used up its steps") as failure:
        solve_line(np.array([0.05]))
    assert failure.value.outcome is Outcome.TOO_MANY_CHANGES


def test_the_reference_stops_with_a_typed_failure_when_the_state_is_not_finite():
    start = np.zeros(12)
    start[6] = math.nan
    with pytest.raises(SimulationFailed, match="the reference method stopped") as failure:
        integrate_reference(fan_scene(), start, np.array([0.01]))
    assert failure.value.outcome is Outcome.NOT_FINITE
