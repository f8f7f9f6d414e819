"""Release, regain, load and contact kept of ball passes, read from the log of when each ball touched the races."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit
from physics.arrays import Array, Flags, Index
from physics.trace import ContactChanges


class ContactEvents(NamedTuple):
    """What contact did in each of N ball passes.

    `release` (N,), s, is the first loss of contact in the pass and `regain` (N,), s, the beginning of contact that ends
    the last loss in it, be it later; both are NaN if the ball kept contact or did not touch at entry (or at 0, if that
    is later), and `regain` alone if contact does not begin again. `loaded` (N,): the ball touches both races at some
    moment of the pass. `kept` (N,): it does so at all of them, from entry (or 0) on.
    """

    release: Array
    regain: Array
    loaded: Flags
    kept: Flags


def no_contact_events(passes: int) -> ContactEvents:
    """Those of so many `passes` of which nothing is known: no times, not loaded, not kept."""
    unknown, no = np.full(passes, np.nan), np.zeros(passes, np.bool_)
    return ContactEvents(unknown, unknown.copy(), no, no.copy())


def contact_events(
    changes: ContactChanges, row: int, ball: NDArray[np.int16], entry: Array, leave: Array
) -> ContactEvents:
    """Those of the passes of `ball` (N,), from 1, of the `row`; each lasts from `entry` to `leave` (N,), s."""
    own = changes.row == row
    order = np.lexsort((changes.time[own], changes.ball[own]))
    balls, times, begins = (column[own][order] for column in (changes.ball, changes.time, changes.made))
    first = np.searchsorted(balls, np.arange(1, changes.initial.shape[1] + 2))
    events = no_contact_events(ball.size)
    _fill_events(times, begins, first, changes.initial[row - 1], ball, entry, leave, events)
    return events


@njit
def _fill_events(
    times: Array,
    begins: Flags,
    first: Index,
    initial: Flags,
    ball: NDArray[np.int16],
    entry: Array,
    leave: Array,
    events: ContactEvents,
) -> None:
    """Fill the `events` from the changes of each ball, which lie from `first` (B + 1,) on.

    Each ball's `times` (C,) rise; contact `begins` (C,) at them or is lost, and stood as in `initial` (B,) before.
    """
    release, regain, loaded, kept = events
    for k in range(ball.size):
        touches_at_entry, made_within, ended = initial[ball[k] - 1], False, True
        for change in range(first[ball[k] - 1], first[ball[k]]):
            time, made = times[change], begins[change]
            if time < max(entry[k], 0.0):
                touches_at_entry = made
            within = entry[k] <= time <= leave[k]
            made_within = made_within or (within and made)
            if within and not made:
                if np.isnan(release[k]):
                    release[k] = time
                ended = False
            elif made and not ended:
                regain[k] = time
                ended = True
        kept[k] = touches_at_entry and np.isnan(release[k])
        if not touches_at_entry:
            release[k] = np.nan
        # A loss that did not end leaves no regain of an earlier one.
        if not (touches_at_entry and ended):
            regain[k] = np.nan
        loaded[k] = touches_at_entry or made_within
