"""The embedded pair against the conditions of order, and what its step control looks at."""

import numpy as np
import pytest

from physics.integrators.dormand_prince import DENSE, ERROR, NODES, WEIGHTS, make_relative

# Stages as a square matrix: none follows from the last one.
A = np.column_stack([WEIGHTS, np.zeros(7)])
# Elementary weights of all rooted trees, by their order, and what they must make [Butcher 1963].
TREES = {
    1: [(np.ones(7), 1.0)],
    2: [(NODES, 1.0 / 2.0)],
    3: [(NODES**2, 1.0 / 3.0), (A @ NODES, 1.0 / 6.0)],
    4: [
        (NODES**3, 1.0 / 4.0),
        (NODES * (A @ NODES), 1.0 / 8.0),
        (A @ NODES**2, 1.0 / 12.0),
        (A @ A @ NODES, 1.0 / 24.0),
    ],
    5: [
        (NODES**4, 1.0 / 5.0),
        (NODES**2 * (A @ NODES), 1.0 / 10.0),
        ((A @ NODES) ** 2, 1.0 / 20.0),
        (NODES * (A @ NODES**2), 1.0 / 15.0),
        (A @ NODES**3, 1.0 / 20.0),
        (NODES * (A @ A @ NODES), 1.0 / 30.0),
        (A @ (NODES * (A @ NODES)), 1.0 / 40.0),
        (A @ A @ NODES**2, 1.0 / 60.0),
        (A @ A @ A @ NODES, 1.0 / 120.0),
    ],
}
ROUND_OFF = 1e-14


def test_the_step_is_of_order_5_and_the_embedded_one_of_order_4_alone():
    step, embedded = A[6], A[6] - ERROR
    for order, trees in TREES.items():
        assert [step @ tree for tree, _ in trees] == pytest.approx([value for _, value in trees], abs=ROUND_OFF)
        misses = [abs(embedded @ tree - value) for tree, value in trees]
        assert max(misses) < ROUND_OFF if order < 5 else max(misses) > 1e-4
    assert A.sum(axis=1) == pytest.approx(NODES, abs=ROUND_OFF)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.77, 1.0])
def test_the_dense_output_is_of_order_4_at_every_share_of_the_step_and_ends_where_the_step_does(share):
    between = DENSE @ share ** np.arange(1, 5)
    for order in range(1, 5):
        found = [between @ tree for tree, _ in TREES[order]]
        assert found == pytest.approx([share**order * value for _, value in TREES[order]], abs=ROUND_OFF)
    assert DENSE.sum(axis=1) == pytest.approx(A[6], abs=ROUND_OFF)


def test_what_moves_all_bodies_alike_moves_none_relative_to_the_outer_ring():
    state = np.array([1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 3.0, 4.0, 3.0, 4.0, 3.0, 4.0])
    make_relative(state)
    assert state.tolist() == [0.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 4.0, 0.0, 0.0]
