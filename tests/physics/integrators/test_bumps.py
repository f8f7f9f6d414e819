"""What a carried step is said to miss of a rolled path: nothing within a cell, and what quadrature says beyond."""

import dataclasses

import numpy as np
import pytest
from kernels import passed_over
from scipy.interpolate import CubicHermiteSpline

from physics.assembly import assemble
from physics.contact.forces import ACTIVE, COMPRESSION
from physics.paths.profile import build_path

BALL, PRESSED = 3, 2e-6


@pytest.fixture
def rolled(reference_scene):
    """A path that is rolled over bumps, how fast a ball runs along it (rad/s), and a function that gives what is passed
    over from an `arc` (rad) of that path on in a `step` (s), with these shares of the contact law."""
    scene = reference_scene("F2r", 0.5)
    spall = dataclasses.replace(scene.spalls[0], profile="ball_path", depth=20e-6)
    scene, bearing = dataclasses.replace(scene, spalls=(spall,)), scene.rig.bearing
    contacts = assemble(scene)
    noted = np.full((1, 2, contacts.balls.shape[2]), 0.5 * PRESSED)
    contacts.balls[:, ACTIVE], contacts.balls[:, COMPRESSION] = 0.0, PRESSED
    contacts.balls[0, ACTIVE, BALL] = 1.0
    speed = scene.cage.mean_speed

    def passed(arc, step, spring=1.0, film=1.0):
        time = (spall.angle + arc - bearing.spacing * BALL) % (2.0 * np.pi) / speed
        law = contacts.law._replace(stiffness=spring * contacts.law.stiffness, damping=film * contacts.law.damping)
        return passed_over(contacts._replace(law=law), noted, time, step)

    return build_path(spall, bearing), speed, passed, contacts.law


def _cells(path):
    """Both ends (rad) of every cell that is not beside an end of the path."""
    parts = [np.linspace(*path.breaks[k : k + 2], n + 1) for k, n in enumerate(path.cells)]
    return np.concatenate([np.column_stack([nodes[:-1], nodes[1:]]) for nodes in parts])[20:-20]


def test_within_a_cell_of_the_path_a_step_passes_over_nothing(rolled):
    path, speed, passed, law = rolled
    chosen = np.random.default_rng(3).choice(_cells(path), 40)
    for left, right in chosen:
        step = 0.8 * (right - left) / speed
        whole = law.damping * abs(path.depth(np.array([right]))[0]) + law.stiffness * step * PRESSED**law.exponent
        assert passed(left + 0.1 * (right - left), step) < 1e-9 * whole


def test_over_bumps_it_is_what_simpsons_rule_and_a_cubic_miss(rolled):
    path, speed, passed, law = rolled
    cell, missed = path.cell, []
    for arc in np.random.default_rng(4).uniform(path.breaks[20], path.breaks[-20], 40):
        arcs = arc + 5.0 * cell * np.array([0.0, 0.5, 1.0])
        step, depth, rate = 5.0 * cell / speed, path.depth(arcs), speed * path.slope(arcs)
        film = law.damping * abs(np.diff(depth[::2])[0] - step / 6.0 * (rate @ [1.0, 4.0, 1.0]))
        assert passed(arc, step, spring=0.0) == pytest.approx(film, rel=1e-6, abs=1e-15)
        cubic = CubicHermiteSpline([0.0, step], depth[::2], rate[::2])
        # Simpson's rule takes two thirds of a middle that strays; what strays like (t (h - t))² adds up to 8/15 of it.
        spring = law.stiffness * law.exponent * PRESSED ** (law.exponent - 1.0) * abs(depth[1] - cubic(0.5 * step))
        assert passed(arc, step, film=0.0) == pytest.approx((2 / 3 - 8 / 15) * step * spring, rel=1e-6, abs=1e-15)
        missed.append(film + spring)
    assert min(missed) > 0.0
