"""What a classifier or estimator may know from the labels of a record: geometry and speed, nothing of its health."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from labels.features.kinematics import NOMINAL_WITHIN, Kinematics, bearing_kinematics
from physics.angular_speed import RPM_PER_HZ
from physics.orders import ball_spin_order

UNKNOWN_SPEED = "speed unknown"
UNKNOWN_GEOMETRY = "geometry unknown"
NO_BEARING = "no bearing has this geometry"
GEOMETRY = ("balls", "pitch_diameter", "ball_diameter")
NO_ROTATION = "speed not above 0"


def known_kinematics(labels: Mapping[str, Any]) -> Kinematics | None:
    """Kinematics of the record with these labels, from its geometry or its orders; None if the labels state neither, no
    speed, or what no bearing has."""
    speed = number_in(labels, "speed_rpm") / RPM_PER_HZ
    if not speed > 0.0:
        return None
    known = _kinematics_at(labels, speed)
    return replace(known, speed_within=NOMINAL_WITHIN) if known and is_nominal(labels) else known


def what_is_missing(labels: Mapping[str, Any]) -> str:
    """Why no kinematics are known of a record with these labels: its speed or its geometry."""
    speed = float(labels["speed_rpm"])
    if not speed > 0.0:
        return UNKNOWN_SPEED if math.isnan(speed) else NO_ROTATION
    return NO_BEARING if _has_geometry(labels) else UNKNOWN_GEOMETRY


def is_nominal(labels: Mapping[str, Any]) -> bool:
    """Whether the speed is nominal: what a plate says or was set, and not what the shaft did."""
    return labels.get("speed_basis") == "nominal"


def _kinematics_at(labels: Mapping[str, Any], speed: float) -> Kinematics | None:
    balls, pitch, ball = (number_in(labels, name) for name in GEOMETRY)
    if not _has_geometry(labels):
        return _from_orders(labels, balls, speed)
    angle = number_in(labels, "contact_angle")
    try:
        return bearing_kinematics(int(balls), pitch, ball, angle if math.isfinite(angle) else 0.0, speed)
    except ValueError:
        return None


def _has_geometry(labels: Mapping[str, Any]) -> bool:
    return all(math.isfinite(number_in(labels, name)) for name in GEOMETRY)


def _from_orders(labels: Mapping[str, Any], balls: float, speed: float) -> Kinematics | None:
    """Kinematics from the orders: BPFO and BPFI add up to the number of balls, so either and that number give the
    rest."""
    outer, inner, spin, cage = (number_in(labels, name) for name in ("bpfo", "bpfi", "bsf", "ftf"))
    if not math.isfinite(balls):
        balls = _ball_count(outer, inner, cage)
    if not math.isfinite(outer):
        outer = balls - inner
    if not (balls >= 3 and math.isfinite(outer) and 0.0 < outer < balls / 2.0):
        return None
    ratio = 1.0 - 2.0 * outer / balls
    guessed = ball_spin_order(1.0 / ratio, ratio)
    return Kinematics(int(balls), ratio, spin if math.isfinite(spin) else guessed, speed)


def _ball_count(outer: float, inner: float, cage: float) -> float:
    """Number of balls that follows from the ball pass orders of both races, or from the outer one's and the cage's; NaN
    if neither pair is known."""
    counts = outer + inner, outer / cage if cage > 0.0 else math.nan
    return next((round(count) for count in counts if math.isfinite(count)), math.nan)


def number_in(labels: Mapping[str, Any], name: str) -> float:
    """The number that a label holds; NaN where it is unknown, or absent."""
    try:
        return float(labels[name])
    except (KeyError, TypeError, ValueError):
        return math.nan
