"""A rolled path as smooth branches, with more nodes where those a step apart tell too little of it."""

from __future__ import annotations

import math

import numpy as np

from physics._jit import njit
from physics.arrays import Array, Index
from physics.paths.corners import LEAP, NEAREST, Branches, RolledPath, branches, corners_of
from physics.paths.held_ball import Ball, Held, between_points
from physics.paths.rolling import Rolled, drop_on

# A bump between both that meet in a corner holds the ball if it does so by more than this (m) higher than they.
HIGHER = 1e-11
# Bumps beside such bumps are looked for again; in 480 records of `corpus` four rounds found the last.
MOST_ROUNDS = 32
# How often cells are halved in which the contact leaps, as it does in hollows as well.
HOLLOW_HALVINGS = 6
# A contact so near to a lip (steps) is on it.
ON_LIP = 1e-3
# To this (m) the height of a ball is known that is held between points of a surface.
BETWEEN_POINTS_ERROR = 1e-13


def bumpy_branches(rolled: Rolled) -> Branches:
    """The smooth branches of a path over a rough surface, those of bumps that hold the ball over less than a step among
    them."""
    return branches(_with_narrow_bumps(rolled, rolled.path))


def gap_branches(rolled: Rolled, floor_ends: Array) -> Branches:
    """The smooth branches of a path over a gap without bumps; they also end at the `floor_ends` (E,), rad, which the
    ball rolls over.

    There a taper ceases to bend, so the path's curvature jumps, which no cubic over both sides follows.
    """
    path = _with_narrow_bumps(rolled, _with_hollows(rolled))
    arc = floor_ends[(floor_ends > path.arc[0]) & (floor_ends < path.arc[-1])]
    cells, floor = _cells_of(path, arc), rolled.surface(arc)
    touched = _held_between(path, rolled, cells, arc).drop > floor - BETWEEN_POINTS_ERROR
    ends = Held(arc[touched], floor[touched], floor[touched])
    return _ending_at(path, rolled, cells[touched], arc[touched], ends)


def table_branches(rolled: Rolled, lips: Array, depth: Array) -> Branches:
    """The smooth branches of a path over a surface that is straight between `lips` (L,), rad, at `depth` (L,), m; they
    also end where the ball begins or ceases to hang on one of these.

    There it ceases or begins to touch the straight surface beside the lip, and the path's curvature jumps.
    """
    path = _with_narrow_bumps(rolled, rolled.path)
    # The face behind each lip but the last, and that before each but the first.
    lip = np.concatenate([np.arange(lips.size - 1), np.arange(1, lips.size)])
    arc = lips[lip] - rolled.ball.away_on(depth[lip], np.tile(np.diff(depth) / np.diff(lips), 2))
    # At a wall down from the race the ball hangs on the race's own edge, and leaps from there.
    at_wall = np.isin(lip, (0, lips.size - 1)) & (depth[lip] > 0.0)
    order = np.argsort(arc)
    order = order[(arc[order] > path.arc[0]) & (arc[order] < path.arc[-1]) & ~at_wall[order]]
    lip, arc = lip[order], arc[order]
    cells, own = _cells_of(path, arc), (lips[lip] - path.arc[0]) / rolled.pace
    before, after = path.contact[cells], path.contact[cells + 1]
    on_lip = np.minimum(np.abs(before - own), np.abs(after - own)) < ON_LIP
    # Where the contact leaps, the ball may have left the lip for another one before it came to the face.
    hung = np.flatnonzero(on_lip & (np.abs(after - before) <= LEAP))
    # Where three points are in line, the ball leaves both faces of the middle one at the same arc.
    hung = hung[np.diff(arc[hung], prepend=-math.inf) > NEAREST * rolled.pace]
    cells, arc, place, depth = cells[hung], arc[hung], lips[lip[hung]], depth[lip[hung]]
    return _ending_at(path, rolled, cells, arc, Held(place, depth, rolled.ball.drop(depth, place - arc)))


def _cells_of(path: RolledPath, arc: Array) -> Index:
    """The cells (N,) of the path in which arcs (N,), rad, lie."""
    return np.searchsorted(path.arc, arc, side="right") - 1


def _ending_at(path: RolledPath, rolled: Rolled, cells: Index, arc: Array, held: Held) -> Branches:
    """The branches of the path, which also end at these arcs (N,), rad, in its `cells` (N,), where the ball is `held`
    so; at its nearest node instead if that is there already."""
    share = (arc - path.arc[cells]) / (path.arc[cells + 1] - path.arc[cells])
    new = (share > NEAREST) & (share < 1.0 - NEAREST)
    ends = np.where(new, arc, path.arc[cells + np.rint(share).astype(np.int64)])
    found = branches(_with_nodes(path, rolled, cells[new], arc[new], Held(*(of[new] for of in held))))
    edges = np.unique(np.concatenate([found.edges, ends]))
    apart = np.diff(edges, prepend=-math.inf) > NEAREST * rolled.pace
    apart[-1] = True
    return found._replace(edges=edges[apart])


def _with_hollows(rolled: Rolled) -> RolledPath:
    """The path with more nodes where the place of contact runs ahead of the ball, in hollows nearly as bent as it is.

    Halved again and again, their cells tell this from a leap to another place, which remains one.
    """
    path = rolled.path
    for _ in range(HOLLOW_HALVINGS):
        cells = np.flatnonzero(np.abs(np.diff(path.contact)) > LEAP)
        arc = 0.5 * (path.arc[cells] + path.arc[cells + 1])
        path = _with_nodes(path, rolled, cells, arc, _held_between(path, rolled, cells, arc))
    return path


def _with_narrow_bumps(rolled: Rolled, path: RolledPath) -> RolledPath:
    """The `path` with one more node for every bump that holds the ball over less than a step, so between two nodes.

    Such a bump lies between both that meet in a corner, and holds the ball there higher than they do.
    """
    known = np.zeros(path.arc.size - 1, dtype=np.bool_)
    for _ in range(MOST_ROUNDS):
        cells, arc, drop = corners_of(path).between_nodes(path)
        new = ~known[cells]
        cells, arc, drop = cells[new], arc[new], drop[new]
        held = _held_between(path, rolled, cells, arc)
        contact = (held.place - path.arc[0]) / rolled.pace
        # Where both leaps that it leaves are too short to be corners, the one corner is nearer to the truth.
        leap = np.maximum(contact - path.contact[cells], path.contact[cells + 1] - contact)
        narrow = (held.drop < drop - HIGHER) & (leap > LEAP)
        known[cells] = ~narrow
        if not narrow.any():
            break
        known = np.insert(known, cells[narrow] + 1, False)
        path = _with_nodes(path, rolled, cells[narrow], arc[narrow], Held(*(of[narrow] for of in held)))
    return path


def _with_nodes(path: RolledPath, rolled: Rolled, cells: Index, arc: Array, held: Held) -> RolledPath:
    """The path with nodes in these `cells` (N,), at the arcs (N,), rad, where the ball is `held` so."""
    contact = (held.place - path.arc[0]) / rolled.pace
    added = (arc, held.drop, rolled.ball.slope(held.depth, held.place - arc), contact)
    return RolledPath(*(np.insert(old, cells + 1, more) for old, more in zip(path, added, strict=True)))


def _held_between(path: RolledPath, rolled: Rolled, cells: Index, arc: Array) -> Held:
    """The ball at arcs (N,), rad, between the nodes of these `cells` (N,) of the path: by what lies between the places
    at which it touches there."""
    _, ball, surface, points, depth = rolled
    fine = points[1] - points[0]
    touched = path.arc[0] + path.contact * rolled.pace
    first, last = (np.rint((touched[cells + k] - points[0]) / fine).astype(np.int64) for k in (0, 1))
    highest = _highest_between(ball, depth, first, last, arc - points[0], fine)
    return between_points(surface, ball, arc, points[highest], fine)


@njit
def _highest_between(ball: Ball, depth: Array, first: Index, last: Index, arc: Array, step: float) -> Index:
    """The points (N,) of the surface, from `first` to `last` (N,) each, that hold the `ball` at the arcs (N,), rad,
    from point 0 highest."""
    highest = first.copy()
    for k in range(arc.size):
        least = math.inf
        for point in range(first[k], last[k] + 1):
            away = abs(step * point - arc[k])
            found = drop_on(ball, depth[point], math.cos(away), math.sin(away))
            if found < least:
                least, highest[k] = found, point
    return highest
