"""Release, regain, load and contact kept of passes against logs of contact that are written out."""

import dataclasses

import numpy as np
import pytest

from physics.contact_events import contact_events
from physics.trace import ContactChanges

NEVER = np.nan


def events(initial, log, *passes):
    """Release, regain, loaded and kept of `passes` (entry, leave) of ball 2 in row 1, whose `log` has (time, made).

    Ball 1 and row 2 do the opposite all along.
    """
    times, made = (np.array(column) for column in zip(*log, strict=True)) if log else (np.zeros(0), np.zeros(0))
    changes = ContactChanges(
        time=np.repeat(times, 3),
        row=np.tile(np.array([1, 1, 2], np.int16), times.size),
        ball=np.tile(np.array([1, 2, 2], np.int16), times.size),
        made=np.ravel([[not now, now, not now] for now in made]).astype(bool),
        initial=np.array([[not initial, initial], [not initial, not initial]]),
    )
    entry, leave = (np.array(column, float) for column in zip(*passes, strict=True))
    return [list(column) for column in contact_events(changes, 1, np.full(len(passes), 2, np.int16), entry, leave)]


@pytest.mark.parametrize(
    ("initial", "log", "expected"),
    [
        (True, [], (NEVER, NEVER, True, True)),
        (False, [], (NEVER, NEVER, False, False)),
        (False, [(5.8, True)], (NEVER, NEVER, True, False)),
        (True, [(4.5, False), (5.5, True)], (4.5, 5.5, True, False)),
        (True, [(4.5, False), (6.5, True)], (4.5, 6.5, True, False)),
        (True, [(4.5, False)], (4.5, NEVER, True, False)),
        (
            True,
            [(4.2, False), (4.6, True), (5.1, False), (6.2, True), (7.0, False), (8.0, True)],
            (4.2, 6.2, True, False),
        ),
        (True, [(4.2, False), (4.6, True), (5.1, False)], (4.2, NEVER, True, False)),
        (True, [(3.0, False)], (NEVER, NEVER, False, False)),
        (True, [(3.0, False), (5.0, True), (5.5, False), (5.8, True)], (NEVER, NEVER, True, False)),
        (False, [(3.0, True), (4.5, False), (5.5, True)], (4.5, 5.5, True, False)),
        (True, [(4.0, False), (6.0, True)], (4.0, 6.0, True, False)),
        (True, [(6.0, False), (7.0, True)], (6.0, 7.0, True, False)),
        (True, [(6.5, False), (7.5, True)], (NEVER, NEVER, True, True)),
    ],
)
def test_a_pass_from_4_to_6_tells_what_its_own_ball_does(initial, log, expected):
    release, regain, loaded, kept = events(initial, log, (4.0, 6.0))
    assert (release[0], regain[0], loaded[0], kept[0]) == pytest.approx(expected, nan_ok=True)


def test_a_pass_that_begins_before_the_record_takes_contact_as_it_stands_at_0():
    assert events(True, [(0.5, False), (1.5, True)], (-1.0, 1.0)) == [[0.5], [1.5], [True], [False]]
    release, regain, loaded, kept = events(False, [(0.5, True), (0.7, False), (0.9, True)], (-1.0, 1.0))
    assert np.isnan([release[0], regain[0]]).all()
    assert (loaded, kept) == ([True], [False])


def test_a_pass_that_begins_in_a_lead_in_takes_contact_as_it_stands_at_0():
    release, regain, loaded, kept = events(True, [(-0.5, False), (0.5, True)], (-1.0, 1.0))
    assert np.isnan([release[0], regain[0]]).all()
    assert (loaded, kept) == ([True], [False])
    assert events(False, [(-0.5, True), (0.5, False), (0.7, True)], (-1.0, 1.0)) == [[0.5], [0.7], [True], [False]]


def test_passes_of_one_ball_do_not_share_their_events():
    log = [(1.5, False), (1.8, True), (4.5, False), (4.8, True)]
    assert events(True, log, (1.0, 2.0), (4.0, 5.0)) == [[1.5, 4.5], [1.8, 4.8], [True, True], [False, False]]


def test_each_row_has_its_own_contact_at_the_start():
    none = ContactChanges(np.zeros(0), np.zeros(0, np.int16), np.zeros(0, np.int16), np.zeros(0, bool), None)
    both = dataclasses.replace(none, initial=np.array([[True, False], [False, True]]))
    for row, loaded in ((1, [True, False]), (2, [False, True])):
        found = contact_events(both, row, np.array([1, 2], np.int16), np.full(2, 4.0), np.full(2, 6.0))
        assert found[2].tolist() == loaded
