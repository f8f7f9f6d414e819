"""The instants, known beforehand, at which a ball crosses an edge of its path."""

from __future__ import annotations

import numpy as np

from physics.arrays import Array, Index
from physics.contact.forces import Contacts
from physics.contact.track import CAGE, FIRST_BALL
from physics.integrators.stops import ANY_BALL, Stops
from physics.paths.depth_path import BREAK, span_of
from physics.paths.passages import crossings
from physics.scene import Scene


def known_kinks(scene: Scene, contacts: Contacts, longest: float = 0.0) -> Stops:
    """Every crossing of an edge of a path during the scene, in time order.

    Where a ball passes from one spall to another within the `longest` step (s), a step ends at both edges of the ridge
    between them: a free ball may touch there unseen by steps that begin before the ridge and end behind it.
    """
    paths = contacts.track.paths
    times, balls, spalls = [np.zeros(0)], [np.zeros(0, dtype=np.int64)], [np.zeros(0, dtype=np.int64)]
    for index in range(len(scene.spalls)):
        row = contacts.track.spalls[index].astype(int)
        first, behind = span_of(paths, index)
        found = crossings(scene, index, paths.pieces[first:behind, BREAK], 0.0, scene.duration)
        times.append(found.time)
        balls.append(row[CAGE] * contacts.balls.shape[2] + row[FIRST_BALL] + found.ball - 1)
        spalls.append(np.full(found.time.size, index))
    time, ball = np.concatenate(times), np.concatenate(balls)
    if len({spall.row for spall in scene.spalls}) < len(scene.spalls):
        ball[_beside_ridges(time, ball, np.concatenate(spalls), longest)] = ANY_BALL
    order = np.argsort(time, kind="stable")
    return Stops(time[order], ball[order])


def _beside_ridges(time: Array, ball: Index, spall: Index, longest: float) -> Index:
    """Which of the crossings (S,) are those of a ball that passes from one spall to another within the `longest` step
    (s)."""
    order = np.lexsort((time, ball))
    before, after = order[:-1], order[1:]
    # Spalls that touch may overlap by rounding.
    passes = (ball[before] == ball[after]) & (spall[before] != spall[after]) & (time[after] - time[before] <= longest)
    return np.concatenate([before[passes], after[passes]])
