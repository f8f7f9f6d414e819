"""The mark of a contact set tells sets apart, however many balls a bearing has; lapses within a step are seen."""

import numpy as np
import pytest
from kernels import from_python
from scipy.interpolate import CubicHermiteSpline

from physics.assembly import assemble
from physics.contact import contact_set
from physics.contact.forces import ACTIVE, BALL_ROWS, CLOSING, COMPRESSION, LAW

mark_of = from_python(contact_set.mark_of)
count_lapses = from_python(contact_set.count_lapses)


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


def test_a_ball_that_the_film_lets_go_of_within_a_step_is_seen(reference_scene):
    contacts = assemble(reference_scene("G1", 0.1))
    law, rng, deep, calm = contacts.law, np.random.default_rng(0), [], []
    for _ in range(2000):
        step, ends = 10.0 ** rng.uniform(-5.0, -3.5), rng.uniform(0.2e-6, 6e-6, 2)
        rates = rng.standard_normal(2) * 10.0 ** rng.uniform(-3.0, -1.0)
        motion, time = CubicHermiteSpline([0.0, step], ends, rates), np.linspace(0.0, step, 401)
        between = law.stiffness * np.maximum(motion(time), 0.0) ** 1.5 + law.damping * motion(time, 1)
        if min(between[0], between[-1], motion(time).min()) <= 0.0:
            continue
        balls, noted = np.zeros_like(contacts.balls), np.zeros((1, 2, contacts.balls.shape[2]))
        noted[0, :, 0] = ends[0], rates[0]
        balls[0, [ACTIVE, COMPRESSION, CLOSING, LAW], 0] = 1.0, ends[1], rates[1], between[-1]
        least = between.min() / max(between[0], between[-1])
        seen = count_lapses(contacts._replace(balls=balls), noted, step)
        (deep if least < -0.3 else calm if least > 0.2 else []).append(seen)
    assert len(deep) > 40
    assert np.mean(deep) > 0.7  # a parabola does not follow a force that falls and rises at one end of the step alone
    assert len(calm) > 1000
    assert not any(calm)
