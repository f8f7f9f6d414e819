"""Balls that may touch a bump of a rough spall, or lift over a dent of it, between the instants a step looks at.

A path over a rough surface has features finer than a step. How far it can stray from its chord over the arc that a ball
covers in the step is known beforehand; only a ball nearer to a change than that is followed through the step.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit_lean
from physics.contact import ACTIVE, COMPRESSION, Law
from physics.integrators.events import contact_condition
from physics.profile import RELIEF_LEVELS
from physics.track import ANGLE, CAGE, CELL, FIRST_BALL, FIRST_BREAK, PIECES, RELIEF, SIGN, SPEED, Track, cage_at

Array = NDArray[np.float64]

# A ball near a change is looked at once a cell of its path, at most this often in a step.
MOST_LOOKS = 64


@njit_lean
def is_rough(track: Track) -> bool:
    """Whether some spall's path has features finer than steps need be."""
    relief = 0.0
    for spall in range(track.spalls.shape[0]):
        relief = max(relief, track.spalls[spall, RELIEF])
    return relief > 0.0


@njit_lean
def mark_grazing(balls: Array, track: Track, noted: Array, time: float, step: float, looks: Array) -> int:
    """Put into `looks` (G, M) how often each ball has to be looked at inside the step, and return how many have to.

    `balls` is as `press` left it at the end of the step, `noted` (G, 2, M) the motion at its beginning.
    """
    grazing = 0
    for spall in range(track.spalls.shape[0]):
        if track.spalls[spall, RELIEF] == 0.0:
            continue
        row, cage = track.spalls[spall], int(track.spalls[spall, CAGE])
        angle, speed = cage_at(track, cage, time + step)
        covered = abs(speed - row[SPEED]) * step
        cells = covered / row[CELL]
        level = 0
        while level < RELIEF_LEVELS - 1 and cells > 1 << level:
            level += 1
        relief = row[RELIEF + level]
        first = int(row[FIRST_BREAK])
        entry, leave = track.breaks[first], track.breaks[first + int(row[PIECES])] + covered
        ahead = row[SIGN] * (angle - row[ANGLE] - row[SPEED] * (time + step))
        turns = math.ceil((entry - ahead) / track.spacing)
        while ahead + turns * track.spacing <= leave:
            place = int(row[FIRST_BALL]) + int(row[SIGN] * turns) % track.row_size
            if min(abs(balls[cage, COMPRESSION, place]), abs(noted[cage, 0, place])) < relief:
                if grazing == 0:
                    looks[:] = 0.0
                looks[cage, place] = min(float(MOST_LOOKS), math.ceil(cells) + 1.0)
                grazing += 1
            turns += 1.0
    return grazing


@njit_lean
def follow_grazing(
    balls: Array, law: Law, track: Track, time: float, step: float, begin: Array, end: Array, looks: Array
) -> None:
    """Turn `looks` (G, M) into the share of the step at which each ball is first seen to contradict the contact set,
    or 0, with the ring's motion between `begin` and `end` (3, 2)."""
    for cage in range(looks.shape[0]):
        for j in range(looks.shape[1]):
            count, seen = int(looks[cage, j]), 0.0
            for look in range(1, count):
                share = look / count
                value, _, _ = contact_condition(
                    balls, law, track, cage * looks.shape[1] + j, time, step, share, begin, end
                )
                if (value > 0.0) != (balls[cage, ACTIVE, j] > 0.5):
                    seen = share
                    break
            looks[cage, j] = seen
