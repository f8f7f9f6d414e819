"""Where a contact change is looked for first."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kernels import earliest_change, press, set_time

from physics.assembly import assemble
from physics.contact.forces import ACTIVE
from physics.integrators import events
from physics.integrators.events import Way
from physics.integrators.state_contact import locate
from physics.integrators.trial import Trial
from physics.motion import motion_model
from physics.reference_scenes import reference_scene

hermite_root = events.hermite_root.py_func


@settings(deadline=None, derandomize=True)
@given(st.floats(0.05, 0.95), st.floats(-0.9, 3.0), st.floats(-0.9, 3.0), st.floats(1e-9, 1e3))
def test_the_root_of_a_falling_cubic_is_found_from_values_and_slopes_at_both_ends(place, early, late, size):
    # Slope −(1 + early)(1 − x) − (1 + late) x is below zero from 0 to 1, so the parabola falls through zero once.
    slope = np.polynomial.Polynomial([-(1.0 + early), early - late]) * size
    fall = slope.integ()
    fall -= fall(place)
    if fall(0.0) > 0.0 > fall(1.0):
        root = hermite_root(0.0, 1.0, fall(0.0), fall(1.0), slope(0.0), slope(1.0))
        assert root == pytest.approx(place, abs=0.02)  # three steps of Newton's method from the chord


def test_a_cubic_that_hardly_bends_is_met_as_exactly_as_numbers_go():
    cubic = np.polynomial.Polynomial([0.3, -1.0, 0.05, -0.1])
    slope = cubic.deriv()
    found = hermite_root(0.0, 1.0, cubic(0.0), cubic(1.0), slope(0.0), slope(1.0))
    assert cubic(found) == pytest.approx(0.0, abs=1e-12)


def test_without_slopes_the_root_is_that_of_the_chord():
    assert hermite_root(0.2, 0.6, 3.0, -1.0, 0.0, 0.0) == pytest.approx(0.5, rel=1e-12)


CLEARANCE, STEP, BOTTOM = (
    5e-6,
    1e-5,
    9,
)  # at 270 degrees; those of the other row beside it follow after 0.89 of the step


@pytest.fixture
def falling():
    """A loose gearbox bearing, and a step after 0.8 of which its falling inner ring meets the ball below."""
    scene = reference_scene("G0", 0.1)
    rig = replace(scene.rig, bearing=replace(scene.rig.bearing, clearance=CLEARANCE))
    contacts = assemble(replace(scene, rig=rig))
    contacts.balls[:, ACTIVE] = 0.0
    begin, end = np.zeros((3, 2)), np.zeros((3, 2))
    begin[0, 1], end[0, 1] = -3.4e-6, -5.4e-6
    begin[1, 1] = end[1, 1] = -2.0e-6
    set_time(contacts, STEP)
    press(contacts, 0.0, end[0, 1], 0.0, end[1, 1] / STEP)
    return contacts, Way(0.0, STEP, begin, end)


@pytest.mark.parametrize("seen", [0.0, 0.5, 0.9], ids=["at the end", "where it does not touch yet", "where it touches"])
def test_a_ball_that_touches_in_a_step_is_found_wherever_it_was_seen(falling, seen):
    contacts, way = falling
    suspects = np.zeros((1, contacts.balls.shape[2]))
    suspects[0, BOTTOM] = seen
    share, ball, rate = earliest_change(contacts, way, False, suspects)
    assert (share, ball) == (pytest.approx(0.8, abs=1e-6), BOTTOM)
    assert rate == pytest.approx(0.2, rel=1e-3)  # 2 µm in 10 µs; the cage turns by 0.01 degrees meanwhile


def test_a_touch_is_located_with_the_force_at_both_ends_of_the_step(falling):
    contacts, _ = falling
    scene = reference_scene("G0", 0.1)
    rig = replace(scene.rig, outer_mass=1e9)  # stands still
    motion = motion_model(replace(scene, rig=rig, operation=replace(scene.operation, load=0.0)))
    now, then = np.zeros(12), np.zeros(12)
    # A force that grows from 0 along the step makes a path of degree 3: 3.4 + 2 x + x³ µm at the share x of the step.
    now[1], now[7] = -3.4e-6, -2e-6 / STEP
    then[1], then[7] = -6.4e-6, -5e-6 / STEP
    force = 6e-6 * rig.inner_mass / STEP**2
    set_time(contacts, STEP)
    press(contacts, then[0], then[1], then[6], then[7])
    share, ball = locate(contacts, motion, Trial(0.0, STEP, now, (0.0, 0.0), then, (0.0, force), 0))
    touch = np.polynomial.Polynomial([3.4e-6 - CLEARANCE, 2e-6, 0.0, 1e-6]).roots()
    assert (share, ball) == (pytest.approx(touch[np.isreal(touch)].real[0], abs=1e-6), BOTTOM)  # the cage turns
