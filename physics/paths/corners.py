"""Corners of a rolled path, at which the ball changes from one bump to another, and the smooth branches between."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics.arrays import Array, Index

# Where the contact point leaps by more than this many steps of the path the ball has changed from one bump to another.
LEAP = 3.0
# Both sides of a corner are nearly parabolas; one nearer to a node than this share of a cell is put onto it.
NEWTON_STEPS, NEAREST = 4, 1e-3


class RolledPath(NamedTuple):
    """`drop` (N,), m, of the ball's centre and its `slope` (N,), m/rad, at the arcs `arc` (N,), rad, and the `contact`
    (N,) that holds the ball there, in steps of the path."""

    arc: Array
    drop: Array
    slope: Array
    contact: Array


class Branches(NamedTuple):
    """A rolled path as smooth branches: nodes `arc`, `drop`, `slope` (N,) as above, with two nodes at every corner.

    `edges` (B + 1,), rad, are both ends and the corners.
    """

    arc: Array
    drop: Array
    slope: Array
    edges: Array


class Corners(NamedTuple):
    """Corners of a rolled path: the `cells` (C,) in which they lie, each from the node of that number to the next; at
    which `share` (C,) of the cell; and the bends `left_bend`, `right_bend` (C,), m/rad², of the parabolas that meet."""

    cells: Index
    share: Array
    left_bend: Array
    right_bend: Array

    def between_nodes(self, path: RolledPath) -> tuple[Index, Array, Array]:
        """Of corners that do not lie on a node: their cells, their arcs (rad) and the drops (m) there."""
        free = (self.share >= NEAREST) & (self.share <= 1.0 - NEAREST)
        cells, bend = self.cells[free], self.left_bend[free]
        x = self.share[free] * (path.arc[cells + 1] - path.arc[cells])
        return cells, path.arc[cells] + x, path.drop[cells] + x * (path.slope[cells] + 0.5 * x * bend)


def corners_of(path: RolledPath) -> Corners:
    """The corners of the path: where the parabolas of both sides, each from its own slope and curvature, meet."""
    arc, drop, slope, contact = path
    width = np.diff(arc)
    leaps = np.abs(np.diff(contact)) > LEAP
    cells = np.flatnonzero(leaps)
    step, bend = width[cells], np.diff(slope) / width
    before, after = np.maximum(cells - 1, 0), np.minimum(cells + 1, arc.size - 2)
    left_bend, right_bend = np.where(leaps[before], 0.0, bend[before]), np.where(leaps[after], 0.0, bend[after])
    share = np.full(cells.size, 0.5)
    for _ in range(NEWTON_STEPS):
        x, y = share * step, (share - 1.0) * step
        left = drop[cells] + x * (slope[cells] + 0.5 * x * left_bend)
        right = drop[cells + 1] + y * (slope[cells + 1] + 0.5 * y * right_bend)
        turn = slope[cells + 1] + y * right_bend - slope[cells] - x * left_bend
        share = np.clip(share + (left - right) / np.where(turn < 0.0, turn, -math.inf) / step, 0.0, 1.0)
    # The higher branch holds the ball: a corner turns the path upwards, and what does not is none.
    real = turn < 0.0
    return Corners(cells[real], share[real], left_bend[real], right_bend[real])


def branches(path: RolledPath) -> Branches:
    """The smooth branches between the corners at which the ball changes from one bump to another."""
    arc, drop, slope, _ = path
    cells, share, left_bend, right_bend = corners_of(path)
    step = arc[cells + 1] - arc[cells]
    on_left, on_right = share < NEAREST, share > 1.0 - NEAREST
    share = np.where(on_left, 0.0, np.where(on_right, 1.0, share))
    x, y = share * step, (share - 1.0) * step
    corner = np.where(on_right, drop[cells + 1], drop[cells] + x * (slope[cells] + 0.5 * x * left_bend))
    edges = np.where(on_right, arc[cells + 1], arc[cells] + x)
    # Two nodes a corner, one of them there already where the corner lies on a node.
    new = np.column_stack([~on_left, ~on_right]).ravel()
    places = np.repeat(cells + 1, 2)[new]
    both = np.column_stack([slope[cells] + x * left_bend, slope[cells + 1] + y * right_bend]).ravel()
    return Branches(
        np.insert(arc, places, np.repeat(edges, 2)[new]),
        np.insert(drop, places, np.repeat(corner, 2)[new]),
        np.insert(slope, places, both[new]),
        np.unique(np.concatenate([arc[:1], edges, arc[-1:]])),
    )
