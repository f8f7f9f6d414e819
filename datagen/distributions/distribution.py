"""What a distribution is: a rule that turns one number in [0, 1) into a value, read from and written to TOML."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from datagen.errors import value_text

Value = float | int | str | bool


class DistributionError(ValueError):
    """A distribution that is not written as it must be; the message says what is wrong."""


class Distribution(ABC):
    """A rule that turns a number in [0, 1) into a value."""

    @abstractmethod
    def quantile(self, probability: float) -> Any:
        """The value below which the share `probability` (0 ≤ p < 1) of all draws lies."""

    @abstractmethod
    def stated(self) -> tuple[Any, ...]:
        """The values a recipe states of it: these must be allowed for the setting."""

    @property
    def lowest(self) -> float:
        """The smallest number that it is known to give."""
        return float(min(self.stated()))

    @property
    def highest(self) -> float:
        """The largest number that it is known to give."""
        return float(max(self.stated()))

    @abstractmethod
    def to_toml(self) -> object:
        """The bare value or inline table that gives this distribution back."""


class Drawn(Distribution):
    """A distribution that a recipe writes as an inline table; `keys` are those of the table, the first its name."""

    keys: ClassVar[tuple[str, ...]]

    @classmethod
    @abstractmethod
    def from_table(cls, table: Mapping[str, Any]) -> Drawn:
        """The distribution an inline table describes; raises DistributionError."""

    @classmethod
    @abstractmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        """JSON Schema of its inline table, `value` being the schema of one value."""


@dataclass(frozen=True)
class Fixed(Distribution):
    """Always the same value, which a recipe writes bare."""

    value: Value

    def quantile(self, probability: float) -> Any:
        return self.value

    def stated(self) -> tuple[Any, ...]:
        return (self.value,)

    def to_toml(self) -> object:
        return self.value


def number(name: str, value: object) -> float:
    """The finite number that an inline table has under `name`; raises DistributionError."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise DistributionError(f"{name} = {value_text(value)}: give a finite number")
    return float(value)


def pair(name: str, value: object) -> tuple[float, float]:
    """The two finite numbers that an inline table has under `name`; raises DistributionError."""
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise DistributionError(f"{name} = {value_text(value)}: give a list of two numbers")
    return number(name, value[0]), number(name, value[1])


def pair_schema(value: Mapping[str, Any]) -> dict[str, Any]:
    """JSON Schema of a list of two values of schema `value`."""
    return {"type": "array", "items": dict(value), "minItems": 2, "maxItems": 2}


def object_schema(properties: dict[str, Any], required: list[str] | None = None) -> dict[str, Any]:
    """JSON Schema of an inline table; all its keys are required unless some are listed."""
    return {
        "type": "object",
        "properties": properties,
        "required": required or list(properties),
        "additionalProperties": False,
    }
