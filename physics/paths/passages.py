"""When balls cross a given point of a spall, from the cage path alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PPoly

from physics.arrays import Array, Index
from physics.crossing import crossing_times
from physics.scene import Scene


@dataclass(frozen=True)
class Passages:
    """Crossings of one point of one spall by the balls of its row, in time order: `time` (P,) s, `ball` (P,) from 1."""

    time: Array
    ball: Index


def passages(scene: Scene, spall_index: int, arc: float, start: float, stop: float) -> Passages:
    """Every crossing, from `start` to `stop` (s), of the point at `arc` (rad from the spall's centre, along travel).

    Outside [0, duration] the cage goes on at its mean speed.
    """
    return crossings(scene, spall_index, np.array([arc]), start, stop)


def crossings(scene: Scene, spall_index: int, arcs: Array, start: float, stop: float) -> Passages:
    """Every crossing of the points at `arcs` (N,), point after point, each as `passages` gives it.

    None where the cage turns with the race, even if a ball stands on a point.
    """
    spall = scene.spalls[spall_index]
    bearing = scene.rig.bearing
    cage, race_speed = scene.cage_of(spall.row), scene.race_speed(spall.race)
    sign = float(spall.travel_sign)
    speed = sign * (cage.mean_speed - race_speed)
    if speed == 0.0:
        return Passages(np.zeros(0), np.zeros(0, dtype=np.int64))
    path, breaks = sign * cage.polynomial.c, cage.polynomial.x
    # The race's own turning is taken off piece by piece: t = (t − x) + x inside the piece that starts at x.
    path[-2] -= sign * race_speed
    path[-1] -= sign * race_speed * breaks[:-1]
    # Not checked again: to check a path takes as long as to find the crossings.
    travel = PPoly.construct_fast(path, breaks, extrapolate=True)
    asked = np.array([start, stop])
    inside = np.clip(asked, 0.0, scene.duration)
    first_angle, last_angle = (travel(inside) + speed * (asked - inside)).tolist()
    turns, targets = [], []
    for arc in arcs:
        offset = sign * (spall.angle - (spall.row - 1) * bearing.stagger) + arc
        first, last = (
            math.ceil((first_angle - offset) / bearing.spacing),
            math.floor((last_angle - offset) / bearing.spacing),
        )
        turns.append(np.arange(first, last + 1))
        targets.append(offset + turns[-1] * bearing.spacing)
    time = crossing_times(travel, speed, scene.duration, np.concatenate(targets))
    return Passages(time, (-sign * np.concatenate(turns)).astype(np.int64) % bearing.balls + 1)
