"""The rolling-ball filter: where the centre of a ball runs when it rolls over a raceway with a spall."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit, njit_inline, njit_lean

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]

FEWEST_STEPS = 512
SURFACE_STEPS_PER_PATH_STEP = 4
BLOCK = 16
# What rounding leaves of a height (m).
ROUNDING = 1e-15


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


def rolled_path(
    surface: Curve, half: float, race: str, race_radius: float, ball_radius: float, step: float
) -> tuple[Array, Array]:
    """Arcs (N,), rad, and drop of the ball's centre (N,) there, m.

    `surface(arc)` is the depth of the surface (m, positive where material is missing) against the arc (rad) from the
    spall's centre, of half width `half`; `step` is the wanted distance between the returned arcs (rad). The arcs go
    beyond the spall if a bump that stands proud of the race lifts the ball there.
    """
    count = max(FEWEST_STEPS, math.ceil(2.0 * half / step))
    fine = 2.0 * half / (count * SURFACE_STEPS_PER_PATH_STEP)
    probe = surface(np.linspace(-half, half, count * SURFACE_STEPS_PER_PATH_STEP + 1))
    outer, proud = race == "outer", max(0.0, -float(probe.min()))
    bump_radius = race_radius - proud if outer else race_radius + proud
    lifted = hanging_reach(race, bump_radius, ball_radius, proud)
    # Whole steps beyond the edges, so that both edges stay on a point of the grid.
    beyond = math.ceil(lifted / (fine * SURFACE_STEPS_PER_PATH_STEP))
    hung = hanging_reach(race, bump_radius, ball_radius, max(float(probe.max()) + proud, 1e-9))
    reach = math.ceil(1.05 * hung / fine) + 2
    first, last = -beyond * SURFACE_STEPS_PER_PATH_STEP, (count + beyond) * SURFACE_STEPS_PER_PATH_STEP
    points = -half + fine * np.arange(first - reach, last + reach + 1, dtype=np.float64)
    # The corner itself belongs to the good race: a ball can hang on it.
    depth = np.where(np.abs(points) < half * (1.0 - 1e-12), surface(points), 0.0)
    drop = _roll(depth, reach, fine, race_radius, ball_radius, outer)
    return points[reach : points.size - reach : SURFACE_STEPS_PER_PATH_STEP], drop


@njit
def _roll(depth: Array, reach: int, step: float, race_radius: float, ball_radius: float, outer: bool) -> Array:
    """Drop at the surface points of the path, by trying each of the `reach` neighbours on both sides as the contact.

    Neighbours are taken block by block, and blocks whose highest point cannot touch first are passed over.
    """
    count = (depth.size - 2 * reach - 1) // SURFACE_STEPS_PER_PATH_STEP + 1
    cosine = np.cos(step * np.arange(reach + 1))
    sine = np.sin(step * np.arange(reach + 1))
    blocks = (depth.size - 1) // BLOCK + 1
    highest, deepest = np.empty(blocks), depth.max()
    for block in range(blocks):
        highest[block] = depth[block * BLOCK : (block + 1) * BLOCK].min()
    drop = np.empty(count)
    for k in range(count):
        centre = k * SURFACE_STEPS_PER_PATH_STEP + reach
        least = _drop_on(depth[centre], 1.0, 0.0, race_radius, ball_radius, outer)
        for block in range((centre - reach) // BLOCK, (centre + reach) // BLOCK + 1):
            first, last = max(block * BLOCK, centre - reach), min(block * BLOCK + BLOCK - 1, centre + reach)
            near = max(first - centre, centre - last, 0)
            if _least_drop(highest[block], deepest, cosine[near], sine[near], race_radius, ball_radius, outer) > least:
                continue
            for place in range(first, last + 1):
                away = abs(place - centre)
                least = min(least, _drop_on(depth[place], cosine[away], sine[away], race_radius, ball_radius, outer))
        drop[k] = least
    return drop


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
