"""A path as cubic pieces between edges: how deep the ball's centre lies against the arc."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit, njit_lean

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]

RELIEF_LEVELS = 8


@dataclass(frozen=True)
class DepthPath:
    """Radial drop of the ball's centre against u, the arc from the spall's centre in the direction of travel (rad).

    Between neighbouring `breaks` (P + 1,) the path is smooth: `cells` (P,) equal cells, each a cubic in the position
    within the cell (0 to 1), coefficients `cubics` (sum of cells, 4) from the cube down, m. Zero outside.

    `deepest` (rad): the arc at which the drop is largest, the middle of all if there are several; `largest_depth` (m):
    the drop there; `bridged`: the ball rests on both edges before it reaches the floor.
    `relief` (8,), m: how far a bump can stand out of the chord over 1, 2, 4 … mean cells; zero for smooth surfaces.
    """

    breaks: Array
    cells: NDArray[np.int64]
    cubics: Array
    deepest: float
    largest_depth: float
    bridged: bool
    relief: Array

    @property
    def cell(self) -> float:
        """Mean width of the cells, rad."""
        return float((self.breaks[-1] - self.breaks[0]) / self.cells.sum())

    @property
    def pieces(self) -> NDArray[np.int64]:
        """Number of cells, and of those before, of every piece (P, 2): what `path_at` reads."""
        return np.column_stack([self.cells, np.cumsum(self.cells) - self.cells])

    @property
    def kinks(self) -> Array:
        """Arcs at which the path is not smooth, rad."""
        return self.breaks

    def depth(self, arc: Array) -> Array:
        """Drop (N,) at the arcs (N,), m."""
        return sample_path(self.breaks, self.pieces, self.cubics, np.asarray(arc, dtype=np.float64))[0]

    def slope(self, arc: Array) -> Array:
        """Derivative (N,) of the drop at the arcs (N,), m/rad."""
        return sample_path(self.breaks, self.pieces, self.cubics, np.asarray(arc, dtype=np.float64))[1]


@njit_lean
def path_at(
    breaks: Array,
    cells: NDArray[np.int64],
    cubics: Array,
    first_break: int,
    first_piece: int,
    pieces: int,
    first_cubic: int,
    arc: float,
) -> tuple[float, float]:
    """Drop (m) and slope (m/rad) at `arc` of one path among several stored end to end.

    `cells` (P, 2): the `pieces` of every path.
    """
    piece, beyond = 0, pieces
    while beyond - piece > 1:
        middle = (piece + beyond) // 2
        if arc > breaks[first_break + middle]:
            piece = middle
        else:
            beyond = middle
    count = cells[first_piece + piece, 0]
    left = breaks[first_break + piece]
    width = (breaks[first_break + piece + 1] - left) / count
    position = (arc - left) / width
    inside = min(max(int(position), 0), count - 1)
    x = position - inside
    cubic = first_cubic + cells[first_piece + piece, 1] + inside
    c3, c2, c1 = cubics[cubic, 0], cubics[cubic, 1], cubics[cubic, 2]
    return ((c3 * x + c2) * x + c1) * x + cubics[cubic, 3], ((3.0 * c3 * x + 2.0 * c2) * x + c1) / width


@njit
def sample_path(breaks: Array, cells: NDArray[np.int64], cubics: Array, arcs: Array) -> tuple[Array, Array]:
    """Drop and slope, (N,) each, at the arcs (N,); zero outside the path's breaks."""
    depth = np.zeros(arcs.size)
    slope = np.zeros(arcs.size)
    for k in range(arcs.size):
        if breaks[0] <= arcs[k] <= breaks[-1]:
            depth[k], slope[k] = path_at(breaks, cells, cubics, 0, 0, cells.shape[0], 0, arcs[k])
    return depth, slope


def hermite_cubics(value: Array, rate: Array) -> Array:
    """Cubics (N, 4), from the cube down, over N cells with these values and slopes per cell at their nodes (N + 1,)."""
    rise, cubics = np.diff(value), np.empty((value.size - 1, 4))
    cubics[:, 0] = rate[:-1] + rate[1:] - 2.0 * rise
    cubics[:, 1] = 3.0 * rise - 2.0 * rate[:-1] - rate[1:]
    cubics[:, 2], cubics[:, 3] = rate[:-1], value[:-1]
    return cubics


def hermite_path(
    edges: Array, cells: list[int], depth: Curve, slope: Curve, *, bridged: bool, rough: bool
) -> DepthPath:
    """The path of the curve `depth` (m) with its `slope` (m/rad) over `edges` (P + 1,), `cells` a piece.

    Cubic Hermite cells with the curve's values and one-sided slopes at the nodes.
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
    path = DepthPath(
        breaks=np.asarray(edges, dtype=np.float64),
        cells=count,
        cubics=cubics,
        deepest=deepest,
        largest_depth=largest,
        bridged=bridged,
        relief=np.zeros(RELIEF_LEVELS),
    )
    return replace(path, relief=_relief(path)) if rough else path


def _deepest(nodes: Array, values: Array, left: Array, width: Array, cubics: Array) -> tuple[float, float]:
    """Arc (rad) and size (m) of the largest drop: of the `values` (M,) at `nodes` (M,), or inside one of the `cubics`
    (N, 4) over cells from `left` (N,), `width` (N,) wide."""
    cube, square, linear = cubics[:, 0], cubics[:, 1], cubics[:, 2]
    turning = np.flatnonzero((linear > 0.0) & (3.0 * cube + 2.0 * square + linear < 0.0))
    c3, c2, c1 = cube[turning], square[turning], linear[turning]
    x = c1 / (np.sqrt(c2**2 - 3.0 * c3 * c1) - c2)
    inside = ((c3 * x + c2) * x + c1) * x + cubics[turning, 3]
    largest = max(float(values.max()), float(inside.max(initial=-math.inf)))
    near = largest - 1e-9 * max(largest, 1e-12)
    floor = np.concatenate([nodes[values >= near], (left[turning] + x * width[turning])[inside >= near]])
    return float(0.5 * (floor.min() + floor.max())), largest


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
