"""Checks of values from JSON files that anybody may have edited: TypeError or ValueError for any other kind of
value."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, TypeVar

LARGEST = 2**53
# Errors raised by reading JSON that is damaged, or not what it should be.
UNREADABLE = (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError)
Row = TypeVar("Row")


def text(found: object) -> str:
    """A text."""
    if not isinstance(found, str):
        raise TypeError(f"{found!r} is not a text")
    return found


def whole(found: object) -> int:
    """A whole number from 0 to what a float holds exactly."""
    if isinstance(found, bool) or not isinstance(found, int):
        raise TypeError(f"{found!r} is not a whole number")
    if not 0 <= found <= LARGEST:
        raise ValueError(f"{found} is out of range")
    return found


def amount(found: object) -> float:
    """A finite number from 0."""
    if isinstance(found, bool) or not isinstance(found, int | float):
        raise TypeError(f"{found!r} is not a number")
    if not 0.0 <= found < math.inf:
        raise ValueError(f"{found} is out of range")
    return float(found)


PARSERS: dict[str, Callable[[object], Any]] = {"str": text, "int": whole, "float": amount}


def row(kind: type[Row], found: Mapping[str, object]) -> Row:
    """A dataclass of texts and numbers from a mapping with exactly its fields."""
    parsers = {field.name: PARSERS[str(field.type)] for field in fields(kind)}  # type: ignore[arg-type]
    if set(found) != set(parsers):
        raise TypeError(f"it has {sorted(found)} and not {sorted(parsers)}")
    return kind(**{name: parse(found[name]) for name, parse in parsers.items()})
