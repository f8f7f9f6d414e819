import dataclasses
import math

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import root

from physics.checks import InvalidParameter
from physics.modes import coupled_matrix, coupled_resonator_frequency, modes, rated_matrices

NO_DAMPING = np.zeros((2, 2))


def healthy_matrices(rig, cage_angle):
    """Stiffness and damping of the healthy bearing at rated load by a general-purpose root finder."""
    b = rig.bearing
    rows = np.arange(b.rows)[:, None] * b.stagger
    angle = (cage_angle + rows + np.arange(b.balls) * b.spacing).ravel()
    directions = np.stack([np.cos(angle), np.sin(angle)])

    def balance(shift):
        pressed = np.maximum(shift * 1e-6 @ directions - b.clearance, 0.0)
        return directions @ (b.load_deflection * pressed**b.exponent) + [0.0, rig.rated_load]

    shift = root(balance, [0.0, -b.clearance * 1e6 - 5.0], tol=1e-13).x * 1e-6
    pressed = np.maximum(shift @ directions - b.clearance, 0.0)
    stiffness = b.exponent * b.load_deflection * pressed ** (b.exponent - 1.0)
    return (directions * stiffness) @ directions.T, (directions * rig.film_damping * (pressed > 0)) @ directions.T


@pytest.mark.parametrize("name", ["gearbox", "fan"])
def test_the_natural_frequencies_are_those_of_the_independent_implementation(authority, request, name):
    rig = request.getfixturevalue(name)
    expected = authority("independent_model")["modes"][f"{name}_hz"]
    frequency = modes(rig, *healthy_matrices(rig, 0.0)).frequency_hz
    assert np.all(np.abs(frequency - expected["value"]) <= expected["tolerance"])  # the digits given


@pytest.mark.parametrize("name", ["gearbox", "fan"])
def test_the_package_s_statics_give_the_same_matrices_as_a_general_root_finder(request, name):
    rig = request.getfixturevalue(name)
    for ours, theirs in zip(rated_matrices(rig), healthy_matrices(rig, 0.0), strict=True):
        assert np.allclose(ours, theirs, rtol=1e-7, atol=1e-7 * theirs[1, 1])  # the root finder's tolerance


@pytest.mark.parametrize("name", ["gearbox", "fan"])
def test_the_coupled_resonator_rings_above_the_resonator_alone(authority, request, name):
    rig, check = request.getfixturevalue(name), authority("independent_model")["modes"]
    stiffness, _ = rated_matrices(rig)
    coupled = check[f"{name}_resonator_coupled_khz"]
    assert coupled_resonator_frequency(rig, stiffness) * 1e-3 == pytest.approx(
        coupled["value"], abs=coupled["tolerance"]
    )
    alone = check[f"{name}_resonator_alone_khz"]
    frequency = math.sqrt(rig.resonator_stiffness / rig.resonator_mass) / (2 * math.pi)
    assert frequency * 1e-3 == pytest.approx(alone["value"], abs=alone["tolerance"])
    damping = check[f"{name}_resonator_damping_percent"]
    ratio = rig.resonator_damping / (2 * math.sqrt(rig.resonator_stiffness * rig.resonator_mass))
    assert ratio * 100 == pytest.approx(damping["value"], abs=damping["tolerance"])


def test_without_damping_the_frequencies_are_those_of_the_symmetric_problem(gearbox):
    still = dataclasses.replace(gearbox, support_damping_x=0.0, support_damping_y=0.0, resonator_damping=0.0)
    stiffness = np.array([[6e7, 1e7], [1e7, 9e7]])
    squared = eigh(coupled_matrix(still.stiffness_matrix(), stiffness), still.mass_matrix(), eigvals_only=True)
    found = modes(still, stiffness, NO_DAMPING)
    assert np.allclose(found.frequency_hz, np.sqrt(squared) / (2 * math.pi), rtol=1e-9)  # rounding of a 12 x 12 problem
    assert np.all(np.abs(found.damping_ratio) < 1e-9)  # rounding


def test_every_mode_satisfies_the_equation_of_motion_with_plus_k(fan):
    stiffness, damping = rated_matrices(fan)
    found = modes(fan, stiffness, damping)
    k = coupled_matrix(fan.stiffness_matrix(), stiffness)
    c = coupled_matrix(fan.damping_matrix(), damping)
    speed = 2 * math.pi * found.frequency_hz
    root_of = speed * (-found.damping_ratio + 1j * np.sqrt(1 - found.damping_ratio**2))
    for pole, shape in zip(root_of, found.shape.T, strict=True):
        rest = (pole**2 * fan.mass_matrix() + pole * c + k) @ shape
        assert np.max(np.abs(rest)) < 1e-9 * np.max(np.abs(k @ shape)) + 1e-6 * abs(pole) ** 2  # rounding


def test_two_locked_rings_and_a_rigid_resonator_move_as_one_oscillator(gearbox):
    rigid = dataclasses.replace(gearbox, resonator_stiffness=1e15)
    found = modes(rigid, 1e14 * np.eye(2), NO_DAMPING)
    total = gearbox.inner_mass + gearbox.outer_mass + gearbox.resonator_mass
    expected = math.sqrt(gearbox.support_stiffness_y / total) / (2 * math.pi)
    assert found.frequency_hz[:2] == pytest.approx([expected, expected], rel=1e-5)  # the stiffest spring is 1e7 times
    ratio = gearbox.support_damping_y / (2 * math.sqrt(gearbox.support_stiffness_y * total))
    assert found.damping_ratio[:2] == pytest.approx([ratio, ratio], rel=1e-3)  # rounding against 1e15 N/m
    assert np.allclose(np.sort(np.abs(found.shape[:, :2]), axis=0)[-3:], 1.0, atol=1e-5)


def test_scaling_all_masses_by_four_halves_the_frequencies(fan):
    heavy = dataclasses.replace(
        fan, inner_mass=4 * fan.inner_mass, outer_mass=4 * fan.outer_mass, resonator_mass=4 * fan.resonator_mass
    )
    stiffness, _ = rated_matrices(fan)
    undamped = {"support_damping_x": 0.0, "support_damping_y": 0.0, "resonator_damping": 0.0}
    light, heavy = dataclasses.replace(fan, **undamped), dataclasses.replace(heavy, **undamped)
    ratio = modes(light, stiffness, NO_DAMPING).frequency_hz / modes(heavy, stiffness, NO_DAMPING).frequency_hz
    assert ratio == pytest.approx(np.full(6, 2.0), rel=1e-8)  # rounding


def test_an_unloaded_bearing_leaves_the_shaft_free(fan):
    found = modes(fan, np.zeros((2, 2)), NO_DAMPING)
    assert np.all(found.frequency_hz[:2] < 1.0)  # zero but for rounding; the next is the support mode
    assert np.all(found.frequency_hz[2:] > 1000.0)
    assert np.all(np.isfinite(found.damping_ratio))
    assert coupled_resonator_frequency(fan, np.zeros((2, 2))) == pytest.approx(found.frequency_hz[5], rel=1e-3)


def test_an_overdamped_support_gives_real_roots_whose_product_is_the_squared_frequency(gearbox):
    total = gearbox.inner_mass + gearbox.outer_mass + gearbox.resonator_mass
    damping = 3.0 * 2.0 * math.sqrt(gearbox.support_stiffness_y * total)
    damped = dataclasses.replace(gearbox, support_damping_y=damping, resonator_stiffness=1e13)
    found = modes(damped, 1e12 * np.eye(2), NO_DAMPING)
    slowest = math.sqrt(gearbox.support_stiffness_y / total) / (2 * math.pi)
    at = int(np.argmax(found.damping_ratio))
    assert found.damping_ratio[at] == pytest.approx(3.0, rel=1e-3)  # three times critical
    assert found.frequency_hz[at] == pytest.approx(slowest, rel=1e-3)
    assert found.frequency_hz.shape == (6,)


def test_two_overdamped_modes_keep_their_own_pair_of_roots(gearbox):
    total = gearbox.inner_mass + gearbox.outer_mass + gearbox.resonator_mass
    critical = 2.0 * math.sqrt(gearbox.support_stiffness_y * total)
    damped = dataclasses.replace(
        gearbox, support_damping_x=3.0 * critical, support_damping_y=5.0 * critical, resonator_stiffness=1e13
    )
    ratio = np.sort(modes(damped, 1e12 * np.eye(2), NO_DAMPING).damping_ratio)
    assert ratio[-2:] == pytest.approx([3.0, 5.0], rel=1e-3)  # the rings move together but for 1e-5


def test_shapes_are_scaled_to_a_largest_displacement_of_one(gearbox):
    shape = modes(gearbox, *rated_matrices(gearbox)).shape
    assert shape.shape == (6, 6)
    assert np.iscomplexobj(shape)
    assert np.max(np.abs(shape), axis=0) == pytest.approx(np.ones(6), rel=1e-12)


def test_the_envelope_mode_is_the_resonator_s_along_y_even_when_x_and_y_are_coupled(gearbox):
    stiffer_y = dataclasses.replace(gearbox, support_stiffness_y=40 * gearbox.support_stiffness_y)
    stiffness = np.array([[6e7, 2e7], [2e7, 9e7]])
    frequency = coupled_resonator_frequency(stiffer_y, stiffness)
    found = modes(stiffer_y, stiffness, NO_DAMPING)
    along_y = int(np.argmax(np.abs(found.shape[5] - found.shape[3]) * (np.abs(found.shape[5]) == 1.0)))
    assert frequency == pytest.approx(found.frequency_hz[along_y], rel=1e-4)  # the resonator's damping is 0.5 %


def test_a_heavy_soft_resonator_rings_below_the_ring_that_stretches_its_spring_more(fan):
    """A ring of 2.5 kg moves more than one of 50 kg for the same energy, but its support holds that energy."""
    heavy = dataclasses.replace(fan, resonator_mass=50.0, resonator_stiffness=1e6)
    frequency = coupled_resonator_frequency(heavy, rated_matrices(fan)[0])
    alone = math.sqrt(1e6 / 50.0) / (2.0 * math.pi)
    assert frequency == pytest.approx(alone, rel=5e-3)  # the support gives way by 1/263 of what the spring does


@pytest.mark.parametrize("matrix", [np.zeros((3, 3)), np.full((2, 2), np.nan)])
def test_a_bearing_matrix_of_another_shape_or_not_finite_is_refused(gearbox, matrix):
    with pytest.raises(InvalidParameter, match="bearing matrix"):
        modes(gearbox, matrix, NO_DAMPING)
