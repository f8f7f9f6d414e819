"""The path of the ball's centre over a spall, as cubic pieces between the spall's edges."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache, partial
from itertools import pairwise

import numpy as np

from physics.arrays import Array, Index
from physics.bearing import Bearing
from physics.imperfections import Waviness
from physics.paths.corners import Branches
from physics.paths.depth_path import Curve, DepthPath, hermite_path
from physics.paths.held_ball import ball_of
from physics.paths.path_nodes import bumpy_branches, gap_branches, table_branches
from physics.paths.rolling import FEWEST_STEPS, roll
from physics.paths.spall_surface import (
    floor_ends,
    gap_surface,
    reaches_floor,
    table_arcs,
    table_surface,
    turning_points,
)
from physics.scene import Scene
from physics.spall import Spall

# So a taper is met to 2.4e-8 of its depth, and its slope to 3.6e-6 of the depth over the taper.
CELLS_PER_TAPER = 48
CELLS_PER_ROUGHNESS_STEP = 4
# Largest error (m) of a rough path between the nodes of its cells, which are halved at most so many times for it. Drawn
# roughness, which is smooth from step to step, is met at once: of 330 such paths the worst is 1.0e-10 m off.
ROUGH_ERROR, MOST_HALVINGS = 1.5e-10, 4
# Steps of a rolled path (m), how many of them make a cell, and the most over one spall: beyond 0.2 m they are longer.
# In rough spalls of 0.6 to 1.9 m this moved paths by 0.07 to 0.5 nm (RMS), and by up to 0.2 µm at single corners.
ROLLED_STEP, CELL_STEPS, MOST_STEPS = 2e-6, 2, 100_000
# A measured table is rough if it turns from falling to rising or back more often than this.
MOST_TURNS = 8
# A record asks for the path of each of its spalls about eight times.
PATHS_KEPT = 64


@lru_cache(maxsize=PATHS_KEPT)
def build_path(spall: Spall, bearing: Bearing, fineness: int = 1) -> DepthPath:
    """The path of the ball's centre over `spall`: a Tukey window, a deep gap in closed form, or a rolled surface;
    in cells a `fineness` times as many as usual.

    The same spall and bearing give the same object, wherever on the race the spall is, so its arrays are for reading
    only.
    """
    return _path_of_shape(replace(spall, angle=0.0, row=1), bearing, fineness)


@lru_cache(maxsize=PATHS_KEPT)  # a lead-in turns spalls of the inner race, and their paths stay
def _path_of_shape(spall: Spall, bearing: Bearing, fineness: int) -> DepthPath:
    if spall.rolled_arc > 0.0:
        return _rolled_path(spall, bearing, fineness)
    return _tukey_path(spall, fineness) if spall.profile == "tukey" else _gap_path(spall, bearing, fineness)


def is_rough(spall: Spall, bearing: Bearing) -> bool:
    """Whether `spall` goes up and down all along: it has roughness, or a table that turns more often than a few pits
    and lips do."""
    return build_path(spall, bearing).rough


def race_depth(scene: Scene, row: int, angle: Array) -> Array:
    """Path of the ball's centre on the defective race (N,), m, at angles (N,) fixed to it and equal to φ at t = 0.

    Spalls and the waviness of that race, on `row` (1 or 2).
    """
    total = np.zeros(np.shape(angle))
    for spall in scene.spalls:
        if spall.row == row:
            total += _spall_depth(spall, scene.rig.bearing, np.asarray(angle))
    for wave in _waves(scene):
        total += wave.amplitude * np.cos(wave.order * np.asarray(angle) + wave.phase)
    return total


def race_depths(scene: Scene, points: int) -> Array:
    """What `race_depth` tells of every row, (rows, points), at the angles −π + 2πk / `points`; ValueError if these are
    too few for the finest wave."""
    depths = np.tile(_waves_around(scene, points), (scene.rig.bearing.rows, 1))
    for spall in scene.spalls:
        near = _points_near(build_path(spall, scene.rig.bearing), spall.angle, points)
        angle = np.asarray(-math.pi + 2.0 * math.pi / points * near, dtype=np.float64)
        depths[spall.row - 1, near] += _spall_depth(spall, scene.rig.bearing, angle)
    return depths


def _waves_around(scene: Scene, points: int) -> Array:
    """The waviness of the path (points,), by one inverse Fourier transform."""
    waves = _waves(scene)
    if not waves:
        return np.zeros(points)
    spectrum = np.zeros(points // 2 + 1, dtype=np.complex128)
    for wave in waves:
        if 2 * wave.order >= points:
            raise ValueError(f"{points} points are too few for {wave.order} waves a turn")
        spectrum[wave.order] += 0.5 * points * wave.amplitude * np.exp(1j * (wave.phase - wave.order * math.pi))
    return np.fft.irfft(spectrum, points)


def _spall_depth(spall: Spall, bearing: Bearing, angle: Array) -> Array:
    return build_path(spall, bearing).depth(spall.travel_sign * wrap(angle - spall.angle))


def _points_near(path: DepthPath, angle: float, points: int) -> Index:
    """The numbers of all points around a race that a path with its middle at `angle` can reach."""
    pace = points / (2.0 * math.pi)
    reach = math.ceil(pace * np.max(np.abs(path.breaks))) + 1
    return (round((angle + math.pi) * pace) + np.arange(-reach, reach + 1)) % points


def _waves(scene: Scene) -> list[Waviness]:
    """The waviness that belongs to the path: that of the defective race."""
    return [wave for wave in scene.imperfections.waviness if wave.race == scene.defective_race]


def wrap(angle: Array) -> Array:
    """Angles brought into [−π, π), rad."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def _tukey_path(spall: Spall, fineness: int) -> DepthPath:
    half, surface = spall.extent / 2.0, gap_surface(spall)
    rough = bool(spall.roughness_values)
    edges = _distinct([-half, -half + spall.entry_taper, half - spall.exit_taper, half])
    cell = spall.extent / (len(spall.roughness_values) - 1) / CELLS_PER_ROUGHNESS_STEP if rough else math.inf
    cells = []
    for left, right in pairwise(edges):
        flat = left >= -half + spall.entry_taper and right <= half - spall.exit_taper
        cells.append(fineness * max(1 if flat else CELLS_PER_TAPER, math.ceil((right - left) / cell)))

    def of_cells(halvings: int) -> DepthPath:
        finer = [count << halvings for count in cells]
        return hermite_path(
            np.array(edges), finer, surface, partial(surface, order=1), bridged=False, bumps=rough, rough=rough
        )

    halvings, path = 0, of_cells(0)
    while rough and halvings < MOST_HALVINGS and _error_between_nodes(path, surface) > ROUGH_ERROR:
        halvings += 1
        path = of_cells(halvings)
    return path


def _error_between_nodes(path: DepthPath, depth: Curve) -> float:
    """How far (m) the `path` is off the curve `depth` (m) at the quarters of its cells, at most."""
    quarters = np.array([0.25, 0.5, 0.75])
    width = np.repeat(np.diff(path.breaks) / path.cells, path.cells)
    left = path.breaks[np.repeat(np.arange(path.cells.size), path.cells)]
    within = np.concatenate([np.arange(count) for count in path.cells])
    arcs = (left + within * width + quarters[:, None] * width).reshape(-1)
    return float(np.abs(path.depth(arcs) - depth(arcs)).max())


def _gap_path(spall: Spall, bearing: Bearing, fineness: int) -> DepthPath:
    """A gap with sharp edges in closed form: the ball hangs on the nearer edge until it reaches the floor."""
    half, ball = spall.extent / 2.0, ball_of(bearing, spall.race)
    bridged = bool(half < ball.half_arc and ball.drop_from_edge(np.array(half)) < spall.depth)
    reach = half if bridged else min(half, ball.reach_from_edge(spall.depth))
    edges = np.array(_distinct([-half, -half + reach, half - reach, half]))
    on_floor = np.abs(edges[1:] + edges[:-1]) / 2.0 < half - reach
    cells = [1 if flat else CELLS_PER_TAPER * fineness for flat in on_floor]

    def nearer_edge(arc: Array) -> Array:
        return np.clip(half - np.abs(arc), 0.0, reach)

    def depth(arc: Array) -> Array:
        return ball.drop_from_edge(nearer_edge(arc))

    def slope(arc: Array) -> Array:
        hanging = half - np.abs(arc) < reach * (1.0 - 1e-12)
        return np.where(hanging, -np.sign(arc) * ball.slope_from_edge(nearer_edge(arc)), 0.0)

    return hermite_path(edges, cells, depth, slope, bridged=bridged, bumps=False, rough=False)


def _rolled_path(spall: Spall, bearing: Bearing, fineness: int) -> DepthPath:
    measured, lips = spall.profile == "table", table_arcs(spall)
    surface = table_surface(spall) if measured else gap_surface(spall)
    ball = ball_of(bearing, spall.race)
    rough = bool(spall.roughness_values) or turning_points(np.array(spall.table_depth)) > MOST_TURNS
    # The race ends where the table does, which may be within the spall: a ball can hang there.
    first, last = (lips[0], lips[-1]) if measured else (-spall.extent / 2.0, spall.extent / 2.0)
    step = max(ROLLED_STEP / ball.race_radius, (last - first) / MOST_STEPS)
    rolled = roll(surface, (first, last), ball, min(step, (last - first) / FEWEST_STEPS) / fineness, lips)
    path = rolled.path
    if rough:
        smooth = bumpy_branches(rolled)
    elif measured:
        smooth = table_branches(rolled, lips, surface(lips))
    else:
        smooth = gap_branches(rolled, floor_ends(spall))
    width = CELL_STEPS * (path.arc[-1] - path.arc[0]) / (path.arc.size - 1)
    # Rounding must not make a cell of what is left of a whole number of them.
    cells = np.maximum(1, np.ceil(np.diff(smooth.edges) / width - 1e-6)).astype(np.int64)
    return hermite_path(
        smooth.edges,
        cells.tolist(),
        lambda arc: _on_branches(smooth, arc)[0],
        lambda arc: _on_branches(smooth, arc)[1],
        bridged=not reaches_floor(spall, path.arc, surface(path.arc) - path.drop),
        # One lip is enough for a free ball to touch it within a step.
        bumps=rough or measured,
        rough=rough,
        spall=(-spall.extent / 2.0, spall.extent / 2.0),
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


def _distinct(edges: list[float]) -> list[float]:
    smallest = 1e-9 * (edges[-1] - edges[0])
    kept = [edges[0]]
    for edge in edges[1:-1]:
        if edge - kept[-1] > smallest and edges[-1] - edge > smallest:
            kept.append(edge)
    return [*kept, edges[-1]]
