import math
from dataclasses import replace

import numpy as np
import pytest

from labels.load_dips import first_and_last_crossing, load_dips
from labels.truth import ball_passes
from physics.imperfections import Imperfections, Waviness
from physics.paths.passages import passages
from physics.simulate import simulate
from physics.spall import Spall
from physics.statics.load_distribution import require_equilibrium
from physics.trace import ContactChanges

DURATION = 0.3


def shallow(depth):
    """4° at the bottom of the outer race, row 1, raised-cosine tapers of half its length each."""
    arc = math.radians(4.0)
    return Spall("outer", 1, math.radians(270.0), arc, depth, arc / 2.0, arc / 2.0)


def times_at(scene, arc):
    """Times at which the balls cross `arc` (rad from the spall's centre)."""
    return passages(scene, 0, arc, 0.0, DURATION).time


def dips(scene):
    half = scene.spalls[0].extent / 2.0
    entry = passages(scene, 0, -half, 0.0, DURATION)
    leave = times_at(scene, half)
    leave = leave[leave > entry.time[0]]
    count = min(entry.time.size, leave.size)
    found = load_dips(scene, 1, entry.ball[:count], entry.time[:count], leave[:count])
    return entry.time[:count], leave[:count], *found


def test_load_halves_where_the_path_has_dropped_by_its_share_of_the_compression(make_scene):
    # One ball of 12 in two rows gives way: with the shaft held by the others, F = K δ^1.5 halves at a drop of
    # δ (1 − 2^(−2/3)) = 0.37 δ. The shaft sinks a little after it, so the true drop is somewhat larger.
    scene = make_scene(shallow(4.5e-6), duration=DURATION)
    entry, leave, fall, _ = dips(scene)
    compression = (scene.rig.bearing.stribeck_peak_load(346.0) / scene.rig.bearing.load_deflection) ** (2.0 / 3.0)
    drop = compression * (1.0 - 0.5 ** (2.0 / 3.0))
    rigid = scene.spalls[0].extent / 2.0 * math.acos(1.0 - 2.0 * drop / 4.5e-6) / math.pi
    reached = (fall - entry) / (leave - entry) * scene.spalls[0].extent
    assert np.all(reached > rigid)
    assert np.all(reached < 1.35 * rigid)  # the others take over at most a third of the sinking


def test_a_symmetric_dip_falls_and_rises_symmetrically(make_scene):
    scene = make_scene(shallow(4.5e-6), duration=DURATION)
    entry, leave, fall, rise = dips(scene)
    # The cage does not slip and the spall lies in the load's direction; what differs is only the cage's phase.
    assert fall - entry == pytest.approx(leave - rise, rel=0.02)


def test_a_dip_too_shallow_for_half_the_load_has_no_times(make_scene):
    scene = make_scene(shallow(1.0e-6), duration=DURATION)
    _, _, fall, rise = dips(scene)
    assert np.isnan(fall).all()
    assert np.isnan(rise).all()


def test_the_walls_of_a_spall_without_tapers_are_where_the_load_falls_and_rises(make_scene):
    """On a wall itself rounding would decide on which side the ball stands, and the load of every other pass."""
    spall = replace(shallow(4.5e-6), entry_taper=0.0, exit_taper=0.0)
    entry, leave, fall, rise = dips(make_scene(spall, duration=DURATION))
    assert entry.size > 5
    assert fall == pytest.approx(entry, abs=2.6e-3 * (leave - entry).max())  # a step of a 400th
    assert rise == pytest.approx(leave, abs=2.6e-3 * (leave - entry).max())


def test_the_pass_table_gives_them_only_where_contact_is_never_lost(make_scene):
    kept, lost = make_scene(shallow(4.5e-6), duration=DURATION), make_scene(shallow(15e-6), duration=DURATION)
    tables = [ball_passes(scene, simulate(scene, 16384.0).changes, DURATION) for scene in (kept, lost)]
    inside = [table.complete & table.loaded for table in tables]
    assert np.isnan(tables[0].release_time[inside[0]]).all()
    assert np.isfinite(tables[0].fall_time[inside[0]]).all()
    assert (tables[0].rise_time > tables[0].fall_time)[inside[0]].all()
    assert np.isfinite(tables[1].release_time[inside[1]]).all()
    assert np.isnan(tables[1].fall_time).all()


def test_short_waves_under_a_long_spall_are_part_of_the_due_load(make_scene, monkeypatch):
    arc = math.radians(50.0)
    long = Spall("outer", 1, math.radians(270.0), arc, 4.5e-6, arc / 2.0, arc / 2.0)
    # The short wave is the one that counts, whatever long ones there are beside it.
    waves = Imperfections(waviness=(Waviness("inner", 58, 6e-7), Waviness("inner", 2, 1e-9)))
    scene = replace(make_scene(long, duration=DURATION), imperfections=waves)
    found = dips(scene)
    monkeypatch.setattr("labels.load_dips.SAMPLES_PER_PASS", 4000)
    entry, leave, *dense = dips(scene)
    assert np.isfinite(dense).any()
    for times, dense_times in zip(found[2:], dense, strict=True):
        assert times == pytest.approx(dense_times, abs=1e-3 * (leave - entry).max(), nan_ok=True)


def searched(scene, ball, entry, leave):
    """Time of the first fall and the last rise of the load of `ball` of row 1, of all balls' loads at 4001 instants."""
    time = np.linspace(entry, leave, 4001)
    scenes = (scene, replace(scene, spalls=()))
    pressed, due = (require_equilibrium(one, time).ball_load[:, 0, ball - 1] for one in scenes)
    loaded = due > 0.0
    time, enough = time[loaded], (pressed > 0.5 * due)[loaded]
    falls, rises = (time[1:][enough[:-1] & ~enough[1:]], time[1:][~enough[:-1] & enough[1:]])
    return (falls[0], rises[-1]) if falls.size and rises.size and falls[0] < rises[-1] else (np.nan, np.nan)


@pytest.mark.parametrize(
    ("angle_deg", "arc_deg", "depth", "dips_there"),
    [(181.0, 12.0, 1.5e-6, False), (355.0, 12.0, 1.5e-6, False), (190.5, 22.0, 0.8e-6, True)],
)
def test_a_load_falls_only_where_it_was_above_half_before(make_scene, angle_deg, arc_deg, depth, dips_there):
    # Without clearance balls carry load from 180 to 360 degrees, so every spall here has an end of the zone inside.
    arc = math.radians(arc_deg)
    spall = Spall("outer", 1, math.radians(angle_deg), arc, depth, 0.8 * arc, 0.2 * arc)
    scene = make_scene(spall, duration=DURATION)
    entry, leave, fall, rise = dips(scene)
    ball = passages(scene, 0, -0.5 * arc, 0.0, DURATION).ball
    assert entry.size > 5
    for k in range(entry.size):
        expected = searched(scene, int(ball[k]), entry[k], leave[k])
        assert np.isfinite(expected).all() == dips_there
        close = 1e-3 * (leave[k] - entry[k])  # as documented
        assert (fall[k], rise[k]) == pytest.approx(expected, rel=0.0, abs=close, nan_ok=True)


def test_a_load_that_only_rises_and_then_falls_has_no_dip():
    above = np.array([-1.0, 1.0, 1.0, -1.0])
    assert np.isnan(first_and_last_crossing(np.arange(4.0), above)).all()
    # Upside down it falls half-way through the first step and rises half-way through the last.
    assert first_and_last_crossing(np.arange(4.0), -above) == (0.5, 2.5)


def test_of_two_dips_the_first_fall_and_the_last_rise_are_told():
    assert first_and_last_crossing(np.arange(6.0), np.array([1.0, -1.0, 1.0, 1.0, -1.0, 3.0])) == (0.5, 4.25)


def test_a_ball_that_bounces_into_the_spall_and_in_it_has_neither_fall_nor_rise(make_scene):
    scene = make_scene(shallow(4.5e-6), duration=DURATION)
    number = np.zeros(0, np.int16)
    always = ContactChanges(np.zeros(0), number, number, np.zeros(0, bool), np.ones((2, 12), bool))
    undisturbed = ball_passes(scene, always, DURATION)
    told = np.flatnonzero(np.isfinite(undisturbed.fall_time))
    k = told[1]
    entry, leave = undisturbed.entry_time[k], undisturbed.exit_time[k]
    times = entry + (leave - entry) * np.array([-0.1, 0.2, 0.5, 0.8])
    row, ball = np.full(4, 1, np.int16), np.full(4, undisturbed.ball[k], np.int16)
    bouncing = ContactChanges(times, row, ball, np.array([False, True, False, True]), always.initial)
    table = ball_passes(scene, bouncing, DURATION)
    assert table.loaded[k]
    assert np.isnan([table.release_time[k], table.fall_time[k], table.rise_time[k]]).all()
    others = told[told != k]
    assert np.array_equal(np.flatnonzero(np.isfinite(table.fall_time)), others)
    assert np.array_equal(table.fall_time[others], undisturbed.fall_time[others])
