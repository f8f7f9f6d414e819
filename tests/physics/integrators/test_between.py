"""Weights of steps between whole units: how near to computed ones, and where they are computed instead."""

import numpy as np
import pytest

from physics.integrators.modal.between import LONGEST_TURN, set_between
from physics.integrators.modal.flow import linear_flow
from physics.integrators.modal.layout import STEP_WEIGHTS
from physics.integrators.modal.memory import BETWEEN, UNITS, memory_for
from physics.integrators.modal.tables import tables_for
from physics.integrators.modal.weights import set_step
from physics.motion import motion_model

STIFFNESS, DAMPING = (60e6, 95e6), (300.0, 500.0)


@pytest.fixture
def flow(fan, build_scene):
    return linear_flow(motion_model(build_scene(fan)), STIFFNESS, DAMPING)


def found_and_computed(flow, unit, share):
    """Weights of a step of `share` units read between, computed, and the largest of their kind in the table."""
    memory = memory_for(flow, np.zeros(12), tables_for(flow, UNITS * unit), (1, 11, 8))
    set_between(flow, memory, share * unit, unit)
    computed = np.empty(STEP_WEIGHTS)
    set_step(flow, computed, share * unit, memory.phi)
    return memory.weights[BETWEEN], computed, np.abs(memory.weights[: UNITS + 1]).max(axis=0)


@pytest.mark.parametrize("share", [1e-3, 0.27, 1.5, 3.999, 8.5, 12.5, 15.73])
def test_read_between_units_a_weight_is_as_near_as_the_polynomials_error_says(flow, share):
    unit = 0.999 * LONGEST_TURN / flow.fastest
    found, computed, largest = found_and_computed(flow, unit, share)
    first = min(max(int(share) - 3, 0), 9)
    product = np.abs(np.prod(share - first - np.arange(8.0)))
    bound = 1.1 * LONGEST_TURN**8 * product / 40320.0 + 1e-14  # Lagrange's remainder; a tenth for slower modes' share
    assert np.abs(found - computed).max(where=largest > 0.0, initial=0.0) > 0.0
    assert np.all(np.abs(found - computed) <= bound * largest)


@pytest.mark.parametrize("units", [0, 1, 7, 16])
def test_read_at_a_whole_number_of_units_a_weight_is_that_of_the_table(flow, units):
    unit = 0.5 * LONGEST_TURN / flow.fastest
    found, computed, largest = found_and_computed(flow, unit, float(units))
    assert np.all(np.abs(found - computed) <= 1e-14 * largest)  # rounding


@pytest.mark.parametrize(("turn", "share"), [(1.001 * LONGEST_TURN, 3.3), (0.5 * LONGEST_TURN, 16.1)])
def test_where_a_mode_turns_too_far_or_the_table_ends_the_weights_are_computed(flow, turn, share):
    found, computed, _ = found_and_computed(flow, turn / flow.fastest, share)
    assert np.array_equal(found, computed)


def test_the_fastest_rate_is_that_of_the_largest_eigenvalue(flow):
    pairs = flow.rate.reshape(6, 2)
    swinging = np.hypot(pairs[:, 0], pairs[:, 1])[flow.twist > 0.0]
    assert flow.fastest == pytest.approx(max(swinging.max(), np.abs(pairs[flow.twist == 0.0]).max(initial=0.0)))
