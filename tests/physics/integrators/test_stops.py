"""Which known kink a step ends at: those of balls in contact, and those that stop any ball."""

import numpy as np
import pytest
from kernels import has_ridges

from physics.contact.forces import ACTIVE, BALL_ROWS
from physics.integrators.stops import ANY_BALL, Stops, next_kink, passed_kinks

# Ball 9 is the second one of the second cage of eight.
STOPS = Stops(np.array([1.0, 2.0, 3.0, 4.0]), np.array([0, 9, ANY_BALL, 0]))


def pressed(*balls):
    """Two cages of eight balls of which these are in contact, each given by its cage and place."""
    table = np.zeros((2, BALL_ROWS, 8))
    for cage, place in balls:
        table[cage, ACTIVE, place] = 1.0
    return table


@pytest.mark.parametrize(
    ("ahead", "time", "expected"), [(0, 0.5, 0), (0, 2.0, 2), (3, 1.0, 3), (1, 9.0, 4), (4, 9.0, 4)]
)
def test_a_kink_is_passed_from_its_own_instant_on(ahead, time, expected):
    assert passed_kinks(STOPS, ahead, time) == expected


@pytest.mark.parametrize(
    ("balls", "ahead", "finish", "expected"),
    [
        ([(0, 0)], 0, 9.0, 1.0),
        ([(0, 0)], 0, 0.5, 0.5),
        ([(1, 1)], 0, 9.0, 2.0),
        ([(0, 1), (1, 0)], 0, 9.0, 3.0),
        ([(0, 1), (1, 0)], 0, 2.5, 2.5),
        ([(0, 0)], 1, 9.0, 3.0),
        ([(0, 0)], 3, 9.0, 4.0),
        ([(1, 1)], 3, 9.0, 9.0),
        ([], 4, 9.0, 9.0),
    ],
)
def test_a_step_ends_at_the_next_kink_of_a_ball_in_contact_or_of_any(balls, ahead, finish, expected):
    assert next_kink(pressed(*balls), STOPS, ahead, finish) == expected


def test_ridges_are_told_by_the_kinks_that_stop_any_ball():
    assert has_ridges(STOPS)
    assert not has_ridges(Stops(STOPS.time[:2], STOPS.ball[:2]))
    assert not has_ridges(Stops(np.zeros(0), np.zeros(0, int)))
