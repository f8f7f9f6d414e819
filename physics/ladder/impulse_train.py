"""The impulse train: each edge of a spall takes a ball's static load off the outer ring, or gives it back.

The time of each edge comes from the cage's path, slip included; the load from the healthy load distribution where the
ball is; how long the ball takes to sink by what it was pressed together blunts the step; the linear modes of the rig
answer that swing, up to half the rate: what creeps back without swinging, as under a strong film, is left out. It is
what most generators of bearing signals do, with a size in newtons.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from physics._jit import njit_lean
from physics.arrays import Array, ComplexArray, Flags, Index
from physics.imperfections import Imperfections
from physics.ladder.model import Model
from physics.modes import coupled_matrix
from physics.paths.depth_path import DepthPath
from physics.paths.passages import passages
from physics.paths.profile import build_path
from physics.scene import Scene
from physics.spall import Spall
from physics.statics.load_distribution import instants_without_period, require_equilibrium
from physics.statics.stiffness import symmetric_matrices
from physics.trace import ACCELERATION_ALONE, ContactChanges, Kept, Trace


class Edges(NamedTuple):
    """Steps of force on the outer ring, E of them.

    `time` (s) is that of their middles; `row` and `ball` count from 1, `angle` is the ball's (rad). Its load changes by
    `change` (N) over the `ramp` (s); with `unloads` that is all of it, lost or taken again.
    """

    time: Array
    row: NDArray[np.int16]
    ball: NDArray[np.int16]
    angle: Array
    change: Array
    ramp: Array
    unloads: Flags


def _sound(scene: Scene) -> Scene:
    """The same machine without spalls and imperfections."""
    return replace(scene, spalls=(), imperfections=Imperfections())


def _mean_contacts(scene: Scene) -> tuple[Array, Array]:
    """Stiffness (2, 2) and film damping (2, 2) of the bearing without spalls, means over the record."""
    rest = require_equilibrium(_sound(scene), instants_without_period(scene.duration))
    return symmetric_matrices(rest.stiffness.mean(axis=0)), symmetric_matrices(rest.damping.mean(axis=0))


def _edges_of_spall(scene: Scene, index: int) -> list[Edges]:
    """The entry edge and the exit edge of every pass over one spall, under the load of each instant; also of those that
    began before the record or end behind it."""
    spall, bearing = scene.spalls[index], scene.rig.bearing
    path = build_path(spall, bearing)
    speed = scene.crossing_speed(spall)
    if speed == 0.0:  # a cage that turns with the race
        return []
    cos_alpha = math.cos(bearing.contact_angle)
    found = []
    for sign in (-1.0, 1.0):
        arcs, depths = _way_down(path, -sign)
        beside = (arcs[-1] - arcs[0] + spall.extent) / speed
        crossed = passages(scene, index, -sign * arcs[0], -beside, scene.duration + beside)
        angle = _ball_angle(scene, spall, crossed.ball, crossed.time)
        position = require_equilibrium(_sound(scene), crossed.time).displacement
        radial = position[:, 0] * np.cos(angle) + position[:, 1] * np.sin(angle) - bearing.clearance
        before, inside = np.maximum(radial, 0.0), np.maximum(radial - path.largest_depth, 0.0)
        lost = (before * cos_alpha) ** bearing.exponent - (inside * cos_alpha) ** bearing.exponent
        ramp = (np.interp(before - inside, depths, arcs) - arcs[0]) / speed
        found.append(
            Edges(
                crossed.time - sign * 0.5 * ramp,
                np.full(crossed.time.size, spall.row, np.int16),
                crossed.ball.astype(np.int16),
                angle,
                sign * bearing.load_deflection * lost,
                ramp,
                (before > 0.0) & (inside == 0.0),
            )
        )
    return found


def _way_down(path: DepthPath, sense: float) -> tuple[Array, Array]:
    """Arcs (N,), rad, from where the ball begins to sink to where it is deepest, and how deep it was by then (N,), m;
    with a `sense` of −1 against the direction of travel, from the other end."""
    pieces = zip(path.breaks[:-1], path.breaks[1:], path.cells, strict=True)
    arcs = np.concatenate([np.linspace(first, last, 2 * cells + 1) for first, last, cells in pieces])
    arcs = sense * arcs[:: int(sense)]
    depths = np.maximum.accumulate(np.maximum(path.depth(sense * arcs), 0.0))
    first, deepest = int((depths == 0.0).sum()), int(depths.argmax())
    way = slice(max(0, first - 1), max(deepest, first) + 1)
    return arcs[way], depths[way]


def _ball_angle(scene: Scene, spall: Spall, ball: Index, time: Array) -> Array:
    bearing = scene.rig.bearing
    turned = scene.cage_of(spall.row).angle(time)
    return np.asarray(turned + bearing.spacing * (ball - 1) + bearing.stagger * (spall.row - 1))


def edges_within(edges: Edges, duration: float) -> Edges:
    """Those of the steps of force whose middle lies within a record of this `duration` (s)."""
    within = (edges.time >= 0.0) & (edges.time < duration)
    return Edges._make(column[within] for column in edges)


def edges_around(scene: Scene) -> Edges:
    """The steps of force at all edges of all spalls of `scene`, in the order of time, also before the record and
    behind it."""
    parts = [part for index in range(len(scene.spalls)) for part in _edges_of_spall(scene, index)]
    none, number = np.zeros(0), np.zeros(0, np.int16)
    empty = Edges(none, number, number, none, none, none, np.zeros(0, np.bool_))
    columns = [np.concatenate(column) for column in zip(empty, *parts, strict=True)]
    order = np.argsort(columns[0], kind="stable")
    return Edges(*(column[order] for column in columns))


def _blunted(frequency: Array, ramp: Array) -> Array:
    """What a mode of `frequency` (M,), rad/s, sees of a raised-cosine ramp (E, 1), s, beside a step at its middle."""
    turn = frequency * ramp
    return np.sinc(turn / (2.0 * np.pi) + 0.5) * np.pi / 4.0 + np.sinc(turn / (2.0 * np.pi) - 0.5) * np.pi / 4.0


class Swings(NamedTuple):
    """Modes that swing, M of them, and the steps of force that make them: each coordinate of unit mass after a unit
    step has the acceleration Im(λ exp(λ t)) / Im(λ), λ being its pole.

    `turn` (M,) is by how much exp(λ t) turns and fades in a sample, `reading` (M, 2) what the resonator has of it along
    x and y; `sample` (E,) the first one behind each step, rising, and `kick` (E, M) what it adds there, m/s².
    """

    turn: ComplexArray
    reading: Array
    sample: Index
    kick: ComplexArray


def _swings(edges: Edges, squared: Array, shapes: Array, damping: Array, force: Array, rate: float) -> Swings:
    """The modes below half the `rate` (Hz) that swing, of natural frequencies `squared` (6,), rad²/s², `shapes` (6, 6)
    and modal `damping` (6,), 1/s, with the steps of `force` (2, E), N."""
    frequency = np.sqrt(np.maximum(squared, 0.0))
    chosen = np.flatnonzero((frequency > 0.0) & (frequency < math.pi * rate) & (damping < 2.0 * frequency))
    frequency, damping, shapes = frequency[chosen], damping[chosen], shapes[:, chosen]
    pole = -0.5 * damping + 1j * np.sqrt(frequency**2 - 0.25 * damping**2)
    sample = np.ceil(edges.time * rate - 1e-9).astype(np.int64)
    pushed = force.T @ (shapes[2:4] - shapes[0:2]) * _blunted(frequency, edges.ramp[:, None])
    kick = pole * pushed * np.exp(pole * (sample / rate - edges.time)[:, None])
    return Swings(np.exp(pole / rate), (shapes[4:6] / pole.imag).T.copy(), sample, kick)


@njit_lean
def _ring(swings: Swings, swing: ComplexArray, acceleration: Array) -> None:
    """Fill the `acceleration` (T, 2), m/s²; `swing` (M,) is where the modes are, at first at rest."""
    turn, reading, edge = swings.turn, swings.reading, 0
    for k in range(acceleration.shape[0]):
        for mode in range(turn.size):
            swing[mode] *= turn[mode]
        while edge < swings.sample.size and swings.sample[edge] == k:
            for mode in range(turn.size):
                swing[mode] += swings.kick[edge, mode]
            edge += 1
        for mode in range(turn.size):
            acceleration[k, 0] += swing[mode].imag * reading[mode, 0]
            acceleration[k, 1] += swing[mode].imag * reading[mode, 1]


def impulse_response(scene: Scene, rate: float, keep: Kept = ACCELERATION_ALONE) -> Trace:
    """Response of `scene` at the instants k / rate (Hz) to the steps of force at the edges of its spalls.

    A healthy scene gives zero, and there is nothing that it could `keep`. Contact changes are where balls have lost all
    their load at an edge, or begin to get it back; otherwise balls count as touching, also outside the load zone.
    Raises SimulationFailed where no position carries the load.
    """
    samples, rig = scene.samples(rate), scene.rig
    stiffness, film = _mean_contacts(scene)
    around = edges_around(scene)
    edges = edges_within(around, scene.duration)
    squared, shapes = eigh(coupled_matrix(rig.stiffness_matrix(), stiffness), rig.mass_matrix())
    damping = np.diag(shapes.T @ coupled_matrix(rig.damping_matrix(), film) @ shapes)
    cos_alpha = math.cos(rig.bearing.contact_angle)
    along = np.array([np.cos(edges.angle), np.sin(edges.angle)]) * edges.change * cos_alpha
    swings, acceleration = _swings(edges, squared, shapes, damping, along, rate), np.zeros((samples, 2))
    _ring(swings, np.zeros(swings.turn.size, np.complex128), acceleration)
    return Trace(
        rate=rate,
        time=np.arange(samples) / rate,
        acceleration=acceleration,
        changes=_changes(scene, around),
        model=IMPULSE_TRAIN.name,
        method="modes",
        step=math.nan,
        error_estimate=math.nan,
        tension_share=math.nan,
    )


def _changes(scene: Scene, edges: Edges) -> ContactChanges:
    bearing = scene.rig.bearing
    time = edges.time - 0.5 * np.sign(edges.change) * edges.ramp
    ahead = np.flatnonzero(edges.unloads & (time >= 0.0))
    ahead = ahead[np.argsort(time[ahead], kind="stable")]
    # What the first change of a ball undoes was so from the beginning; written last, as later ones come first.
    initial, backwards = np.ones((bearing.rows, bearing.balls), dtype=np.bool_), ahead[::-1]
    initial[edges.row[backwards] - 1, edges.ball[backwards] - 1] = edges.change[backwards] < 0.0
    logged = ahead[time[ahead] < scene.duration]
    return ContactChanges(
        time=time[logged],
        row=edges.row[logged],
        ball=edges.ball[logged],
        made=edges.change[logged] > 0.0,
        initial=initial,
    )


IMPULSE_TRAIN = Model(
    name="impulse train",
    computes="the ringing of the linear modes after each edge of each spall",
    holds_where="times of edges and the lines they make in spectra; levels to within some decibels, 6 at the reference "
    "scenes without roughness",
    leaves_out="release and regain other than of a ball at rest, variation of stiffness, hardening, healthy vibration, "
    "and modes that do not swing",
    rings=True,
    keeps=(),
    respond=impulse_response,
)
