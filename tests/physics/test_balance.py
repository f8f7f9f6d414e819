"""Impulse and energy balances of the response, and symmetries that it must have."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import simpson

from physics.cage import CagePath
from physics.integrators.output import Grid
from physics.operation import Operation
from physics.request import FixedSteps
from physics.response.single_march import respond
from physics.rms import rms
from physics.simulate import simulate
from physics.trace import Kept

RATE = 65536.0
FINE_RATE = 2.0**20


def ball_directions(scene, time):
    """Cosine and sine of every ball's angle, (T, rows, balls) each."""
    bearing = scene.rig.bearing
    row, ball = np.meshgrid(np.arange(bearing.rows), np.arange(bearing.balls), indexing="ij")
    offset = 2.0 * np.pi * ball / bearing.balls + np.pi * row / bearing.balls
    angle = scene.cage.start_angle + scene.cage.mean_speed * time[:, None, None] + offset
    return np.cos(angle), np.sin(angle)


@pytest.fixture(scope="module")
def fine_run(reference_scene):
    """The gearbox rig's line spall under a load of shaft order too, finely sampled with states and forces."""
    still = reference_scene("G1", 0.06)
    run = dataclasses.replace(still.operation, unbalance_force=40.0, unbalance_phase=0.7, load_fluctuation=0.2)
    scene = dataclasses.replace(still, operation=run)
    return scene, simulate(scene, FINE_RATE, FixedSteps(1), keep=Kept(state=True, force=True, outer=True))


def outer_loads(scene, time):
    """Load on the shaft (T, 2), N."""
    run = scene.operation
    turn = run.shaft_speed * time
    static = run.load * (1.0 + run.load_fluctuation * np.cos(turn + run.fluctuation_phase))
    spin = turn + run.unbalance_phase
    return np.column_stack([run.unbalance_force * np.cos(spin), run.unbalance_force * np.sin(spin) - static])


def contact_sums(scene, trace):
    """Force of all balls on the outer ring (T, 2), N."""
    cosine, sine = ball_directions(scene, trace.time)
    return np.stack([(trace.contact_force * part).sum(axis=(1, 2)) for part in (cosine, sine)], axis=1)


def test_the_impulse_of_loads_and_supports_is_the_change_of_the_whole_machines_momentum(fine_run):
    scene, trace = fine_run
    rig = scene.rig
    position, velocity = trace.state[:, :6].reshape(-1, 3, 2), trace.state[:, 6:].reshape(-1, 3, 2)
    momentum = velocity.transpose(0, 2, 1) @ np.array([rig.inner_mass, rig.outer_mass, rig.resonator_mass])
    support = rig.support_stiffness_x * position[:, 1] + rig.support_damping_x * velocity[:, 1]
    impulse = simpson(outer_loads(scene, trace.time) - support, dx=1.0 / FINE_RATE, axis=0)
    scale = np.abs(momentum).max()
    assert momentum[-1] - momentum[0] == pytest.approx(impulse, abs=1e-7 * scale)  # Simpson's rule over jumps


def test_the_impulse_of_load_and_contacts_is_the_change_of_the_shafts_momentum(fine_run):
    scene, trace = fine_run
    momentum = scene.rig.inner_mass * trace.state[:, 6:8]
    push = outer_loads(scene, trace.time) - contact_sums(scene, trace)
    impulse = simpson(push, dx=1.0 / FINE_RATE, axis=0)
    # A film force of some N that jumps at a change of contact is known to half a sample, 0.5 us, a few dozen times.
    assert momentum[-1] - momentum[0] == pytest.approx(impulse, abs=2e-5)
    assert np.abs(momentum).max() > 100.0 * 2e-5


def test_the_recorded_acceleration_is_the_resonators_own(fine_run):
    _, trace = fine_run
    velocity = trace.state[:, 10:12]
    # Simpson's rule over two samples; where a film force jumps, the rate of the resonator's force does too.
    gained = (trace.acceleration[:-2] + 4.0 * trace.acceleration[1:-1] + trace.acceleration[2:]) / (3.0 * FINE_RATE)
    assert velocity[2:] - velocity[:-2] == pytest.approx(gained, abs=1e-6 * np.abs(velocity).max())


def test_the_outer_rings_mass_times_its_acceleration_is_the_sum_of_the_forces_on_it(fine_run):
    scene, trace = fine_run
    rig = scene.rig
    place, speed = trace.state[:, 2:4], trace.state[:, 8:10]
    support = np.array([rig.support_stiffness_x, rig.support_stiffness_y]) * place
    support = support + np.array([rig.support_damping_x, rig.support_damping_y]) * speed
    resonator = rig.resonator_stiffness * (place - trace.state[:, 4:6])
    resonator = resonator + rig.resonator_damping * (speed - trace.state[:, 10:12])
    forces = contact_sums(scene, trace) - support - resonator
    # Rounding, and the nanosecond by which a step that ends at a change of contact stands beside its sample.
    assert rig.outer_mass * trace.outer.acceleration == pytest.approx(forces, abs=1e-9 * np.abs(forces).max())
    assert np.array_equal(trace.outer.displacement, place)
    assert np.array_equal(trace.outer.velocity, speed)


def still_scene(reference_scene, law):
    """A cage and a shaft that as good as stand still, a ball in the middle of the line spall."""
    scene = reference_scene("G1", 0.05)
    crawl = CagePath(1e-12, scene.duration)
    return dataclasses.replace(scene, operation=Operation(1e-12, 346.0), cage=crawl, contact_law=law)


def energy(scene, state):
    """Kinetic, elastic and load energy (T,) of the states (T, 12), J; ball angles are those at t = 0."""
    rig, bearing = scene.rig, scene.rig.bearing
    masses = np.repeat([rig.inner_mass, rig.outer_mass, rig.resonator_mass], 2)
    total = 0.5 * state[:, 6:] ** 2 @ masses + scene.operation.load * state[:, 1]
    total += 0.5 * rig.support_stiffness_x * (state[:, 2:4] ** 2).sum(axis=1)
    total += 0.5 * rig.resonator_stiffness * ((state[:, 2:4] - state[:, 4:6]) ** 2).sum(axis=1)
    cosine, sine = ball_directions(scene, np.zeros(1))
    drop = np.zeros((bearing.rows, bearing.balls))
    drop[0, 9] = scene.spalls[0].depth  # ball 10 of row 1 sits at 270 degrees
    compression = (
        cosine * (state[:, 0] - state[:, 2])[:, None, None] + sine * (state[:, 1] - state[:, 3])[:, None, None]
    )
    spring = bearing.load_deflection / (bearing.exponent + 1.0) * np.maximum(compression - drop, 0.0) ** 2.5
    return total + spring.sum(axis=(1, 2))


@pytest.mark.parametrize("law", ["paper", "no_tension"])
def test_energy_never_grows_while_the_cage_stands_still(law, reference_scene):
    scene = still_scene(reference_scene, law)
    start = simulate(scene, RATE, keep=Kept(state=True)).state[0].copy()
    lowest = energy(scene, start[None])[0]
    start[6:8] = [0.03, 0.05]  # m/s: a blow that lets every ball lose contact
    trace = respond(scene, start, Grid(3000, 4, 0.25 / RATE), "exponential_rk4", Kept(state=True))
    stored = energy(scene, trace.state) - lowest
    assert trace.changes.time.size > 50
    assert stored[-1] < 0.6 * stored[0]
    assert np.diff(stored).max() < 1e-7 * stored[0]  # the error of one sample's steps
    assert stored.min() > 0.0


def test_undamped_energy_is_kept_while_the_cage_stands_still(reference_scene):
    damped = still_scene(reference_scene, "paper")
    free = dataclasses.replace(
        damped.rig, film_damping=0.0, support_damping_x=0.0, support_damping_y=0.0, resonator_damping=0.0
    )
    scene = dataclasses.replace(damped, rig=free)
    start = simulate(scene, RATE, keep=Kept(state=True)).state[0].copy()
    lowest = energy(scene, start[None])[0]
    start[6:8] = [0.03, 0.05]
    trace = respond(scene, start, Grid(3000, 4, 0.25 / RATE), "exponential_rk4", Kept(state=True))
    stored = energy(scene, trace.state) - lowest
    assert stored == pytest.approx(np.full(3000, stored[0]), rel=1e-4)  # 12 000 steps of order 4, 130 a contact period


@pytest.fixture(scope="module")
def lopsided_scene(reference_scene):
    """Reference scenes whose cage starts where no two balls change contact at the same instant."""

    def build(name, duration):
        scene = reference_scene(name, duration)
        return dataclasses.replace(scene, cage=dataclasses.replace(scene.cage, start_angle=0.05))

    return build


@pytest.mark.parametrize("name", ["G1", "F1s"])
def test_a_scene_turned_by_half_a_turn_answers_with_the_opposite_sign(name, lopsided_scene):
    scene = lopsided_scene(name, 0.1)
    turned = dataclasses.replace(
        scene,
        operation=dataclasses.replace(scene.operation, load=-scene.operation.load),
        cage=dataclasses.replace(scene.cage, start_angle=scene.cage.start_angle + math.pi),
        spalls=tuple(dataclasses.replace(spall, angle=spall.angle + math.pi) for spall in scene.spalls),
    )
    here, there = (simulate(s, RATE, FixedSteps(1)).acceleration for s in (scene, turned))
    # Round-off decides which of two balls that change sides at one instant goes first, and with that the next steps.
    assert rms(here + there) < 1e-5 * rms(here)


@pytest.mark.parametrize("name", ["G1", "F2"])
def test_a_cage_one_ball_spacing_further_answers_alike(name, lopsided_scene):
    scene = lopsided_scene(name, 0.1)
    ahead = dataclasses.replace(scene.cage, start_angle=scene.cage.start_angle + scene.rig.bearing.spacing)
    here, there = (
        simulate(s, RATE, FixedSteps(1)).acceleration for s in (scene, dataclasses.replace(scene, cage=ahead))
    )
    assert rms(here - there) < 1e-7 * rms(here)  # round-off of angles, through the contact changes


def test_a_spall_on_the_second_row_is_one_on_the_first_with_the_cage_half_a_spacing_back(lopsided_scene):
    scene = lopsided_scene("G1", 0.1)
    second = tuple(dataclasses.replace(spall, row=2) for spall in scene.spalls)
    back = dataclasses.replace(scene.cage, start_angle=scene.cage.start_angle - scene.rig.bearing.stagger)
    here, there = (
        simulate(s, RATE, FixedSteps(1)).acceleration
        for s in (scene, dataclasses.replace(scene, spalls=second, cage=back))
    )
    assert rms(here - there) < 1e-7 * rms(here)  # round-off of angles, through the contact changes


def test_two_cages_that_run_alike_answer_as_one(reference_scene):
    scene = reference_scene("F1", 0.1)
    twin = dataclasses.replace(scene, second_cage=scene.cage)
    here, there = (simulate(s, RATE, FixedSteps(1)).acceleration for s in (scene, twin))
    assert rms(here - there) < 1e-7 * rms(here)  # sums of the two rows in another order


def test_masses_four_times_lighter_and_dampers_half_as_strong_do_the_same_twice_as_fast(reference_scene):
    scene = reference_scene("F1", 0.1)
    rig, run, cage = scene.rig, scene.operation, scene.cage
    quarter = {name: getattr(rig, name) / 4.0 for name in ("inner_mass", "outer_mass", "resonator_mass")}
    half = {
        name: getattr(rig, name) / 2.0
        for name in ("support_damping_x", "support_damping_y", "resonator_damping", "film_damping")
    }
    fast = dataclasses.replace(
        scene,
        rig=dataclasses.replace(rig, **quarter, **half),
        operation=dataclasses.replace(run, shaft_speed=2.0 * run.shaft_speed),
        cage=CagePath(2.0 * cage.nominal_speed, cage.duration / 2.0),
    )
    slow, quick = simulate(scene, RATE), simulate(fast, 2.0 * RATE)
    assert rms(quick.acceleration - 4.0 * slow.acceleration) < 1e-9 * rms(quick.acceleration)  # powers of two
    assert quick.changes.time == pytest.approx(slow.changes.time / 2.0, rel=1e-12)
    assert quick.error_estimate == pytest.approx(slow.error_estimate, rel=0.01)  # the pilot may end a sample later
