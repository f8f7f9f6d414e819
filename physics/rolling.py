"""The rolling-ball filter: where the centre of a ball runs when it rolls over a raceway with a spall."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from physics._jit import njit

Array = NDArray[np.float64]
Curve = Callable[[Array], Array]

SURFACE_STEPS_PER_PATH_STEP = 4


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


def rolled_path(
    surface: Curve, half: float, race: str, race_radius: float, ball_radius: float, step: float
) -> tuple[Array, Array, Array]:
    """Arcs (N,), drop of the ball's centre (N,) in m and gap (N,) in m between the ball and the surface below it.

    `surface(arc)` is the depth of the surface (m, positive where material is missing) against the arc (rad) from the
    spall's centre, of half width `half`; `step` is the wanted distance between the returned arcs (rad).
    """
    count = max(512, math.ceil(2.0 * half / step))
    probe = surface(np.linspace(-half, half, 4 * count + 1))
    # A bump that stands proud of the race lifts the ball before it reaches the spall.
    proud = max(0.0, -float(probe.min()))
    margin = math.sqrt(2.0 * ball_radius * proud) / race_radius
    # The ball hangs on points of the race no further away than this lever.
    deepest = max(float(probe.max()) + proud, 1e-9)
    lever = math.sqrt(max(2.0 * ball_radius * deepest - deepest**2, 0.0)) if deepest < ball_radius else ball_radius
    reach = min(1.2 * lever, ball_radius) / race_radius + 2.0 * step
    arcs = np.linspace(-half - margin, half + margin, count + 1)
    fine = (arcs[1] - arcs[0]) / SURFACE_STEPS_PER_PATH_STEP
    steps_out = math.ceil(reach / fine)
    points = arcs[0] + fine * np.arange(-steps_out, SURFACE_STEPS_PER_PATH_STEP * count + steps_out + 1)
    # The corner itself belongs to the good race: a ball can hang on it.
    depth = np.where(np.abs(points) < half * (1.0 - 1e-12), surface(points), 0.0)
    outer = race == "outer"
    drop = _roll(depth, steps_out, fine, race_radius, ball_radius, outer)[::SURFACE_STEPS_PER_PATH_STEP]
    below = depth[steps_out : steps_out + SURFACE_STEPS_PER_PATH_STEP * count + 1 : SURFACE_STEPS_PER_PATH_STEP]
    return arcs, drop, below - drop


@njit
def _roll(depth: Array, reach: int, step: float, race_radius: float, ball_radius: float, outer: bool) -> Array:
    """Drop at every surface point that has `reach` neighbours on both sides, by trying each of them as the contact."""
    count = depth.size - 2 * reach
    cosine = np.cos(step * np.arange(reach + 1))
    sine = np.sin(step * np.arange(reach + 1))
    drop = np.empty(count)
    for k in range(count):
        least = 1e9
        for offset in range(-reach, reach + 1):
            away = abs(offset)
            s = depth[k + reach + offset]
            radius = race_radius + s if outer else race_radius - s
            lever = radius * sine[away]
            if lever >= ball_radius:
                continue
            hanging = math.sqrt(ball_radius * ball_radius - lever * lever)
            if outer:
                candidate = radius * cosine[away] - hanging - race_radius + ball_radius
            else:
                candidate = race_radius + ball_radius - radius * cosine[away] - hanging
            least = min(least, candidate)
        drop[k] = least
    return drop
