"""What a march writes down: samples by the equations of motion, changes of contact, and balls that pull."""

import numpy as np
import pytest

from physics.assembly import assemble
from physics.contact.forces import ACTIVE, COMPRESSION, FORCE, LAW
from physics.integrators.output import (
    LARGEST_ACCELERATION,
    LOGGED,
    PULLED,
    TALLY_ENTRIES,
    TOUCHED,
    UNLOCATED,
    change_unlocated,
    record,
    toggle,
)
from physics.motion import MotionModel
from physics.response.march_output import empty_output
from physics.trace import Kept

MOTION = MotionModel(
    inner_mass=2.0, outer_mass=5.0, resonator_mass=0.5, support_stiffness=(3e3, 7e3), support_damping=(11.0, 13.0),
    resonator_stiffness=1.7e3, resonator_damping=1.9, load=100.0, load_fluctuation=0.0, fluctuation_phase=0.0,
    unbalance_force=0.0, unbalance_phase=0.0, shaft_speed=40.0,
)  # fmt: skip
STATE = np.array([0.3, -0.4, 0.5, -0.7, 1.1, 1.3, 1.7, -1.9, 2.3, 2.9, -3.1, 3.7])  # m, then m/s
NET = (17.0, -19.0)


@pytest.fixture
def contacts(reference_scene):
    """Those of a bearing with a cage for each row."""
    contacts = assemble(reference_scene("G1", 0.1))
    return contacts._replace(balls=np.concatenate([contacts.balls, contacts.balls]))


def test_a_sample_holds_the_accelerations_of_the_equations_of_motion(contacts):
    output = empty_output(contacts, 3, 4, Kept(state=True, force=True, outer=True))
    balls = contacts.balls
    balls[0, FORCE, :3], balls[1, FORCE, 5], balls[1, FORCE, 6] = [2.0, 3.0, -5.0], 7.0, -1.0
    balls[0, ACTIVE, :3], balls[1, ACTIVE, 5], balls[1, ACTIVE, 6] = 1.0, 1.0, 1.0
    for _ in range(2):
        assert record(balls, MOTION, STATE, NET, 1, output)
    for axis, (stiffness, damping, net) in enumerate(((3e3, 11.0, 17.0), (7e3, 13.0, -19.0))):
        outer, resonator = STATE[2 + axis], STATE[4 + axis]
        outer_speed, resonator_speed = STATE[8 + axis], STATE[10 + axis]
        between = 1.7e3 * (outer - resonator) + 1.9 * (outer_speed - resonator_speed)
        assert output.acceleration[1, axis] == pytest.approx(between / 0.5, rel=1e-14)
        pushed = net - stiffness * outer - damping * outer_speed - between
        assert output.outer[:, 1, axis] == pytest.approx([outer, outer_speed, pushed / 5.0], rel=1e-14)
    assert output.state[1].tolist() == STATE.tolist()
    assert output.force[1].tolist() == balls[:, FORCE].ravel().tolist()
    assert not any(
        field[place].any() for field in (output.acceleration, output.state, output.force) for place in (0, 2)
    )
    assert output.touched[[TOUCHED, PULLED]].tolist() == [10.0, 4.0]


@pytest.mark.parametrize(
    ("size", "fine"), [(0.4, True), (-0.4, True), (0.6, False), (-0.6, False), (np.nan, False), (np.inf, False)]
)
def test_a_sample_beyond_all_measure_or_none_ends_the_march(contacts, size, fine):
    output = empty_output(contacts, 1, 1, Kept())
    state = np.zeros(12)
    # Both axes together are what counts.
    state[2:4] = (
        size * LARGEST_ACCELERATION * MOTION.resonator_mass / MOTION.resonator_stiffness * np.array([1.0, -1.0])
    )
    assert record(contacts.balls, MOTION, state, (0.0, 0.0), 0, output) == fine


def test_balls_change_sides_one_by_one_until_the_log_is_full(contacts):
    output, size = empty_output(contacts, 1, 3, Kept()), contacts.balls.shape[2]
    contacts.balls[1, ACTIVE, 4] = 1.0
    for ball, time in ((2, 0.1), (size + 4, 0.2), (2, 0.3), (size + 1, 0.4)):
        toggle(contacts.balls, ball, time, output)
    assert output.change_time.tolist() == [0.1, 0.2, 0.3]
    assert output.change_ball.tolist() == [2, size + 4, 2]
    assert output.change_made.tolist() == [True, False, False]
    assert output.tally[LOGGED] == 3
    assert np.argwhere(contacts.balls[:, ACTIVE] > 0.5).tolist() == [[1, 1]]


def test_every_ball_that_contradicts_the_set_changes_sides_where_none_is_located(contacts):
    output, size = empty_output(contacts, 1, 9, Kept()), contacts.balls.shape[2]
    balls = contacts.balls
    balls[:, COMPRESSION] = -1e-6
    balls[0, COMPRESSION, 3], balls[1, COMPRESSION, 3] = 1e-6, 1e-6
    balls[1, ACTIVE, 3], balls[1, ACTIVE, 5], balls[:, LAW] = 1.0, 1.0, 1.0
    change_unlocated(contacts, 0.25, output)
    assert np.argwhere(balls[:, ACTIVE] > 0.5).tolist() == [[0, 3], [1, 3]]
    assert output.change_ball[:2].tolist() == [3, size + 5]
    assert output.change_made[:2].tolist() == [True, False]
    assert output.change_time[:2].tolist() == [0.25, 0.25]
    assert output.tally.tolist() == [2 if entry in (LOGGED, UNLOCATED) else 0 for entry in range(TALLY_ENTRIES)]
