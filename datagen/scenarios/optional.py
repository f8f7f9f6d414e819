"""What may be absent."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Value = TypeVar("Value")
Result = TypeVar("Result")


def if_given(value: Value | None, make: Callable[[Value], Result]) -> Result | None:
    """`make` of the value; None for None."""
    return None if value is None else make(value)
