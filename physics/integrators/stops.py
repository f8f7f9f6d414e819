"""Instants, known beforehand, at which a march has to end a step: a ball crosses an edge of its path."""

from __future__ import annotations

from typing import NamedTuple

from physics._jit import njit_inner, njit_lean
from physics.arrays import Array, Index
from physics.contact.forces import ACTIVE, of_ball

ANY_BALL = -1
# A step ends this much, as a share of the full step, before a kink and the next one starts as much after it, so that
# each reads its own side.
KINK_NUDGE_SHARE = 1e-8


class Stops(NamedTuple):
    """Known kinks in time order: `time` (S,) s and the `ball` (S,), numbered as in the contact model, that crosses, or
    ANY_BALL where a step ends whether it touches or not."""

    time: Array
    ball: Index


@njit_inner
def has_ridges(stops: Stops) -> bool:
    """Whether some ball passes from one spall to another within a step."""
    lowest = 0
    for kink in range(stops.ball.size):
        lowest = min(lowest, stops.ball[kink])
    return lowest == ANY_BALL


@njit_lean
def passed_kinks(stops: Stops, ahead: int, time: float) -> int:
    """Index of the first kink after `time`, counting on from the one that was `ahead`."""
    while ahead < stops.time.size and stops.time[ahead] <= time:
        ahead += 1
    return ahead


@njit_lean
def next_kink(balls: Array, stops: Stops, ahead: int, finish: float) -> float:
    """Time (s) of the first kink, from the one `ahead` on, that a ball in contact, or ANY_BALL, crosses before
    `finish`, or `finish`.

    A ball out of contact feels a kink only where it makes contact there, which is located like any other change; as it
    may make contact before a later one, none is dropped here.
    """
    while ahead < stops.time.size and stops.time[ahead] < finish:
        ball = stops.ball[ahead]
        if ball == ANY_BALL or of_ball(balls, ACTIVE, ball) > 0.5:
            return stops.time[ahead]
        ahead += 1
    return finish
