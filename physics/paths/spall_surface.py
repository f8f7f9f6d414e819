"""The surface of a spall: its tapered window, its roughness, a measured table."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from physics.arrays import Array
from physics.paths.held_ball import Surface
from physics.spall import Spall

# Share of its depth by which a floor may lie below the ball that touches it, and above its deepest part.
TOUCHING_SHARE = 0.02


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


def window_slope(spall: Spall, arc: Array) -> Array:
    """Derivative (N,) of the window to the arc, 1/rad."""
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


def gap_surface(spall: Spall) -> Surface:
    """A gap with the spall's tapers and roughness."""
    rough = roughness_curve(spall)

    def surface(arc: Array, order: int = 0) -> Array:
        inside = np.abs(arc) <= spall.extent / 2.0
        bumps = 0.0 if rough is None else np.where(inside, rough(arc, order), 0.0)
        return spall.depth * (window if order == 0 else window_slope)(spall, arc) + bumps

    return surface


def floor_ends(spall: Spall) -> Array:
    """The arcs (N,), rad, rising, at which tapers of a smooth gap meet its floor: one for each taper, or one for both
    where they meet each other."""
    half = spall.extent / 2.0
    ends = [(spall.entry_taper, spall.entry_taper - half), (spall.exit_taper, half - spall.exit_taper)]
    return np.unique([end for taper, end in ends if taper > 0.0])


def table_arcs(spall: Spall) -> Array:
    """The arcs (N,), rad, rising, of the points of the spall's measured table; none if it has no table."""
    return spall.travel_sign * np.array(spall.table_angle)[:: spall.travel_sign]


def table_surface(spall: Spall) -> Surface:
    """The straight lines between the points of the spall's measured table; no depth outside."""
    angle, depth = table_arcs(spall), np.array(spall.table_depth)[:: spall.travel_sign]
    slopes = np.concatenate([[0.0], np.diff(depth) / np.diff(angle), [0.0]])

    def surface(arc: Array, order: int = 0) -> Array:
        if order == 0:
            return np.interp(arc, angle, depth, left=0.0, right=0.0)
        return np.asarray(slopes[np.searchsorted(angle, arc)])

    return surface


def turning_points(depth: Array) -> int:
    """How often the depths (N,) turn from falling to rising or back."""
    moves = np.diff(depth)
    return int(np.count_nonzero(np.diff(np.sign(moves[moves != 0.0]))))


def reaches_floor(spall: Spall, arcs: Array, gap: Array) -> bool:
    """Whether the `gap` (N,), m, below the ball closes on the floor: between the tapers, or deep in a table."""
    if spall.profile == "table":
        floor = table_surface(spall)(arcs) >= 0.5 * spall.floor_depth
    else:
        floor = window(spall, arcs) >= 1.0 - TOUCHING_SHARE
    return bool(np.any(gap[floor] <= TOUCHING_SHARE * max(spall.floor_depth, 1e-12)))
