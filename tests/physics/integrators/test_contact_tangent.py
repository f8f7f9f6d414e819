"""How the net contact force changes with displacement, against differences of the force itself."""

import numpy as np
import pytest
from kernels import press, reset_contact, set_time

from physics.assembly import assemble
from physics.integrators.contact_tangent import contact_tangent
from physics.reference_scenes import reference_scene

PLACE = np.array([1e-6, -9e-6])  # m
MOVE = 1e-10  # m; the force of a ball pressed some 1e-6 m bends by its 1e-8th over this
RATE = 3e4  # 1/s


@pytest.mark.parametrize("rate", [0.0, RATE])
def test_the_tangent_is_the_slope_of_the_net_force_where_speed_follows_displacement(rate):
    contacts = assemble(reference_scene("F1", 0.1))
    set_time(contacts, 0.0123)

    def force(move):
        return np.array(press(contacts, *(PLACE + move), *(np.array([2e-3, -3e-3]) + rate * move)))

    force(np.zeros(2))
    reset_contact(contacts)
    differences = [(force(MOVE * axis) - force(-MOVE * axis)) / (2.0 * MOVE) for axis in np.eye(2)]
    force(np.zeros(2))
    xx, xy, yx, yy = contact_tangent(contacts, rate)
    assert np.array([[xx, yx], [xy, yy]]) == pytest.approx(np.array(differences), rel=1e-6)
    assert abs(xy - yx) > 1e-3 * abs(xy)  # the cage turns displacement into compression of the film
