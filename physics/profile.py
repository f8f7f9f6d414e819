"""The path of the ball's centre over a spall, as cubic pieces between the spall's edges."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from physics._jit import njit, njit_lean
from physics.bearing import Bearing
from physics.rolling import Branches, branches, deep_gap_drop, hanging_reach, rolled_path
from physics.scene import Scene
from physics.spall import Spall

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]

CELLS_PER_TAPER = 48
CELLS_PER_ROUGHNESS_STEP = 4
# Steps of a rolled path (m), and how many of them make a cell.
ROLLED_STEP, CELL_STEPS = 2e-6, 2
TOUCHING_SHARE = 0.02
# A record asks for the path of each of its spalls about eight times.
PATHS_KEPT = 64
RELIEF_LEVELS = 8


@dataclass(frozen=True)
class DepthPath:
    """Radial drop of the ball's centre against u, the arc from the spall's centre in the direction of travel (rad).

    Between neighbouring `breaks` (P + 1,) the path is smooth: `cells` (P,) equal cells, each a cubic in the position
    within the cell (0 to 1), coefficients `cubics` (sum of cells, 4) from the cube down, m. Zero outside.

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


@lru_cache(maxsize=PATHS_KEPT)
def build_path(spall: Spall, bearing: Bearing) -> DepthPath:
    """The path of the ball's centre over `spall`: a Tukey window, a deep gap in closed form, or a rolled surface.

    The same spall and bearing give the same object, so its arrays are for reading only.
    """
    if spall.profile == "tukey":
        return _tukey_path(spall)
    smooth_gap = spall.entry_taper == 0.0 and spall.exit_taper == 0.0 and not spall.roughness_values
    if spall.profile == "ball_path" and smooth_gap:
        return _gap_path(spall, bearing)
    return _rolled_path(spall, bearing)


def race_depth(scene: Scene, row: int, angle: Array) -> Array:
    """Path of the ball's centre on the defective race (N,), m, at angles (N,) fixed to it and equal to φ at t = 0.

    Spalls and the waviness of that race, on `row` (1 or 2).
    """
    total = np.zeros(np.shape(angle))
    for spall in scene.spalls:
        if spall.row == row:
            arc = spall.travel_sign * wrap(np.asarray(angle) - spall.angle)
            total += build_path(spall, scene.rig.bearing).depth(arc)
    for wave in scene.imperfections.waviness:
        if wave.race == scene.defective_race:
            total += wave.amplitude * np.cos(wave.order * np.asarray(angle) + wave.phase)
    return total


def wrap(angle: Array) -> Array:
    """Angles brought into [−π, π), rad."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def window(spall: Spall, arc: Array) -> Array:
    """Tukey window (N,) of unit height with the spall's tapers at the arcs (N,) [P14 Eq. 17, first part]."""
    half = spall.extent / 2.0
    rise = _ramp(arc + half, spall.entry_taper)
    fall = _ramp(half - arc, spall.exit_taper)
    return np.minimum(rise, fall) * (np.abs(arc) <= half * (1.0 + 1e-12))


def _ramp(distance: Array, taper: float) -> Array:
    if taper == 0.0:
        return np.ones_like(distance)
    return 0.5 - 0.5 * np.cos(np.pi * np.clip(distance / taper, 0.0, 1.0))


def _window_slope(spall: Spall, arc: Array) -> Array:
    half = spall.extent / 2.0
    return _ramp_slope(arc + half, spall.entry_taper) - _ramp_slope(half - arc, spall.exit_taper)


def _ramp_slope(distance: Array, taper: float) -> Array:
    if taper == 0.0:
        return np.zeros_like(distance)
    inside = (distance >= 0.0) & (distance <= taper)
    return np.where(inside, 0.5 * np.pi / taper * np.sin(np.pi * np.clip(distance / taper, 0.0, 1.0)), 0.0)


def roughness_curve(spall: Spall) -> CubicSpline | None:
    """Natural cubic spline through the spall's roughness values (m) over the arc (rad), or None if it is smooth."""
    if not spall.roughness_values:
        return None
    half = spall.extent / 2.0
    arcs = np.linspace(-half, half, len(spall.roughness_values))
    return CubicSpline(arcs, np.array(spall.roughness_values), bc_type="natural")


def _tukey_path(spall: Spall) -> DepthPath:
    half = spall.extent / 2.0
    rough = roughness_curve(spall)
    edges = _distinct([-half, -half + spall.entry_taper, half - spall.exit_taper, half])
    cell = math.inf if rough is None else spall.extent / (len(spall.roughness_values) - 1) / CELLS_PER_ROUGHNESS_STEP
    cells = []
    for left, right in pairwise(edges):
        flat = left >= -half + spall.entry_taper and right <= half - spall.exit_taper
        cells.append(max(1 if flat else CELLS_PER_TAPER, math.ceil((right - left) / cell)))

    def depth(arc: Array) -> Array:
        return spall.depth * window(spall, arc) + (0.0 if rough is None else rough(arc))

    def slope(arc: Array) -> Array:
        return spall.depth * _window_slope(spall, arc) + (0.0 if rough is None else rough(arc, 1))

    return _hermite_pieces(np.array(edges), cells, depth, slope, bridged=False, rough=rough is not None)


def _gap_path(spall: Spall, bearing: Bearing) -> DepthPath:
    """A gap with sharp edges in closed form: the ball hangs on the nearer edge until it reaches the floor."""
    half = spall.extent / 2.0
    race_radius, ball_radius = bearing.raceway_radius(spall.race), bearing.ball_radius
    drop, drop_slope = deep_gap_drop(spall.race, race_radius, ball_radius)
    bridged = bool(half < math.asin(min(1.0, ball_radius / race_radius)) and drop(np.array(half)) < spall.depth)
    reach = half if bridged else min(half, hanging_reach(spall.race, race_radius, ball_radius, spall.depth))
    edges = np.array(_distinct([-half, -half + reach, half - reach, half]))
    on_floor = np.abs(edges[1:] + edges[:-1]) / 2.0 < half - reach
    cells = [1 if flat else CELLS_PER_TAPER for flat in on_floor]

    def nearer_edge(arc: Array) -> Array:
        return np.clip(half - np.abs(arc), 0.0, reach)

    def depth(arc: Array) -> Array:
        return drop(nearer_edge(arc))

    def slope(arc: Array) -> Array:
        hanging = half - np.abs(arc) < reach * (1.0 + 1e-12)
        return np.where(hanging, -np.sign(arc) * drop_slope(nearer_edge(arc)), 0.0)

    return _hermite_pieces(edges, cells, depth, slope, bridged=bridged, rough=False)


def _rolled_path(spall: Spall, bearing: Bearing) -> DepthPath:
    surface = _table_surface(spall) if spall.profile == "table" else _gap_surface(spall)
    race_radius, ball_radius = bearing.raceway_radius(spall.race), bearing.ball_radius
    rolled = rolled_path(surface, spall.extent / 2.0, spall.race, race_radius, ball_radius, ROLLED_STEP / race_radius)
    smooth = branches(rolled)
    width = CELL_STEPS * (rolled.arc[-1] - rolled.arc[0]) / (rolled.arc.size - 1)
    # Rounding must not make a cell of what is left of a whole number of them.
    cells = np.maximum(1, np.ceil(np.diff(smooth.edges) / width - 1e-6)).astype(np.int64)
    return _hermite_pieces(
        smooth.edges,
        cells.tolist(),
        lambda arc: _on_branches(smooth, arc)[0],
        lambda arc: _on_branches(smooth, arc)[1],
        bridged=not _reaches_floor(spall, rolled.arc, surface(rolled.arc) - rolled.drop),
        rough=bool(spall.roughness_values) or spall.profile == "table",
    )


def _on_branches(smooth: Branches, arc: Array) -> tuple[Array, Array]:
    """Drop (N,), m, and slope (N,), m/rad, at arcs (N,), rad, which must not be corners themselves."""
    k = np.clip(np.searchsorted(smooth.arc, arc, side="right") - 1, 0, smooth.arc.size - 2)
    width = smooth.arc[k + 1] - smooth.arc[k]
    x, rise = (arc - smooth.arc[k]) / width, smooth.drop[k + 1] - smooth.drop[k]
    first, last = width * smooth.slope[k] - rise, width * smooth.slope[k + 1] - rise
    value = smooth.drop[k] + x * (rise + (1.0 - x) * ((1.0 - x) * first - x * last))
    slope = rise + (1.0 - x) * (1.0 - 3.0 * x) * first - x * (2.0 - 3.0 * x) * last
    return value, slope / width


def _gap_surface(spall: Spall) -> Curve:
    rough = roughness_curve(spall)

    def surface(arc: Array) -> Array:
        inside = np.abs(arc) <= spall.extent / 2.0
        bumps = 0.0 if rough is None else np.where(inside, rough(arc), 0.0)
        return spall.depth * window(spall, arc) + bumps

    return surface


def _table_surface(spall: Spall) -> Curve:
    rising = slice(None, None, spall.travel_sign)
    angle = spall.travel_sign * np.array(spall.table_angle)[rising]
    depth = np.array(spall.table_depth)[rising]
    return lambda arc: np.interp(arc, angle, depth, left=0.0, right=0.0)


def _reaches_floor(spall: Spall, arcs: Array, gap: Array) -> bool:
    """Whether the `gap` (N,), m, below the ball closes on the floor: between the tapers, or deep in a table."""
    if spall.profile == "table":
        depth = max(spall.table_depth)
        floor = _table_surface(spall)(arcs) >= 0.5 * depth
    else:
        depth = spall.depth
        floor = window(spall, arcs) >= 1.0 - TOUCHING_SHARE
    return bool(np.any(gap[floor] <= TOUCHING_SHARE * max(depth, 1e-12)))


def hermite_cubics(value: Array, rate: Array) -> Array:
    """Cubics (N, 4), from the cube down, over N cells with these values and slopes per cell at their nodes (N + 1,)."""
    rise, cubics = np.diff(value), np.empty((value.size - 1, 4))
    cubics[:, 0] = rate[:-1] + rate[1:] - 2.0 * rise
    cubics[:, 1] = 3.0 * rise - 2.0 * rate[:-1] - rate[1:]
    cubics[:, 2], cubics[:, 3] = rate[:-1], value[:-1]
    return cubics


def _distinct(edges: list[float]) -> list[float]:
    smallest = 1e-9 * (edges[-1] - edges[0])
    kept = [edges[0]]
    for edge in edges[1:-1]:
        if edge - kept[-1] > smallest and edges[-1] - edge > smallest:
            kept.append(edge)
    return [*kept, edges[-1]]


def _hermite_pieces(
    edges: Array, cells: list[int], depth: Curve, slope: Curve, *, bridged: bool, rough: bool
) -> DepthPath:
    """Cubic Hermite cells with the curve's values and one-sided slopes at the nodes."""
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
    largest = float(values.max())
    floor = arcs[values >= largest - 1e-9 * max(largest, 1e-12)]
    path = DepthPath(
        breaks=np.asarray(edges, dtype=np.float64),
        cells=count,
        cubics=cubics,
        deepest=float(0.5 * (floor[0] + floor[-1])),
        largest_depth=largest,
        bridged=bridged,
        relief=np.zeros(RELIEF_LEVELS),
    )
    return replace(path, relief=_relief(path)) if rough else path


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
