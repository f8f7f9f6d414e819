"""The rolling-ball filter: where the centre of a ball runs when it rolls over a raceway with a spall."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics._jit import njit, njit_inline, njit_lean
from physics.arrays import Array, Index
from physics.paths.corners import LEAP, NEAREST, Branches, RolledPath, branches, corners_of
from physics.paths.held_ball import (
    ROUNDING,
    Ball,
    Held,
    Surface,
    between_points,
    hold_as_neighbours,
    hold_between_points,
    hold_on_lips,
)

Curve = Callable[[Array], Array]

FEWEST_STEPS = 512
# Points of the surface for each one of the path.
POINTS_A_STEP = 4
# Points of the surface that are passed over together, for each one of the path's.
BLOCKED = 4
# A bump between both that meet in a corner holds the ball if it does so by more than this (m) higher than they.
HIGHER = 1e-11
# How often cells are halved in which the contact leaps, as it does in hollows as well.
HOLLOW_HALVINGS = 6
# A contact so near to a lip (steps) is on it.
ON_LIP = 1e-3
# What is left of a height (m) when a ball is held between points of a surface.
ROUNDED = 1e-13
# Bumps beside such bumps are looked for again; in 480 records of `corpus` four rounds found the last.
MOST_ROUNDS = 32


class Rolled(NamedTuple):
    """A `path`, the `ball` that rolled, the `surface`, and its `depth` (M,), m, at the `points` (M,), rad, tried."""

    path: RolledPath
    ball: Ball
    surface: Surface
    points: Array
    depth: Array

    @property
    def pace(self) -> float:
        """A step of the path, rad."""
        return float(self.points[1] - self.points[0]) * POINTS_A_STEP


def deep_gap_drop(race: str, race_radius: float, ball_radius: float) -> tuple[Curve, Curve]:
    """Drop (m) and its slope (m/rad) of a ball hanging on one sharp edge at the arc ψ (rad) from it.

    Outer race: Rb − √(Rb² − Ro² sin²ψ) − Ro (1 − cos ψ); inner race: the last term is + Ri (1 − cos ψ).
    """
    turn = -1.0 if race == "outer" else 1.0

    def drop(arc: Array) -> Array:
        lever = np.minimum(race_radius * np.sin(arc), ball_radius)
        hanging = ball_radius - np.sqrt(ball_radius**2 - lever**2)
        return np.asarray(hanging + turn * race_radius * (1.0 - np.cos(arc)))

    def slope(arc: Array) -> Array:
        lever = np.minimum(race_radius * np.sin(arc), ball_radius * (1.0 - 1e-12))
        hanging = lever * race_radius * np.cos(arc) / np.sqrt(ball_radius**2 - lever**2)
        return np.asarray(hanging + turn * race_radius * np.sin(arc))

    return drop, slope


def hanging_reach(race: str, race_radius: float, ball_radius: float, drop: float) -> float:
    """Arc (rad) from a sharp edge at which a ball hanging on it has dropped by `drop` (m), the inverse of the above.

    No more than the arc at which the ball slips past the edge.
    """
    turn = -1.0 if race == "outer" else 1.0
    furthest = math.asin(min(1.0, ball_radius / race_radius))
    drop = min(drop, ball_radius + turn * race_radius * (1.0 - math.cos(furthest)))
    centre_radius = race_radius + turn * (ball_radius - drop)
    half_sine = math.sqrt(drop * (2.0 * ball_radius - drop) / (4.0 * race_radius * centre_radius))
    return min(furthest, 2.0 * math.asin(half_sine))


def roll(
    surface: Surface,
    ends: tuple[float, float],
    race: str,
    race_radius: float,
    ball_radius: float,
    step: float,
    lips: Array | None = None,
) -> Rolled:
    """A ball rolled over the `surface` of a spall between its `ends` (rad), with the path of its centre.

    `step` is the wanted distance between the arcs of the path (rad); between its `lips` (L,), rad, rising, the surface
    has no corners. The arcs go beyond the spall if a bump that stands proud of the race lifts the ball there. Where the
    ball touches is looked for among points of the surface and then, exactly, between the neighbours of the point found.
    """
    ball = Ball(race_radius, ball_radius, -1.0 if race == "outer" else 1.0)
    lips = np.zeros(0) if lips is None else lips
    (start, stop), length = ends, ends[1] - ends[0]
    count = max(FEWEST_STEPS, math.ceil(length / step))
    fine = length / (count * POINTS_A_STEP)
    probe = surface(np.linspace(start, stop, count * POINTS_A_STEP + 1))
    beyond, reach = _margins(np.concatenate([probe, surface(lips)]), race, ball, fine)
    first, last = -beyond * POINTS_A_STEP, (count + beyond) * POINTS_A_STEP
    points = start + fine * np.arange(first - reach, last + reach + 1, dtype=np.float64)

    def inside(arc: Array, order: int = 0) -> Array:
        margin = 1e-12 * length
        return np.where((arc > start + margin) & (arc < stop - margin), surface(arc, order), 0.0)

    depth = inside(points)
    # A corner belongs to the good race, on which a ball can hang, or to a surface that stands proud of it.
    corners = [reach - first, reach - first + count * POINTS_A_STEP]
    depth[corners] = np.minimum(probe[[0, -1]], 0.0)
    drop, place = _roll(depth, reach, fine, race_radius, ball_radius, race == "outer")
    arc = points[reach : points.size - reach : POINTS_A_STEP]
    held = Held(points[place], depth[place], drop)
    hold_on_lips(surface, ball, arc, held, lips, fine * reach)
    hold_between_points(inside, ball, arc, held, fine)
    hold_as_neighbours(inside, ball, arc, held, fine, LEAP * POINTS_A_STEP * fine)
    slope = ball.slope(held.depth, held.place - arc)
    path = RolledPath(arc, held.drop, slope, (held.place - arc[0]) / (fine * POINTS_A_STEP))
    return Rolled(path, ball, inside, points, depth)


def smooth_branches(rolled: Rolled, joints: Array | None = None, lips: tuple[Array, Array] | None = None) -> Branches:
    """The smooth branches of the path, those of bumps that hold the ball over less than a step among them.

    Of a surface without bumps the `joints` (J,), rad, are to be given: places without slope at which it begins or
    ceases to bend. Where the ball rolls over them the path's curvature jumps, which no cubic over both sides follows,
    so branches end there as well. So they do where the ball begins and ceases to hang on one of the `lips` of a surface
    that is straight between them, which may be given instead: their arcs (L,), rad, and depths (L,), m.
    """
    edges = np.zeros(0)
    if joints is not None:
        path, edges = _with_joints(_with_narrow_bumps(rolled, _with_hollows(rolled)), rolled, joints)
    else:
        path = _with_narrow_bumps(rolled, rolled.path)
    if lips is not None:
        path, edges = _with_lip_ends(path, rolled, *lips)
    found = branches(path)
    edges = np.unique(np.concatenate([found.edges, edges]))
    apart = np.diff(edges, prepend=-math.inf) > NEAREST * rolled.pace
    apart[-1] = True
    return found._replace(edges=edges[apart])


def _with_lip_ends(path: RolledPath, rolled: Rolled, lips: Array, depth: Array) -> tuple[RolledPath, Array]:
    """The path with a node wherever the ball begins or ceases to hang on one of the `lips` (L,), rad, at `depth` (L,),
    m, as it begins or ceases to touch the straight surface beside it; and the arcs (E,), rad, of these nodes."""
    steepness = np.diff(depth) / np.diff(lips)
    # The face behind each lip but the last, and that before each but the first.
    lip = np.concatenate([np.arange(lips.size - 1), np.arange(1, lips.size)])
    arc = lips[lip] - rolled.ball.away_on(depth[lip], np.tile(steepness, 2))
    # At a wall down from the race the ball hangs on the race's own edge, and leaps from there.
    at_wall = np.isin(lip, (0, lips.size - 1)) & (depth[lip] > 0.0)
    order = np.argsort(arc)
    order = order[(arc[order] > path.arc[0]) & (arc[order] < path.arc[-1]) & ~at_wall[order]]
    lip, arc = lip[order], arc[order]
    cells = np.searchsorted(path.arc, arc, side="right") - 1
    own = (lips[lip] - path.arc[0]) / rolled.pace
    beside = np.minimum(np.abs(path.contact[cells] - own), np.abs(path.contact[cells + 1] - own))
    # Where the contact leaps, the ball may have left the lip for another one before it came to the face.
    leaps = np.abs(path.contact[cells + 1] - path.contact[cells]) > LEAP
    held = (beside < ON_LIP) & ~leaps
    cells, arc, lip = cells[held], arc[held], lip[held]
    share = (arc - path.arc[cells]) / (path.arc[cells + 1] - path.arc[cells])
    new = (share > NEAREST) & (share < 1.0 - NEAREST)
    edges = np.where(new, arc, path.arc[cells + np.rint(share).astype(np.int64)])
    place, depth = lips[lip[new]], depth[lip[new]]
    hung = Held(place, depth, rolled.ball.drop(depth, place - arc[new]))
    return _with_nodes(path, rolled, cells[new], arc[new], hung), edges


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


def _with_joints(path: RolledPath, rolled: Rolled, joints: Array) -> tuple[RolledPath, Array]:
    """The path with a node at each of the `joints` (J,), rad, that the ball touches when it is above it; and the arcs
    (E,), rad, of these nodes."""
    joints = joints[(joints > path.arc[0]) & (joints < path.arc[-1])]
    cells = np.searchsorted(path.arc, joints, side="right") - 1
    floor = rolled.surface(joints)
    touched = _held_between(path, rolled, cells, joints).drop > floor - ROUNDED
    cells, joints, floor = cells[touched], joints[touched], floor[touched]
    share = (joints - path.arc[cells]) / (path.arc[cells + 1] - path.arc[cells])
    new = (share > NEAREST) & (share < 1.0 - NEAREST)
    edges = np.where(new, joints, path.arc[cells + np.rint(share).astype(np.int64)])
    held = Held(joints[new], floor[new], floor[new])
    path = _with_nodes(path, rolled, cells[new], joints[new], held)
    return path, edges


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
    fine, outer = points[1] - points[0], ball.turn < 0.0
    touched = path.arc[0] + path.contact * rolled.pace
    first, last = (np.rint((touched[cells + k] - points[0]) / fine).astype(np.int64) for k in (0, 1))
    place = _highest_between(depth, first, last, arc - points[0], fine, *ball[:2], outer)
    return between_points(surface, ball, arc, points[place], fine)


def _margins(depths: Array, race: str, ball: Ball, fine: float) -> tuple[int, int]:
    """By how many steps the path goes on beyond the edges of a surface of these `depths` (N,), m, as bumps that stand
    proud of the race lift the ball there; and how many points, `fine` (rad) apart, a contact is ahead of the ball at
    most."""
    proud, deepest = max(0.0, -float(depths.min())), float(depths.max(initial=0.0))
    bump_radius = ball.race_radius + ball.turn * proud
    lifted = hanging_reach(race, bump_radius, ball.ball_radius, proud)
    hung = hanging_reach(race, bump_radius, ball.ball_radius, max(deepest + proud, 1e-9))
    # Whole steps, so that both edges stay on a point of the grid.
    return math.ceil(lifted / (fine * POINTS_A_STEP)), math.ceil(1.05 * hung / fine) + 2


@njit
def _roll(
    depth: Array, reach: int, step: float, race_radius: float, ball_radius: float, outer: bool
) -> tuple[Array, Index]:
    """Drop at every point of the path and the number of the surface's point that holds the ball, by trying each of the
    `reach` neighbours on both sides.

    Neighbours are taken block by block, and blocks whose highest point cannot touch first are passed over.
    """
    count = (depth.size - 2 * reach - 1) // POINTS_A_STEP + 1
    size = BLOCKED * POINTS_A_STEP
    cosine = np.cos(step * np.arange(reach + 3))
    sine = np.sin(step * np.arange(reach + 3))
    blocks = (depth.size - 1) // size + 1
    highest, deepest = np.empty(blocks), depth.max()
    for block in range(blocks):
        highest[block] = depth[block * size : (block + 1) * size].min()
    drop, contact = np.empty(count), np.empty(count, dtype=np.int64)
    for k in range(count):
        centre = k * POINTS_A_STEP + reach
        least, best = _drop_on(depth[centre], 1.0, 0.0, race_radius, ball_radius, outer), centre
        for block in range((centre - reach) // size, (centre + reach) // size + 1):
            first, last = max(block * size, centre - reach), min(block * size + size - 1, centre + reach)
            near = max(first - centre, centre - last, 0)
            if _least_drop(highest[block], deepest, cosine[near], sine[near], race_radius, ball_radius, outer) > least:
                continue
            for place in range(first, last + 1):
                away = abs(place - centre)
                found = _drop_on(depth[place], cosine[away], sine[away], race_radius, ball_radius, outer)
                if found < least:
                    least, best = found, place
        drop[k], contact[k] = least, best
    return drop, contact


@njit
def _highest_between(
    depth: Array,
    first: Index,
    last: Index,
    arc: Array,
    step: float,
    race_radius: float,
    ball_radius: float,
    outer: bool,
) -> Index:
    """The points (N,) of the surface, from `first` to `last` (N,) each, that hold balls at the arcs (N,), rad, from
    point 0 highest."""
    highest = first.copy()
    for k in range(arc.size):
        least = math.inf
        for place in range(first[k], last[k] + 1):
            away = abs(step * place - arc[k])
            found = _drop_on(depth[place], math.cos(away), math.sin(away), race_radius, ball_radius, outer)
            if found < least:
                least, highest[k] = found, place
    return highest


@njit_inline
def _drop_on(s: float, cosine: float, sine: float, race_radius: float, ball_radius: float, outer: bool) -> float:
    """Drop (m) of a ball that touches the surface at the depth `s` (m), so far away; infinite if it cannot."""
    radius = race_radius + s if outer else race_radius - s
    lever = radius * sine
    if lever >= ball_radius:
        return math.inf
    hanging = math.sqrt(ball_radius * ball_radius - lever * lever)
    if outer:
        return radius * cosine - hanging - race_radius + ball_radius
    return race_radius + ball_radius - radius * cosine - hanging


@njit_lean
def _least_drop(
    highest: float, deepest: float, cosine: float, sine: float, race_radius: float, ball_radius: float, outer: bool
) -> float:
    """A drop (m) below which no surface between these depths (m) holds the ball, so far away."""
    lever = (race_radius + highest if outer else race_radius - deepest) * sine
    if lever >= ball_radius:
        return math.inf
    hanging = math.sqrt(ball_radius * ball_radius - lever * lever)
    if outer:
        return (race_radius + highest) * cosine - hanging - race_radius + ball_radius - ROUNDING
    return race_radius + ball_radius - (race_radius - highest) * cosine - hanging - ROUNDING
