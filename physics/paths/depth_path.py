"""A path as cubic pieces between edges: how deep the ball's centre lies against the arc."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from physics._jit import njit, njit_inline, njit_lean
from physics.arrays import Array, Index

Curve = Callable[[Array], Array]

RELIEF_LEVELS = 8
# Places of a path less than this (m) above its deepest are as deep: what is rolled over a floor is off by rounding.
LEVEL = 1e-12
# Slots of a path for each of its breaks.
SLOTS = 2
# Columns of `Paths.places` and of `Paths.pieces`.
FIRST, PIECES, PACE = range(3)
BREAK, DENSITY, CELLS, FIRST_CUBIC = range(4)


@dataclass(frozen=True)
class DepthPath:
    """Radial drop of the ball's centre against u, the arc from the spall's centre in the direction of travel (rad).

    Between neighbouring `breaks` (P + 1,) the path is smooth: `cells` (P,) equal cells, each a cubic in the position
    within the cell (0 to 1), coefficients `cubics` (sum of cells, 4) from the cube down, m. Zero outside.

    `deepest` (rad): the arc at which the drop is largest, the middle of a flat floor, of several the widest or else the
    first; `largest_depth` (m): the drop there, or 0 where a spall stands proud of the race throughout, whose deepest
    place is the lowest within its edges; `bridged`: the ball rests on both edges before it reaches the floor;
    `rough`: it goes up and down all along. `relief` (8,), m: how far a bump can stand out of the chord over 1, 2, 4 …
    mean cells; zero where there is none.
    """

    breaks: Array
    cells: Index
    cubics: Array
    deepest: float
    largest_depth: float
    bridged: bool
    rough: bool
    relief: Array

    @property
    def cell(self) -> float:
        """Mean width of the cells, rad."""
        return float((self.breaks[-1] - self.breaks[0]) / self.cells.sum())

    @cached_property
    def alone(self) -> Paths:
        """The path as kernels read it."""
        return paths_of([self])

    def depth(self, arc: Array) -> Array:
        """Drop (N,) at the arcs (N,), m."""
        return sample_path(self.alone, np.asarray(arc, dtype=np.float64))[0]

    def slope(self, arc: Array) -> Array:
        """Derivative (N,) of the drop at the arcs (N,), m/rad."""
        return sample_path(self.alone, np.asarray(arc, dtype=np.float64))[1]


class Paths(NamedTuple):
    """Paths stored end to end, in as few arrays as kernels can do with.

    `places` (N, 3): the row of `pieces` in which each path begins, its number of pieces, and its slots a radian.
    `pieces` (P + N, 4): where each piece begins (rad), its cells a radian, its number of cells, and the row of `cubics`
    (C, 4) in which they begin; behind the pieces of a path one more row, for its last break. From its first break to
    its last a path is also divided into equal slots, SLOTS a row: `slots` are the pieces in which they begin, counted
    from the path's first, so that a piece is found in few steps however many there are.
    """

    places: Array
    pieces: Array
    slots: Index
    cubics: Array


def paths_of(paths: Sequence[DepthPath]) -> Paths:
    """The `paths` end to end."""
    places, pieces, slots = np.zeros((len(paths), 3)), [np.zeros((0, 4))], [np.zeros(0, dtype=np.int64)]
    cubics, row, cubic = [np.zeros((0, 4))], 0, 0
    for place, path in zip(places, paths, strict=True):
        count, rows = path.cells.size, path.breaks.size
        piece = np.zeros((rows, 4))
        piece[:, BREAK] = path.breaks
        piece[:count, DENSITY], piece[:count, CELLS] = path.cells / np.diff(path.breaks), path.cells
        piece[:count, FIRST_CUBIC] = cubic + np.cumsum(path.cells) - path.cells
        begin = np.linspace(path.breaks[0], path.breaks[-1], SLOTS * rows, endpoint=False)
        place[:] = row, count, SLOTS * rows / (path.breaks[-1] - path.breaks[0])
        pieces.append(piece)
        slots.append(np.searchsorted(path.breaks[1:-1], begin))
        cubics.append(path.cubics)
        row += rows
        cubic += path.cubics.shape[0]
    return Paths(places, np.concatenate(pieces), np.concatenate(slots), np.concatenate(cubics))


@njit_lean
def span_of(paths: Paths, path: int) -> tuple[int, int]:
    """The rows of `pieces` with the first break of one of the paths, and behind its last."""
    first = int(paths.places[path, FIRST])
    return first, first + int(paths.places[path, PIECES]) + 1


@njit_inline
def path_at(paths: Paths, path: int, arc: float) -> tuple[float, float]:
    """Drop (m) and slope (m/rad) at `arc` of one of the paths, between its first and its last break."""
    first, pieces = int(paths.places[path, FIRST]), int(paths.places[path, PIECES])
    slot = int((arc - paths.pieces[first, BREAK]) * paths.places[path, PACE])
    piece = first + paths.slots[SLOTS * first + min(max(slot, 0), SLOTS * pieces + SLOTS - 1)]
    while piece < first + pieces - 1 and arc > paths.pieces[piece + 1, BREAK]:
        piece += 1
    density = paths.pieces[piece, DENSITY]
    position = (arc - paths.pieces[piece, BREAK]) * density
    inside = min(max(int(position), 0), int(paths.pieces[piece, CELLS]) - 1)
    x = position - inside
    cubic = int(paths.pieces[piece, FIRST_CUBIC]) + inside
    c3, c2, c1 = paths.cubics[cubic, 0], paths.cubics[cubic, 1], paths.cubics[cubic, 2]
    return ((c3 * x + c2) * x + c1) * x + paths.cubics[cubic, 3], ((3.0 * c3 * x + 2.0 * c2) * x + c1) * density


@njit
def sample_path(paths: Paths, arcs: Array) -> tuple[Array, Array]:
    """Drop and slope, (N,) each, of the only one of `paths` at the arcs (N,); zero outside its breaks."""
    depth = np.zeros(arcs.size)
    slope = np.zeros(arcs.size)
    for k in range(arcs.size):
        if paths.pieces[0, BREAK] <= arcs[k] <= paths.pieces[-1, BREAK]:
            depth[k], slope[k] = path_at(paths, 0, arcs[k])
    return depth, slope


def hermite_cubics(value: Array, rate: Array) -> Array:
    """Cubics (N, 4), from the cube down, over N cells with these values and slopes per cell at their nodes (N + 1,)."""
    rise, cubics = np.diff(value), np.empty((value.size - 1, 4))
    cubics[:, 0] = rate[:-1] + rate[1:] - 2.0 * rise
    cubics[:, 1] = 3.0 * rise - 2.0 * rate[:-1] - rate[1:]
    cubics[:, 2], cubics[:, 3] = rate[:-1], value[:-1]
    return cubics


def hermite_path(
    edges: Array,
    cells: list[int],
    depth: Curve,
    slope: Curve,
    *,
    bridged: bool,
    bumps: bool,
    rough: bool,
    spall: tuple[float, float] | None = None,
) -> DepthPath:
    """The path of the curve `depth` (m) with its `slope` (m/rad) over `edges` (P + 1,), `cells` a piece.

    Cubic Hermite cells with the curve's values and one-sided slopes at the nodes. Its relief is known if there may be
    `bumps`. The edges of the `spall` (rad) are needed if the path reaches beyond them.
    """
    count = np.array(cells, dtype=np.int64)
    first = np.cumsum(count + 1) - (count + 1)
    piece = np.repeat(np.arange(count.size), count + 1)
    width = np.diff(edges) / count
    arcs = edges[piece] + (np.arange(piece.size) - first[piece]) * width[piece]
    arcs[first + count] = edges[1:]
    # Slopes are read just inside the piece so that at a kink each side gets its own.
    inner = np.clip(arcs, (edges[:-1] + 1e-9 * width)[piece], (edges[1:] - 1e-9 * width)[piece])
    values, rates = depth(inner), slope(inner) * width[piece]
    cubics = np.delete(hermite_cubics(values, rates), (first + count)[:-1], axis=0)
    deepest, largest = _deepest(arcs, values, np.delete(arcs, first + count), np.repeat(width, count), cubics)
    if spall is not None and not spall[0] <= deepest <= spall[1]:
        deepest = _lowest_within(spall, depth)
    path = DepthPath(
        breaks=np.asarray(edges, dtype=np.float64),
        cells=count,
        cubics=cubics,
        deepest=deepest,
        largest_depth=largest,
        bridged=bridged,
        rough=rough,
        relief=np.zeros(RELIEF_LEVELS),
    )
    return replace(path, relief=_relief(path)) if bumps else path


def _deepest(nodes: Array, values: Array, left: Array, width: Array, cubics: Array) -> tuple[float, float]:
    """Arc (rad) and size (m) of the largest drop, the middle of a floor as deep.

    Of the `values` (M,) at `nodes` (M,), or inside one of the `cubics` (N, 4) over cells from `left` (N,), `width` (N,)
    wide.
    """
    cube, square, linear = cubics[:, 0], cubics[:, 1], cubics[:, 2]
    turning = np.flatnonzero((linear > 0.0) & (3.0 * cube + 2.0 * square + linear < 0.0))
    c3, c2, c1 = cube[turning], square[turning], linear[turning]
    x = c1 / (np.sqrt(c2**2 - 3.0 * c3 * c1) - c2)
    inside = ((c3 * x + c2) * x + c1) * x + cubics[turning, 3]
    largest = max(float(values.max()), float(inside.max(initial=-math.inf)))
    arcs = np.concatenate([nodes, left[turning] + x * width[turning]])
    order = np.argsort(arcs, kind="stable")
    deep = np.concatenate([values, inside])[order] >= largest - max(0.0, min(LEVEL, 1e-3 * largest))
    turns = np.flatnonzero(np.diff(deep, prepend=False, append=False))
    begin, end = arcs[order[turns[0::2]]], arcs[order[turns[1::2] - 1]]
    widest = int(np.argmax(end - begin))
    return float(0.5 * (begin[widest] + end[widest])), max(largest, 0.0)


def _lowest_within(spall: tuple[float, float], depth: Curve) -> float:
    """Arc (rad) of the largest drop between the edges of a `spall`, to a thousandth of their distance."""
    arc = np.linspace(*spall, 1001)
    return float(arc[np.argmax(depth(arc))])


def _relief(path: DepthPath) -> Array:
    """How far (m) the path strays from its chord over 1, 2, 4 … mean cells at most; the last one over any length.

    Over twice as many cells it is what it is over half of them, and what the middle strays.
    """
    half_cells = 2 * math.ceil((path.breaks[-1] - path.breaks[0]) / path.cell)
    depth = path.depth(np.linspace(path.breaks[0], path.breaks[-1], half_cells + 1))
    strayed = np.zeros(RELIEF_LEVELS)
    for level in range(RELIEF_LEVELS - 1):
        reach = 1 << level
        if depth.size > 2 * reach:
            middle = depth[reach:-reach] - 0.5 * (depth[: -2 * reach] + depth[2 * reach :])
            strayed[level] = np.max(np.abs(middle))
    relief = np.minimum(np.cumsum(strayed), np.ptp(depth))
    relief[-1] = np.ptp(depth)
    return relief
