"""What an estimator is told of a machine follows from its labels, each number from its own."""

from __future__ import annotations

import math
from typing import Any

import pytest

from datagen.sizing.stated_situation import reason_against, situation_of
from labels.spall_size.situation import Situation
from physics.hertz import BALL_EXPONENT

LABELS: dict[str, Any] = {
    "balls": 12, "rows": 2, "pitch_diameter": 38.75e-3, "ball_diameter": 7.12e-3, "contact_angle": 0.2,
    "speed_rpm": 600.0, "rate_hz": 2e4, "load_n": 346.0, "location": "inner",
}  # fmt: skip


def test_geometry_speed_and_load_are_given_and_never_the_race() -> None:
    given = situation_of(LABELS, (6e9, 1.4), 1.02)
    speed = 1.02 * 2.0 * math.pi * 10.0
    assert given.shaft_speed == pytest.approx(speed, rel=1e-12)
    assert given == Situation(12, 2, 38.75e-3, 7.12e-3, given.shaft_speed, 0.2, 346.0, 6e9, 1.4, race=None)


@pytest.mark.parametrize(
    ("load", "contact", "expected"),
    [
        (346.0, None, (None, None, BALL_EXPONENT)),
        (math.nan, (6e9, 1.4), (None, None, BALL_EXPONENT)),
        (math.inf, (6e9, 1.4), (None, None, BALL_EXPONENT)),
        (-1.0, (6e9, 1.4), (None, None, BALL_EXPONENT)),
        (0.0, (6e9, 1.4), (0.0, 6e9, 1.4)),
    ],
)
def test_load_and_hertz_factor_come_together_or_not_at_all(
    load: float, contact: tuple[float, float] | None, expected: tuple[float | None, float | None, float]
) -> None:
    given = situation_of(LABELS | {"load_n": load}, contact)
    assert (given.load, given.load_deflection, given.exponent) == expected


def test_what_is_not_said_of_rows_and_angle_is_one_row_without_an_angle() -> None:
    given = situation_of(LABELS | {"rows": math.nan, "contact_angle": math.nan})
    assert (given.rows, given.contact_angle) == (1, 0.0)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("balls", "number of balls"),
        ("pitch_diameter", "pitch diameter"),
        ("ball_diameter", "ball diameter"),
        ("speed_rpm", "shaft speed"),
        ("rate_hz", "sampling rate"),
    ],
)
def test_each_number_that_is_needed_is_named_where_it_is_missing(name: str, words: str) -> None:
    assert reason_against(LABELS) == ""
    assert reason_against(LABELS | {name: math.nan}) == f"not known: {words}"
    assert reason_against(LABELS | {"load_n": math.nan, "rows": math.nan, "contact_angle": math.nan}) == ""


@pytest.mark.parametrize("speed", [0.0, -600.0])
def test_a_shaft_that_does_not_turn_is_no_reason_to_guess(speed: float) -> None:
    assert reason_against(LABELS | {"speed_rpm": speed}) == f"the machine stood still: speed_rpm = {speed:g}"


@pytest.mark.parametrize("name", ["bpfo", "bpfi"])
def test_a_ball_pass_order_that_no_bearing_has_is_named(name: str) -> None:
    assert reason_against(LABELS | {name: 0.0}) == f"no such bearing: {name} = 0, allowed: above 0"
    assert reason_against(LABELS | {name: math.nan}) == ""
