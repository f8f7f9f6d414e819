"""One way to refuse a number: a ValueError that names the field, the value and what is allowed."""

from __future__ import annotations

import math
from numbers import Integral


class InvalidParameter(ValueError):
    """A physical parameter outside its allowed range; `field` names it."""

    def __init__(self, message: str, field: str = "") -> None:
        super().__init__(message)
        self.field = field


def require(condition: bool, message: str, field: str = "") -> None:
    """Raise InvalidParameter with `message` unless `condition` holds."""
    if not condition:
        raise InvalidParameter(message, field)


def require_between(field: str, value: float, low: float, high: float, unit: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and low ≤ value ≤ high."""
    suffix = f" {unit}" if unit else ""
    require(
        math.isfinite(value) and low <= value <= high,
        f"{field} = {value!r}{suffix}; allowed: {low:g} to {high:g}{suffix}",
        field,
    )


def require_finite(field: str, value: float, unit: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite."""
    suffix = f" {unit}" if unit else ""
    require(math.isfinite(value), f"{field} = {value!r}{suffix}; it must be finite", field)


def require_count(field: str, value: int, low: int, high: int) -> None:
    """Raise InvalidParameter unless `value` is a whole number and low ≤ value ≤ high."""
    whole = isinstance(value, Integral) and not isinstance(value, bool)
    require(whole and low <= value <= high, f"{field} = {value!r}; allowed: whole numbers {low} to {high}", field)


def require_positive(field: str, value: float, unit: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and above zero."""
    suffix = f" {unit}" if unit else ""
    require(math.isfinite(value) and value > 0.0, f"{field} = {value!r}{suffix}; it must be above 0", field)


def require_not_negative(field: str, value: float, unit: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and zero or above."""
    suffix = f" {unit}" if unit else ""
    require(math.isfinite(value) and value >= 0.0, f"{field} = {value!r}{suffix}; it must not be below 0", field)


def require_below_nyquist(field: str, frequency: float, rate: float) -> None:
    """Raise InvalidParameter unless `frequency` (Hz) lies below half the `rate` (Hz)."""
    require_positive("rate", rate, "Hz")
    require_between(field, frequency, 0.0, math.nextafter(rate / 2.0, 0.0), "Hz")
