"""Changes of contact beyond the hundred that are located in one full step: taken over at the ends of trials."""

import numpy as np
import pytest
from variants import changed

from physics.integrators.output import Grid
from physics.integrators.trial import MOST_CHANGES_PER_STEP
from physics.motion import motion_model, starting_state
from physics.reference_scenes import reference_scene
from physics.response.single_march import respond
from physics.statics.load_distribution import equilibrium
from physics.trace import Kept

# So soft that a step of many milliseconds resolves everything but the contacts.
SOFT = {"support_stiffness_x": 1e5, "support_stiffness_y": 1e5, "support_damping_x": 50.0, "support_damping_y": 50.0}
SOFT |= {"resonator_stiffness": 1e4, "resonator_damping": 10.0}
STEP, STEPS = 0.033, 3


@pytest.mark.parametrize("method", ["generalised_alpha", "dormand_prince"])
def test_changes_beyond_the_hundredth_in_a_step_are_counted_and_no_ball_changes_sides_twice(method):
    scene = changed(reference_scene("F0", 0.2, speed_factor=10.0), rig=SOFT)
    start = starting_state(motion_model(scene), equilibrium(scene, np.zeros(1)).displacement[0])
    trace = respond(scene, start, Grid(STEPS + 1, 1, STEP), method, Kept(force=True))
    changes, bearing = trace.changes, scene.rig.bearing
    # A balanced bearing: each ball enters and leaves the load zone once a turn of the cage.
    turns = scene.cage.mean_speed * STEP * STEPS / (2.0 * np.pi)
    assert changes.time.size == pytest.approx(2.0 * bearing.rows * bearing.balls * turns, abs=3.0)
    assert trace.unlocated_changes == changes.time.size - STEPS * MOST_CHANGES_PER_STEP == 3
    for row in range(1, bearing.rows + 1):
        for ball in range(1, bearing.balls + 1):
            made = changes.made[(changes.row == row) & (changes.ball == ball)]
            states = np.append(changes.initial[row - 1, ball - 1], made)
            assert np.all(states[1:] != states[:-1])
            assert (trace.contact_force[-1, row - 1, ball - 1] != 0.0) == states[-1]
