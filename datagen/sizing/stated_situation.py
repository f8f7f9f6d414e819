"""What an estimator is given of the machine behind a record, and why a record may not be sized at all."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from datagen.judging.known import is_nominal, known_kinematics, number_in
from datagen.judging.stated_speed import SPEED_ERROR
from datagen.scenarios.streams import stream
from labels.dead_sensor import live_axis
from labels.features.analysis import analyse
from labels.spall_size.situation import Situation
from physics.angular_speed import RPM
from physics.arrays import Array
from physics.checks import InvalidParameter
from physics.hertz import BALL_EXPONENT

# Seed of the errors of the stated speeds.
SPEED_SEED = 0
NEEDED = {
    "balls": "number of balls",
    "pitch_diameter": "pitch diameter",
    "ball_diameter": "ball diameter",
    "speed_rpm": "shaft speed",
    "rate_hz": "sampling rate",
}
PASS_ORDERS = ("bpfo", "bpfi")


def reason_against(labels: Mapping[str, Any]) -> str:
    """Why a record with these `labels` cannot be sized, in words; empty if it can."""
    unknown = [words for name, words in NEEDED.items() if not math.isfinite(number_in(labels, name))]
    if unknown:
        return f"not known: {', '.join(unknown)}"
    if float(labels["speed_rpm"]) <= 0.0:
        return f"the machine stood still: speed_rpm = {float(labels['speed_rpm']):g}"
    impossible = [f"{name} = {number_in(labels, name):g}" for name in PASS_ORDERS if number_in(labels, name) <= 0.0]
    if impossible:
        return f"no such bearing: {impossible[0]}, allowed: above 0"
    try:
        situation_of(labels)
    except InvalidParameter as problem:
        return f"no such bearing: {problem}"
    return ""


def wrong_speed(record: int) -> float:
    """Stated over true speed of a record, within ±2 % of 1."""
    return 1.0 + SPEED_ERROR * (2.0 * float(stream(SPEED_SEED, "record", record, "stated_speed").random()) - 1.0)


def speed_found(labels: Mapping[str, Any], acceleration: Array) -> float:
    """The shaft's speed over the stated one: 1 unless that is nominal, and then as the classifiers find it, from the
    harmonics of the shaft and of ball passes in the `acceleration` (T, axes)."""
    known, signal = known_kinematics(labels), live_axis(acceleration)
    if known is None or signal is None or not is_nominal(labels):
        return 1.0
    try:
        return analyse(signal, float(labels["rate_hz"]), known).speed.shaft_hz / known.shaft_hz
    except ValueError:  # too short, or nothing in it: for the estimator to say
        return 1.0


def situation_of(
    labels: Mapping[str, Any], contact: tuple[float, float] | None = None, speed_factor: float = 1.0
) -> Situation:
    """What an estimator is given: geometry, speed times `speed_factor` and, with `contact` (K, n), the load; never the
    race.

    Raises InvalidParameter.
    """
    load, rows, angle = (number_in(labels, name) for name in ("load_n", "rows", "contact_angle"))
    factor, exponent = contact if contact is not None and 0.0 <= load < math.inf else (None, BALL_EXPONENT)
    return Situation(
        balls=int(labels["balls"]),
        rows=int(rows) if math.isfinite(rows) else 1,
        pitch_diameter=float(labels["pitch_diameter"]),
        ball_diameter=float(labels["ball_diameter"]),
        shaft_speed=float(labels["speed_rpm"]) * RPM * speed_factor,
        contact_angle=angle if math.isfinite(angle) else 0.0,
        load=None if factor is None else load,
        load_deflection=factor,
        exponent=exponent,
    )
