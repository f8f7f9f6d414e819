"""The instants, known beforehand, at which a ball crosses an edge of its path."""

from __future__ import annotations

import numpy as np

from physics.contact.forces import Contacts
from physics.contact.track import CAGE, FIRST_BALL
from physics.integrators.stops import Stops
from physics.paths.depth_path import BREAK, span_of
from physics.paths.passages import crossings
from physics.scene import Scene


def known_kinks(scene: Scene, contacts: Contacts) -> Stops:
    """Every crossing of an edge of a path during the scene, in time order."""
    paths = contacts.track.paths
    times, balls = [np.zeros(0)], [np.zeros(0, dtype=np.int64)]
    for index in range(len(scene.spalls)):
        row = contacts.track.spalls[index].astype(int)
        first, behind = span_of(paths, index)
        found = crossings(scene, index, paths.pieces[first:behind, BREAK], 0.0, scene.duration)
        times.append(found.time)
        balls.append(row[CAGE] * contacts.balls.shape[2] + row[FIRST_BALL] + found.ball - 1)
    time, ball = np.concatenate(times), np.concatenate(balls)
    order = np.argsort(time, kind="stable")
    return Stops(time[order], ball[order])
