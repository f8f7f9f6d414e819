"""Exact truth of every ball pass: edges and deepest point from the cage's path, release and regain from contact."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from labels.load_dips import load_dips
from physics.arrays import Array, Flags
from physics.contact_events import contact_events, no_contact_events
from physics.paths.passages import Passages, passages
from physics.paths.profile import build_path
from physics.scene import Scene
from physics.trace import ContactChanges

Numbers = NDArray[np.int16]


@dataclass(frozen=True)
class PassTable:
    """Every passage of a ball over a spall that overlaps the record, by time of entry; all shapes (N,).

    `row` and `ball` count from 1, `defect` counts the scene's spalls from 0. Times are in s; those of entry, deepest
    point and exit may lie outside the record. `release_time` is the first loss of contact from entry to exit and
    `regain_time` the beginning of contact that ends the last loss begun there; both are NaN if the ball kept contact
    or did not touch at entry, and `regain_time` alone if contact does not begin again within the record.
    Where contact is never lost, `fall_time` and `rise_time` are the first fall and the last rise of the ball's
    quasi-static load through half of what it would be without spalls; NaN where there is none or contact is lost, and
    of passes that an end of the record cuts or of balls that are not loaded.
    `loaded`: the ball touches both races at some moment of the pass; `complete`: all its times lie inside the record.
    """

    row: Numbers
    ball: Numbers
    defect: Numbers
    entry_time: Array
    deepest_time: Array
    exit_time: Array
    release_time: Array
    regain_time: Array
    loaded: Flags
    complete: Flags
    fall_time: Array
    rise_time: Array

    def __len__(self) -> int:
        return int(self.entry_time.size)


def ball_passes(scene: Scene, changes: ContactChanges | None, duration: float) -> PassTable:
    """All ball passes of `scene` that overlap the record from 0 to `duration` (s).

    A pass cut by an end of the record is kept with `complete` False; its release is the first one seen. Without
    `changes` nothing is known of contact: no release, no regain, `loaded` False.
    """
    tables = [_no_passes(), *(_passes_over(scene, changes, duration, defect) for defect in range(len(scene.spalls)))]
    joined = {
        field.name: np.concatenate([getattr(table, field.name) for table in tables]) for field in fields(PassTable)
    }
    order = np.lexsort((joined["ball"], joined["row"], joined["entry_time"]))
    return PassTable(**{name: column[order] for name, column in joined.items()})


def _no_passes() -> PassTable:
    index, time, truth = np.zeros(0, np.int16), np.zeros(0), np.zeros(0, np.bool_)
    return PassTable(
        row=index,
        ball=index,
        defect=index,
        entry_time=time,
        deepest_time=time,
        exit_time=time,
        release_time=time,
        regain_time=time,
        loaded=truth,
        complete=truth,
        fall_time=time,
        rise_time=time,
    )


def _passes_over(scene: Scene, changes: ContactChanges | None, duration: float, defect: int) -> PassTable:
    row = scene.spalls[defect].row
    ball, entry, deepest, leave = _crossings(scene, defect, duration)
    events = no_contact_events(ball.size) if changes is None else contact_events(changes, row, ball, entry, leave)
    ended = np.isnan(events.release) | np.isfinite(events.regain)
    kept = events.kept & (entry >= 0.0) & (leave <= duration)
    fall, rise = np.full(ball.size, np.nan), np.full(ball.size, np.nan)
    fall[kept], rise[kept] = load_dips(scene, row, ball[kept], entry[kept], leave[kept])
    return PassTable(
        row=np.full(ball.size, row, np.int16),
        ball=ball,
        defect=np.full(ball.size, defect, np.int16),
        entry_time=entry,
        deepest_time=deepest,
        exit_time=leave,
        release_time=events.release,
        regain_time=events.regain,
        loaded=events.loaded,
        complete=(entry >= 0.0) & (leave <= duration) & ended,
        fall_time=fall,
        rise_time=rise,
    )


def _crossings(scene: Scene, defect: int, duration: float) -> tuple[Numbers, Array, Array, Array]:
    """Ball (N,) from 1 and times (N,) at which it enters, is deepest in and leaves a spall, each pass of a record."""
    spall = scene.spalls[defect]
    half = spall.extent / 2.0
    # Outside the record the cage goes on at its mean speed, so no pass under way at either end takes longer than this.
    speed = scene.crossing_speed(spall)
    if speed == 0.0:  # a cage that turns with the race
        return np.zeros(0, np.int16), np.zeros(0), np.zeros(0), np.zeros(0)
    margin = spall.extent / speed
    # A little earlier, so that none is lost to rounding; those that are over by then are left out below.
    entries = passages(scene, defect, -half, -1.001 * margin, duration)
    if entries.time.size == 0:
        return entries.ball.astype(np.int16), entries.time, entries.time, entries.time
    # A little early, so that a deepest point on the entry edge itself is not lost to rounding.
    later = (entries.time[0] - 1e-6 * margin, duration + 2.0 * margin)
    deepest = passages(scene, defect, build_path(spall, scene.rig.bearing).deepest, *later)
    exits = passages(scene, defect, half, *later)
    lowest, leave = _following(entries, deepest), _following(entries, exits)
    overlapping = leave >= 0.0
    ball = entries.ball.astype(np.int16)
    return ball[overlapping], entries.time[overlapping], lowest[overlapping], leave[overlapping]


def _following(entries: Passages, later: Passages) -> Array:
    """Times (N,) at which the ball of each entry crosses a later point: both lists hold consecutive balls."""
    first = int(np.argmax(later.ball == entries.ball[0]))
    return later.time[first : first + entries.time.size]
