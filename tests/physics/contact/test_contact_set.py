"""The mark of a contact set tells sets apart, however many balls a bearing has; what happens within a step is seen."""

from dataclasses import replace

import numpy as np
import pytest
from kernels import from_python
from scipy.interpolate import CubicHermiteSpline

from physics.assembly import assemble
from physics.contact import contact_set
from physics.contact.forces import ACTIVE, BALL_ROWS, CLOSING, COMPRESSION, LAW

mark_of = from_python(contact_set.mark_of)
count_lapses = from_python(contact_set.count_lapses)
count_dips = from_python(contact_set.count_dips)
count_ahead = from_python(contact_set.count_ahead)
count_brushes = from_python(contact_set.count_brushes)
count_changes = from_python(contact_set.count_changes)


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
        parabola = np.polynomial.Polynomial.fit(time[[0, 200, 400]], between[[0, 200, 400]], 2)
        assert seen == (rates.min() < 0.0 and parabola(time).min() < 0.0)
        (deep if least < -0.3 else calm if least > 0.2 else []).append(seen)
    assert len(deep) > 40
    assert np.mean(deep) > 0.7  # a parabola does not follow a force that falls and rises at one end of the step alone
    assert len(calm) > 1000
    assert not any(calm)


@pytest.mark.parametrize(
    ("changes", "lapses"),
    [
        ({}, 1),
        ({"active": 0.0}, 0),
        ({"end": -1e-9}, 0),  # it has left the race
        ({"rate": -0.2}, 0),  # let go of before
        ({"law": -1.0}, 0),  # and afterwards
        ({"rate": 0.02}, 0),  # it does not unload at either end
    ],
)
def test_only_a_ball_that_is_pressed_at_both_ends_lapses_in_between(changes, lapses, reference_scene):
    contacts = assemble(reference_scene("G1", 0.1))
    ball = {"active": 1.0, "start": 2e-6, "rate": -0.02, "end": 1e-6, "end_rate": 0.02, "law": 7.0} | changes
    # From 2 to 1 µm in 10 µs it unloads by up to 0.15 m/s: the film of 100 N s/m then pulls more than K presses, 9 N.
    balls, noted = np.zeros_like(contacts.balls), np.zeros((1, 2, contacts.balls.shape[2]))
    noted[0, :, 3] = ball["start"], ball["rate"]
    balls[0, [ACTIVE, COMPRESSION, CLOSING, LAW], 3] = ball["active"], ball["end"], ball["end_rate"], ball["law"]
    assert count_lapses(contacts._replace(balls=balls), noted, 1e-5) == lapses


@pytest.mark.parametrize("pressed", [0.0, 1.0])
def test_a_parabola_that_turns_on_the_other_side_within_a_step_is_a_dip(pressed):
    rng, step, side = np.random.default_rng(4), 2e-5, 2.0 * pressed - 1.0
    balls, noted = np.zeros((2, BALL_ROWS, 40)), np.zeros((2, 2, 40))
    begin, middle = side * rng.uniform(0.0, 1e-6, (2, 40)), side * rng.uniform(-1e-6, 2e-6, (2, 40))
    end = side * rng.uniform(0.0, 1e-6, (2, 40))
    curve, line = 2.0 * (begin - 2.0 * middle + end), 4.0 * middle - 3.0 * begin - end
    along = np.linspace(0.0, 1.0, 20_001)[:, None, None]
    between = side * (begin + along * (line + along * curve))  # on the ball's own side where above zero
    balls[:, ACTIVE], balls[:, COMPRESSION], balls[:, CLOSING] = pressed, end, (line + 2.0 * curve) / step
    noted[:, 0], noted[:, 1] = begin, line / step
    dips = int((between.min(axis=0) < 0.0).sum())
    assert 10 < dips < 70
    assert np.abs(between.min(axis=0)).min() > 1e-9  # none so near that the samples in between tell nothing
    assert count_dips(balls, noted, step) == dips


def test_balls_that_will_change_sides_are_counted_ahead():
    balls = np.zeros((2, BALL_ROWS, 2))
    balls[:, ACTIVE] = [[1.0, 0.0], [1.0, 0.0]]
    balls[:, COMPRESSION] = [[2e-6, -2e-6], [2e-6, -2e-6]]
    balls[:, CLOSING] = [[-1.0, 1.0], [-1.0, -1.0]]
    assert [count_ahead(balls, ahead) for ahead in (1.9e-6, 2.1e-6, -2.1e-6)] == [0, 3, 1]


def test_a_free_ball_that_came_without_being_pressed_has_brushed():
    #         brushed  pressed  held  still away  there before
    came = [[-1e-6, -1e-6, -1e-6, -1e-6, 1e-6]]
    balls, noted = np.zeros((2, BALL_ROWS, 5)), np.zeros((2, 2, 5))
    noted[:, 0] = came
    balls[:, COMPRESSION] = [[1e-6, 1e-6, 1e-6, -1e-6, 1e-6]]
    balls[:, LAW] = [[-1.0, 1.0, -1.0, -1.0, -1.0]]
    balls[:, ACTIVE] = [[0.0, 0.0, 1.0, 0.0, 0.0]]
    assert count_brushes(balls, noted) == 2


@pytest.mark.parametrize(("law", "changes"), [("paper", 1), ("no_tension", 2)])
def test_a_compressed_ball_that_would_pull_is_in_contact_by_the_law_of_the_paper_alone(reference_scene, law, changes):
    contacts = assemble(replace(reference_scene("G1", 0.1), contact_law=law))
    balls = np.zeros_like(contacts.balls)
    # In contact and pulling; in contact and pushing; free and pushing, which needs compression too; compressed, held.
    balls[0, COMPRESSION, :4], balls[0, LAW, :4] = [1e-6, 1e-6, -1e-6, 1e-6], [-1.0, 1.0, 1.0, 1.0]
    balls[0, ACTIVE, :4] = [1.0, 1.0, 0.0, 0.0]
    assert count_changes(contacts._replace(balls=balls)) == changes
