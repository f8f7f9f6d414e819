"""One way to refuse a value: a ValueError that names the field, the value and what is allowed.

`field` is the name of the attribute or argument, by which callers know it; `what`, if given, is what sentences call it.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from numbers import Integral, Real
from typing import Any

# Of a resonance, as a share of the critical damping: above 1/√2 nothing stands out of a frequency response.
HIGHEST_DAMPING = 0.7
LARGEST_ANGLE = 1e6  # rad


class InvalidParameter(ValueError):
    """A physical parameter outside its allowed range; `field` names it."""

    def __init__(self, message: str, field: str = "") -> None:
        super().__init__(message)
        self.field = field


def require(condition: bool, message: str, field: str = "") -> None:
    """Raise InvalidParameter with `message` unless `condition` holds."""
    if not condition:
        raise InvalidParameter(message, field)


def _said(value: Any) -> str:
    """A number as its digits, of whatever type, and anything else as it is written in Python."""
    return str(value) if isinstance(value, Real) else repr(value)


def _is_finite(value: Any) -> bool:
    """Whether `value` is a finite number; text, None, truth values and whole numbers beyond all floats are none."""
    try:
        return not isinstance(value, bool) and math.isfinite(value)
    except (TypeError, OverflowError):
        return False


def require_between(field: str, value: float, low: float, high: float, unit: str = "", what: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and low ≤ value ≤ high."""
    suffix = f" {unit}" if unit else ""
    require(
        _is_finite(value) and low <= value <= high,
        f"{what or field} = {_said(value)}{suffix}; allowed: {low:g} to {high:g}{suffix}",
        field,
    )


def require_finite(field: str, value: float, unit: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite."""
    suffix = f" {unit}" if unit else ""
    require(_is_finite(value), f"{field} = {_said(value)}{suffix}; it must be finite", field)


def require_angle(field: str, value: float) -> None:
    """Raise InvalidParameter unless `value` (rad) is an angle of so few turns that floats still tell balls apart."""
    require_between(field, value, -LARGEST_ANGLE, LARGEST_ANGLE, "rad")


def require_count(field: str, value: int, low: int, high: int, what: str = "") -> None:
    """Raise InvalidParameter unless `value` is a whole number and low ≤ value ≤ high."""
    whole = isinstance(value, Integral) and not isinstance(value, bool)
    message = f"{what or field} = {_said(value)}; allowed: whole numbers {low} to {high}"
    require(whole and low <= value <= high, message, field)


def require_one_of(field: str, value: str, allowed: Collection[str]) -> None:
    """Raise InvalidParameter unless `value` is one of the words `allowed`."""
    if value not in allowed:
        raise InvalidParameter(f'{field} = "{value}"; allowed: {", ".join(allowed)}', field)


def require_positive(field: str, value: float, unit: str = "", what: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and above zero."""
    suffix = f" {unit}" if unit else ""
    require(_is_finite(value) and value > 0.0, f"{what or field} = {_said(value)}{suffix}; it must be above 0", field)


def require_up_to(field: str, value: float, high: float, unit: str = "", what: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and 0 < value ≤ high."""
    suffix = f" {unit}" if unit else ""
    message = f"{what or field} = {_said(value)}{suffix}; allowed: above 0, up to {high:g}{suffix}"
    require(_is_finite(value) and 0.0 < value <= high, message, field)


def require_not_negative(field: str, value: float, unit: str = "", what: str = "") -> None:
    """Raise InvalidParameter unless `value` is finite and zero or above."""
    suffix = f" {unit}" if unit else ""
    message = f"{what or field} = {_said(value)}{suffix}; it must not be below 0"
    require(_is_finite(value) and value >= 0.0, message, field)


def require_below_nyquist(field: str, frequency: float, rate: float, what: str = "") -> None:
    """Raise InvalidParameter unless `frequency` (Hz), 0 or above, lies below half the `rate` (Hz)."""
    require_positive("rate", rate, "Hz")
    message = f"{what or field} = {_said(frequency)} Hz; allowed: from 0 to below {rate / 2.0:.10g} Hz, half the rate"
    require(_is_finite(frequency) and 0.0 <= frequency < rate / 2.0, message, field)


def settle_tuples(instance: object, *fields: str) -> None:
    """Turn lists and arrays in the `fields` of a frozen `instance` into tuples, rows of them too.

    So whoever describes a scene may write them, and scenes can still be compared and looked up. Raises
    InvalidParameter for what is no sequence.
    """
    for field in fields:
        value = getattr(instance, field)
        settled = _in_tuples(value)
        require(isinstance(settled, tuple), f"{field} is of type {type(value).__name__}; it must be a sequence", field)
        object.__setattr__(instance, field, settled)


def _in_tuples(value: Any) -> Any:
    """The `value`, tuples in place of lists and arrays; what is one already stays the same object."""
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, tuple) and not any(isinstance(item, list) or hasattr(item, "tolist") for item in value):
        return value
    return tuple(map(_in_tuples, value)) if isinstance(value, (tuple, list)) else value
