"""A number that was estimated from samples, and the interval around it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Interval:
    """A number and the ends of its interval; NaN where it is not defined."""

    value: float
    low: float
    high: float
