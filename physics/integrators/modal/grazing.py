"""Balls that may touch a bump of a spall, or lift over a dent of it, between the instants a step looks at.

A path over a rough or a measured surface may have features finer than a step. How far it can stray from its chord over
the arc that a ball covers in the step is known beforehand; only a ball nearer to a change than that, or one that is
compressed and yet let go of, is followed through the step. What its compression would be over a smooth race runs as the
cubic between both ends, so only the path has to be looked at.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics._jit import njit_inline, njit_inner
from physics.arrays import Array
from physics.contact.contact_set import NOTED_COMPRESSION, NOTED_RATE
from physics.contact.forces import ACTIVE, CLOSING, COMPRESSION, Contacts, law_force
from physics.contact.track import (
    CAGE,
    CELL,
    RELIEF,
    Track,
    passage,
    path_under,
    place_of,
)
from physics.paths.depth_path import BREAK, RELIEF_LEVELS, span_of

# A ball near a change is looked at once a cell of its path, at most this often in a step.
MOST_LOOKS = 64
# A share of the step that lies beyond it; and how far behind a corner, as a share of the step, its far side is looked
# at: within this the cage's slip hardly changes.
LATER, BEHIND = 2.0, 1e-4


class Ride(NamedTuple):
    """How a ball rides over a `spall` in a `step` (s): from the `arc` (rad) on over its `travel` (rad, above 0).

    `over_race` is what its compression (m) would be over a smooth race: the coefficients of a cubic in the share of the
    step, that of the cube first.
    """

    spall: int
    step: float
    arc: float
    travel: float
    over_race: tuple[float, float, float, float]


@njit_inner
def has_relief(track: Track) -> bool:
    """Whether some spall's path has features finer than steps need be."""
    relief = 0.0
    for spall in range(track.spalls.shape[0]):
        relief = max(relief, track.spalls[spall, RELIEF])
    return relief > 0.0


@njit_inline
def mark_grazing(contacts: Contacts, noted: Array, time: float, step: float, suspects: Array) -> int:
    """Put into `suspects` (G, M) the share of the step at which each ball is first seen to contradict the contact set,
    or 0; how many do. If none does, `suspects` is left as it was.

    `contacts` are as `press` left them at the end of the step, `noted` (G, 2, M) is the motion at its beginning.
    """
    balls, track, grazing = contacts.balls, contacts.track, 0
    for spall in range(track.spalls.shape[0]):
        if track.spalls[spall, RELIEF] == 0.0:
            continue
        row, cage = track.spalls[spall], int(track.spalls[spall, CAGE])
        travel, arc, turns, leave = passage(track, spall, time, step)
        cells = abs(travel) / row[CELL]
        level = 0
        while level < RELIEF_LEVELS - 1 and cells > 1 << level:
            level += 1
        while arc <= leave:
            place = place_of(track, spall, turns)
            begin, final = noted[cage, NOTED_COMPRESSION, place], balls[cage, COMPRESSION, place]
            near = min(abs(final), abs(begin)) < row[RELIEF + level]
            # A ball that is compressed and yet free, as the film would have to pull it, may be pressed at any corner.
            let_go = contacts.law.no_tension and balls[cage, ACTIVE, place] < 0.5 and max(begin, final) > 0.0
            if near or let_go:
                looks = int(min(float(MOST_LOOKS), math.ceil(cells) + 1.0))
                seen = _first_contradiction(contacts, noted, spall, place, step, arc, travel, looks)
                if seen > 0.0:
                    if grazing == 0:
                        suspects[:] = 0.0
                    suspects[cage, place] = seen
                    grazing += 1
            turns += 1.0
            arc += track.spacing
    return grazing


@njit_inline
def _first_contradiction(
    contacts: Contacts, noted: Array, spall: int, place: int, step: float, arc: float, travel: float, looks: int
) -> float:
    """Share of the step at which a ball that starts at `arc` and covers `travel` first contradicts the contact set; 0
    if it is seen at none of the `looks`, nor between two that it turns back between."""
    balls, track = contacts.balls, contacts.track
    cage = int(track.spalls[spall, CAGE])
    depth, slope = path_under(track, spall, arc)
    begin = noted[cage, NOTED_COMPRESSION, place] + depth
    begin_rate = step * noted[cage, NOTED_RATE, place] + slope * travel
    depth, slope = path_under(track, spall, arc + travel)
    end, end_rate = balls[cage, COMPRESSION, place] + depth, step * balls[cage, CLOSING, place] + slope * travel
    c2 = 3.0 * (end - begin) - 2.0 * begin_rate - end_rate
    c3 = begin_rate + end_rate - 2.0 * (end - begin)
    ride = Ride(spall, step, arc, travel, (c3, c2, begin_rate, begin))
    held = balls[cage, ACTIVE, place] > 0.5
    corner = _first_corner(contacts, ride) if contacts.law.no_tension and not held else LATER
    before, rate_before = 0.0, step * noted[cage, NOTED_RATE, place]
    for look in range(1, looks + 1):
        share = look / looks
        if before >= corner:
            break
        touching, rate = _touching_at(contacts, ride, share)
        if rate_before * rate < 0.0 and (rate < 0.0) != held:
            turn = before + (share - before) * rate_before / (rate_before - rate)
            touching_there, _ = _touching_at(contacts, ride, turn)
            if touching_there != held:
                return min(turn, corner)
        if touching != held and look < looks:
            return min(share, corner)
        before, rate_before = share, rate
    return corner if corner < LATER else 0.0


@njit_inner
def _first_corner(contacts: Contacts, ride: Ride) -> float:
    """Share of the step at which a free ball is first taken hold of at a corner of its path, where it begins to be
    pressed all at once; LATER if at none."""
    track = contacts.track
    first, last = span_of(track.paths, ride.spall)
    corners = track.paths.pieces[first:last, BREAK]
    for corner in range(np.searchsorted(corners, ride.arc, side="right"), corners.size):
        behind = (corners[corner] - ride.arc) / ride.travel + BEHIND
        if not behind < 1.0:
            break
        touching, _ = _touching_at(contacts, ride, behind)
        if touching:
            return behind
    return LATER


@njit_inline
def _touching_at(contacts: Contacts, ride: Ride, share: float) -> tuple[bool, float]:
    """Whether a ball touches at a share of the step, and its rate of compression (m a step) there."""
    c3, c2, c1, c0 = ride.over_race
    depth, slope = path_under(contacts.track, ride.spall, ride.arc + share * ride.travel)
    compression = ((c3 * share + c2) * share + c1) * share + c0 - depth
    rate = (3.0 * c3 * share + 2.0 * c2) * share + c1 - slope * ride.travel
    touching = compression > 0.0
    if contacts.law.no_tension and touching:
        touching = law_force(contacts.law, compression, rate / ride.step) > 0.0
    return touching, rate
