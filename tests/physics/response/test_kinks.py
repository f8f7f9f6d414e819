"""The instants that steps must not run over: which ball is at an edge of its path then."""

import math

import numpy as np
import pytest
from variants import changed

from physics.assembly import assemble
from physics.cage import CagePath
from physics.contact.forces import PLACE
from physics.integrators.stops import ANY_BALL
from physics.paths.profile import build_path, wrap
from physics.response.kinks import known_kinks
from physics.spall import Spall


@pytest.mark.parametrize("own_cages", [False, True])
@pytest.mark.parametrize("race", ["outer", "inner"])
def test_at_every_kink_its_ball_is_at_an_edge_of_the_path_on_its_own_row_and_cage(race, own_cages, reference_scene):
    spalls = tuple(Spall(race, row, 4.0 + row, 0.1, 1e-5, 0.02, 0.03) for row in (1, 2))
    scene = changed(reference_scene("G0", 0.5), spalls=spalls)
    if own_cages:
        scene = changed(scene, second_cage=CagePath(0.9 * scene.cage.nominal_speed, 0.5, 0.7))
    contacts = assemble(scene)
    kinks = known_kinks(scene, contacts)
    cage, place = np.divmod(kinks.ball, contacts.balls.shape[2])
    turned = np.array([path.angle(kinks.time) for path in scene.cages])[cage, np.arange(cage.size)]
    angle = turned + contacts.balls[cage, PLACE, place]
    edges = np.concatenate(
        [spall.angle + spall.travel_sign * build_path(spall, scene.rig.bearing).breaks for spall in spalls]
    )
    away = np.abs(wrap((angle - scene.race_speed(race) * kinks.time)[:, None] - edges)).min(axis=1)
    assert away.max() < 1e-9  # rad
    assert (np.diff(kinks.time) >= 0.0).all()
    passes = sum(abs(scene.race_speed(race) - scene.cage_of(row).mean_speed) for row in (1, 2)) * 0.5 / math.tau * 12
    assert kinks.time.size == pytest.approx(4 * passes, abs=8)  # two edges and two ends of tapers on each row


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_both_edges_of_a_ridge_passed_within_a_step_stop_the_steps_of_all_balls(race, reference_scene):
    ridge, extent = 0.002, 0.1  # rad; so much nearer are the edges of no other two spalls, nor of one
    row = [Spall(race, 1, 4.0, extent, 1e-5), Spall(race, 1, 4.0 + extent + ridge, extent, 1e-5)]
    other = Spall(race, 2, 4.0 + 0.5 * extent + 0.5 * ridge, extent, 1e-5)
    scene = changed(reference_scene("G0", 0.5), spalls=(*row, other))
    speed = abs(scene.cage.mean_speed - scene.race_speed(race))
    all_balls = {}
    for share in (0.99, 1.01):
        kinks = known_kinks(scene, assemble(scene), share * ridge / speed)
        all_balls[share] = kinks.time[kinks.ball == ANY_BALL]
    assert all_balls[0.99].size == 0
    passes = scene.rig.bearing.balls * speed * scene.duration / math.tau
    assert all_balls[1.01].size == pytest.approx(2 * passes, abs=2)
    apart = np.diff(all_balls[1.01])
    assert apart.min() == pytest.approx(ridge / speed, rel=1e-6)
    assert np.count_nonzero(apart < 1.01 * ridge / speed) == pytest.approx(passes, abs=1)


def test_edges_of_one_spall_passed_within_a_step_stop_its_ball_alone(reference_scene):
    taper = 1e-3  # rad, and 0.9 rad to the other spall
    spalls = tuple(Spall("outer", 1, angle, 0.1, 1e-5, taper, taper) for angle in (4.0, 5.0))
    scene = changed(reference_scene("G0", 0.5), spalls=spalls)
    kinks = known_kinks(scene, assemble(scene), 2.0 * taper / scene.cage.mean_speed)
    assert kinks.time.size > 0
    assert not (kinks.ball == ANY_BALL).any()
