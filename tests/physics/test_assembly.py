"""From a scene to the arrays of the kernels: which ball is where, on which cage, over which race."""

import dataclasses
import math

import pytest
from kernels import press, reset_contact, set_time
from variants import slipping_cage

from physics.assembly import assemble, ball_numbers
from physics.cage import CagePath
from physics.contact.forces import (
    BALL_ROWS,
    COMPRESSION,
    FRAME_COSINE,
    FRAME_SINE,
    FRAME_SPEED,
)

REST, MOVING = (1e-6, -6e-6), (2e-3, -3e-3)


def net_force(scene):
    """Net force (2,) of the balls that touch, N."""
    contacts = assemble(scene)
    set_time(contacts, 0.0123)
    press(contacts, *REST, *MOVING)
    reset_contact(contacts)
    return press(contacts, *REST, *MOVING)


def test_the_contact_angle_enters_as_its_cosine_to_the_power_n_plus_1(gearbox, build_scene):
    tilted = build_scene(gearbox, start_angle=0.2, bearing={"contact_angle": math.radians(25)})
    straight = build_scene(gearbox, start_angle=0.2)
    laws = assemble(tilted).law, assemble(straight).law
    cosine = math.cos(math.radians(25))
    assert laws[0].stiffness / laws[1].stiffness == pytest.approx(cosine**2.5, rel=1e-14)
    assert laws[0].damping / laws[1].damping == pytest.approx(cosine**2, rel=1e-14)


def test_padding_never_touches(gearbox, build_scene):
    scene = build_scene(gearbox, bearing={"rows": 1, "balls": 7})
    contacts, (row, ball) = assemble(scene), ball_numbers(scene)
    assert contacts.balls.shape == (1, BALL_ROWS, 8)
    assert ball.tolist() == [0, 1, 2, 3, 4, 5, 6, -1]
    assert row.tolist() == [0] * 7 + [-1]
    set_time(contacts, 0.1)
    press(contacts, 1e-3, 1e-3, 0.0, 0.0)
    assert contacts.balls[0, COMPRESSION, 7] < 0.0


def test_rows_of_one_cage_lie_side_by_side_and_rows_of_two_cages_apart(gearbox, build_scene):
    scene = build_scene(gearbox)
    apart = dataclasses.replace(scene, second_cage=scene.cage)
    assert assemble(scene).balls.shape == (1, BALL_ROWS, 24)
    assert assemble(apart).balls.shape == (2, BALL_ROWS, 16)  # padded to whole vectors of eight
    for row, ball in (ball_numbers(scene), ball_numbers(apart)):
        assert row[row >= 0].tolist() == [0] * 12 + [1] * 12
        assert ball[row >= 0].tolist() == [*range(12), *range(12)]
    assert net_force(scene) == pytest.approx(net_force(apart), rel=1e-12)


@pytest.mark.parametrize("time", [-0.01, 0.0, 0.1234, 0.4999, 0.5, 0.52])
def test_the_kernels_read_the_cage_path_even_where_one_cage_has_fewer_knots(gearbox, build_scene, time):
    scene = build_scene(gearbox)
    fine = slipping_cage(scene, 2, 1.0, 0.02)
    coarse = CagePath(scene.cage.nominal_speed, 0.5, 0.2, 0.02, 0.1, -0.1, (0.02, 0.03, -0.04, 0.01, 0.02, -0.05, 0.04))
    contacts = assemble(dataclasses.replace(scene, cage=coarse, second_cage=fine))
    set_time(contacts, time)
    for frame, cage in zip(contacts.frames, (coarse, fine), strict=True):
        angle = float(cage.polynomial(time))
        assert frame[FRAME_COSINE] == pytest.approx(math.cos(angle), abs=1e-12)
        assert frame[FRAME_SINE] == pytest.approx(math.sin(angle), abs=1e-12)
        assert frame[FRAME_SPEED] == pytest.approx(float(cage.polynomial(time, nu=1)), rel=1e-12)
