"""The mark of a contact set tells sets apart, however many balls a bearing has."""

import numpy as np
import pytest
from kernels import from_python

from physics.contact import contact_set
from physics.contact.forces import ACTIVE, BALL_ROWS

mark_of = from_python(contact_set.mark_of)


def mark(pressed, cages):
    """The mark of a set, `pressed` (G · M,) true or false."""
    balls = np.zeros((cages, BALL_ROWS, pressed.size // cages))
    balls[:, ACTIVE] = pressed.reshape(cages, -1)
    return mark_of(balls, ACTIVE)


@pytest.mark.parametrize(("cages", "balls"), [(1, 12), (1, 24), (1, 72), (2, 36), (1, 400), (2, 200)])
def test_sets_that_differ_in_one_or_two_balls_have_different_marks(cages, balls):
    columns = cages * balls
    few = np.array([column % 7 < 3 for column in range(columns)])
    found = {mark(few, cages)}
    for first in range(columns):
        for second in range(first, columns, 1 + columns // 60):
            other = few.copy()
            other[[first, second]] = ~other[[first, second]]
            found.add(mark(other, cages))
    assert len(found) == 1 + sum(len(range(first, columns, 1 + columns // 60)) for first in range(columns))


def test_a_mark_is_a_whole_number_to_which_small_ones_can_be_added():
    largest = max(mark(np.random.default_rng(seed).random(72) < 0.5, 1) for seed in range(200))
    assert 2.0**51 < largest < 2.0**52
    assert largest == int(largest)
