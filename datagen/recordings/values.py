"""Numbers of a SPEC: stated, or read from a variable of the recording's own file; and words of closed lists."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator
from pydantic_core import PydanticCustomError

from datagen.recipes.settings import Between, Table
from datagen.recipes.spelling import suggestion


class FromVariable(Table):
    """A number that the recording's file holds."""

    variable: str
    """Name of the variable, as for the channels."""
    factor: float = 1.0
    """What it is multiplied by to have the unit of the setting."""


def number(low: float = -math.inf, high: float = math.inf, above: bool = False) -> BeforeValidator:
    """The check of a stated number from `low` (excluded if `above`) to `high`; a table says where it is read."""
    allowed = Between(low, high, above)

    def check(value: Any) -> Any:
        if isinstance(value, dict | FromVariable):
            return value
        if not allowed.accepts(value) or not math.isfinite(value):
            words = f'{allowed.allowed()}, or {{variable = "NAME"}}'
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": words})
        return float(value)

    return BeforeValidator(check)


def word(*options: str) -> AfterValidator:
    """The check of a text that is one of `options`."""

    def check(value: str) -> str:
        if value not in options:
            hint = ", ".join(options) + suggestion(value, options)
            raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": hint})
        return value

    return AfterValidator(check)


AnyNumber = Annotated[float | FromVariable, number()]
NotNegative = Annotated[float | FromVariable, number(0.0)]
AboveZero = Annotated[float | FromVariable, number(0.0, above=True)]
