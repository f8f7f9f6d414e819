"""The rolling-ball filter: where the centre of a ball runs when it rolls over a raceway with a spall."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from physics._jit import njit, njit_inline, njit_lean
from physics.arrays import Array, Index
from physics.paths.corners import LEAP, RolledPath
from physics.paths.held_ball import (
    HEIGHT_ROUNDING,
    Ball,
    Held,
    Surface,
    hold_as_neighbours,
    hold_between_points,
    hold_on_lips,
)

FEWEST_STEPS = 512
# Points of the surface to a step of the path.
POINTS_A_STEP = 4
# Steps of the path whose points of the surface are passed over together if the highest of them cannot hold the ball.
BLOCKED = 4


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


def roll(
    surface: Surface,
    ends: tuple[float, float],
    ball: Ball,
    step: float,
    lips: Array | None = None,
) -> Rolled:
    """The `ball` rolled over the `surface` of a spall between its `ends` (rad), with the path of its centre.

    `step` is the wanted distance between the arcs of the path (rad); between its `lips` (L,), rad, rising, the surface
    has no corners. The arcs go beyond the spall if a bump that stands proud of the race lifts the ball there. Where the
    ball touches is looked for among points of the surface and then, exactly, between the neighbours of the point found.
    """
    lips = np.zeros(0) if lips is None else lips
    (start, stop), length = ends, ends[1] - ends[0]
    count = max(FEWEST_STEPS, math.ceil(length / step))
    fine = length / (count * POINTS_A_STEP)
    probe = surface(np.linspace(start, stop, count * POINTS_A_STEP + 1))
    beyond, reach = _margins(np.concatenate([probe, surface(lips)]), ball, fine)
    first, last = -beyond * POINTS_A_STEP, (count + beyond) * POINTS_A_STEP
    points = start + fine * np.arange(first - reach, last + reach + 1, dtype=np.float64)

    def inside(arc: Array, order: int = 0) -> Array:
        margin = 1e-12 * length
        return np.where((arc > start + margin) & (arc < stop - margin), surface(arc, order), 0.0)

    depth = inside(points)
    # A corner belongs to the good race, on which a ball can hang, or to a surface that stands proud of it.
    corners = [reach - first, reach - first + count * POINTS_A_STEP]
    depth[corners] = np.minimum(probe[[0, -1]], 0.0)
    steps = (depth.size - 2 * reach - 1) // POINTS_A_STEP + 1
    drop, point = np.empty(steps), np.empty(steps, dtype=np.int64)
    _roll(depth, reach, fine, ball, drop, point)
    arc = points[reach : points.size - reach : POINTS_A_STEP]
    held = Held(points[point], depth[point], drop)
    hold_on_lips(surface, ball, arc, held, lips, fine * reach)
    hold_between_points(inside, ball, arc, held, fine)
    hold_as_neighbours(inside, ball, arc, held, fine, LEAP * POINTS_A_STEP * fine)
    slope = ball.slope(held.depth, held.place - arc)
    path = RolledPath(arc, held.drop, slope, (held.place - arc[0]) / (fine * POINTS_A_STEP))
    return Rolled(path, ball, inside, points, depth)


def _margins(depths: Array, ball: Ball, fine: float) -> tuple[int, int]:
    """By how many steps the path goes on beyond the edges of a surface of these `depths` (N,), m, as bumps that stand
    proud of the race lift the ball there; and how many points, `fine` (rad) apart, a contact is ahead of the ball at
    most."""
    proud, deepest = max(0.0, -float(depths.min())), float(depths.max(initial=0.0))
    on_bump = ball._replace(race_radius=ball.race_radius + ball.turn * proud)
    lifted, hung = on_bump.reach_from_edge(proud), on_bump.reach_from_edge(max(deepest + proud, 1e-9))
    # Whole steps, so that both edges stay on a point of the grid.
    return math.ceil(lifted / (fine * POINTS_A_STEP)), math.ceil(1.05 * hung / fine) + 2


@njit
def _roll(depth: Array, reach: int, step: float, ball: Ball, drop: Array, contact: Index) -> None:
    """Fill in the `drop` (P,) at every point of the path and the number of the surface's point that holds the ball, its
    `contact` (P,), by trying each of the `reach` neighbours on both sides.

    Neighbours are taken block by block, and blocks whose highest point cannot touch first are passed over. This may
    take long, and nothing is returned: Ctrl-C while numba hands over a tuple would end the process with a crash.
    """
    size = BLOCKED * POINTS_A_STEP
    cosine = np.cos(step * np.arange(reach + 3))
    sine = np.sin(step * np.arange(reach + 3))
    blocks = (depth.size - 1) // size + 1
    highest, deepest = np.empty(blocks), depth.max()
    for block in range(blocks):
        highest[block] = depth[block * size : (block + 1) * size].min()
    for k in range(drop.size):
        centre = k * POINTS_A_STEP + reach
        least, best = drop_on(ball, depth[centre], 1.0, 0.0), centre
        for block in range((centre - reach) // size, (centre + reach) // size + 1):
            first, last = max(block * size, centre - reach), min(block * size + size - 1, centre + reach)
            near = max(first - centre, centre - last, 0)
            if _least_drop(ball, highest[block], deepest, cosine[near], sine[near]) > least:
                continue
            for point in range(first, last + 1):
                away = abs(point - centre)
                found = drop_on(ball, depth[point], cosine[away], sine[away])
                if found < least:
                    least, best = found, point
        drop[k], contact[k] = least, best


@njit_inline
def drop_on(ball: Ball, depth: float, cosine: float, sine: float) -> float:
    """Drop (m) of the `ball` that touches the surface at this `depth` (m); infinite if it is too far away for that.

    `cosine` and `sine` are of the angle between the ball's centre and the contact, not below 0. As `Ball.drop`,
    for single numbers.
    """
    race_radius, ball_radius, outer = ball.race_radius, ball.ball_radius, ball.turn < 0.0
    radius = race_radius + depth if outer else race_radius - depth
    lever = radius * sine
    if lever >= ball_radius:
        return math.inf
    hanging = math.sqrt(ball_radius * ball_radius - lever * lever)
    if outer:
        return radius * cosine - hanging - race_radius + ball_radius
    return race_radius + ball_radius - radius * cosine - hanging


@njit_lean
def _least_drop(ball: Ball, highest: float, deepest: float, cosine: float, sine: float) -> float:
    """A drop (m) below which no surface between the `highest` and the `deepest` depth (m) holds the ball.

    `cosine` and `sine` as in `drop_on`, of the least angle at which it may touch.
    """
    race_radius, ball_radius, outer = ball.race_radius, ball.ball_radius, ball.turn < 0.0
    lever = (race_radius + highest if outer else race_radius - deepest) * sine
    if lever >= ball_radius:
        return math.inf
    hanging = math.sqrt(ball_radius * ball_radius - lever * lever)
    if outer:
        return (race_radius + highest) * cosine - hanging - race_radius + ball_radius - HEIGHT_ROUNDING
    return race_radius + ball_radius - (race_radius - highest) * cosine - hanging - HEIGHT_ROUNDING
