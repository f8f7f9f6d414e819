"""Distributions a recipe can name: a bare value is fixed, an inline table with the distribution's name is drawn.

    5.0                                          fixed
    {uniform = [2, 8]}                           equally likely between two numbers
    {log_uniform = [0.1, 10]}                    equally likely in the logarithm
    {normal = [5, 1], low = 0, high = 8}         mean and standard deviation; low and high cut it off (optional)
    {choice = ["outer", "inner"], weights = [3, 1]}   one of a list; weights are optional

Each is known by its quantile function, so that one number in [0, 1) gives one value whether that number comes from a
generator, a Latin hypercube or a Sobol sequence. To add one: write its class and add it to DISTRIBUTIONS.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from typing import Any, ClassVar

import numpy as np
from scipy.special import ndtr, ndtri

from datagen.recipes.spelling import suggestion

Value = float | int | str | bool
SMALLEST_PROBABILITY = 2.0**-54


class DistributionError(ValueError):
    """A distribution that is not written as it must be; the message says what is wrong."""


class Distribution(ABC):
    """A rule that turns a number in [0, 1) into a value; `keys` are its keys in a recipe, the first its name."""

    keys: ClassVar[tuple[str, ...]]

    @classmethod
    @abstractmethod
    def from_table(cls, table: Mapping[str, Any]) -> Distribution:
        """The distribution an inline table describes; raises DistributionError."""

    @classmethod
    @abstractmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        """JSON Schema of its inline table, `value` being the schema of one value."""

    @abstractmethod
    def quantile(self, probability: float) -> Any:
        """The value below which the share `probability` (0 ≤ p < 1) of all draws lies."""

    @abstractmethod
    def stated(self) -> tuple[Any, ...]:
        """The values a recipe states of it: these must be allowed for the setting."""

    @abstractmethod
    def to_toml(self) -> object:
        """The bare value or inline table that gives this distribution back."""

    def draw(self, generator: np.random.Generator) -> Any:
        """One value; takes exactly one number from `generator`."""
        return self.quantile(float(generator.random()))


@dataclass(frozen=True)
class Fixed(Distribution):
    """Always the same value."""

    value: Value
    keys: ClassVar[tuple[str, ...]] = ()

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Distribution:
        raise DistributionError("a fixed value is written bare")

    @classmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        return dict(value)

    def quantile(self, probability: float) -> Any:
        return self.value

    def stated(self) -> tuple[Any, ...]:
        return (self.value,)

    def to_toml(self) -> object:
        return self.value


@dataclass(frozen=True)
class _Range(Distribution):
    low: float
    high: float

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Distribution:
        low, high = _pair(cls.keys[0], table[cls.keys[0]])
        if low >= high:
            raise DistributionError(f"{cls.keys[0]} = [{low:g}, {high:g}]: the smaller number comes first")
        return cls(low, high)

    @classmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        return _object_schema({cls.keys[0]: _pair_schema(value)})

    def stated(self) -> tuple[float, ...]:
        return (self.low, self.high)

    def to_toml(self) -> object:
        return {self.keys[0]: [self.low, self.high]}


@dataclass(frozen=True)
class Uniform(_Range):
    """Equally likely from `low` to `high`."""

    keys: ClassVar[tuple[str, ...]] = ("uniform",)

    def quantile(self, probability: float) -> float:
        return min(self.low + probability * (self.high - self.low), self.high)


@dataclass(frozen=True)
class LogUniform(_Range):
    """Equally likely in the logarithm from `low` to `high`, both above zero."""

    keys: ClassVar[tuple[str, ...]] = ("log_uniform",)

    def __post_init__(self) -> None:
        if self.low <= 0.0:
            raise DistributionError(f"log_uniform = [{self.low:g}, {self.high:g}]: both numbers must be above 0")

    def quantile(self, probability: float) -> float:
        drawn = self.low * math.exp(probability * math.log(self.high / self.low))
        return min(max(drawn, self.low), self.high)


@dataclass(frozen=True)
class Normal(Distribution):
    """Gaussian with `mean` and `deviation`, cut off below `low` and above `high` (the rest keeps its shape)."""

    mean: float
    deviation: float
    low: float = -math.inf
    high: float = math.inf
    keys: ClassVar[tuple[str, ...]] = ("normal", "low", "high")

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Distribution:
        mean, deviation = _pair("normal", table["normal"])
        if deviation <= 0.0:
            raise DistributionError(f"normal = [{mean:g}, {deviation:g}]: the standard deviation must be above 0")
        low = _number("low", table["low"]) if "low" in table else -math.inf
        high = _number("high", table["high"]) if "high" in table else math.inf
        if low >= high:
            raise DistributionError(f"low = {low:g}, high = {high:g}: low must be below high")
        return cls(mean, deviation, low, high)

    def __post_init__(self) -> None:
        if self._share_above(self.low) - self._share_above(self.high) < 1e-6:
            raise DistributionError(
                f"normal = [{self.mean:g}, {self.deviation:g}]: less than one draw in a million lies from {self.low:g} "
                f"to {self.high:g}"
            )

    def within(self, low: float, high: float) -> Normal:
        """The same, cut off where it leaves `low` to `high`."""
        return Normal(self.mean, self.deviation, max(self.low, low), min(self.high, high))

    @classmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        number = {"type": "number"}
        return _object_schema({"normal": _pair_schema(number), "low": number, "high": number}, ["normal"])

    def _share_above(self, bound: float) -> float:
        return float(ndtr((self.mean - bound) / self.deviation))

    def quantile(self, probability: float) -> float:
        above_low, above_high = self._share_above(self.low), self._share_above(self.high)
        above = above_low + probability * (above_high - above_low)
        drawn = self.mean - self.deviation * float(ndtri(min(max(above, SMALLEST_PROBABILITY), 1.0 - 2.0**-53)))
        return min(max(drawn, self.low), self.high)

    def stated(self) -> tuple[float, ...]:
        bounds = tuple(bound for bound in (self.low, self.high) if math.isfinite(bound))
        return bounds if len(bounds) == 2 else (*bounds, self.mean)

    def to_toml(self) -> object:
        bounds = {"low": self.low, "high": self.high}
        return {"normal": [self.mean, self.deviation]} | {k: v for k, v in bounds.items() if math.isfinite(v)}


@dataclass(frozen=True)
class Choice(Distribution):
    """One of `options`, each with its share of the summed `weights` (equal when there are none)."""

    options: tuple[Value, ...]
    weights: tuple[float, ...] = ()
    keys: ClassVar[tuple[str, ...]] = ("choice", "weights")

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Distribution:
        options, weights = table["choice"], table.get("weights", [])
        if not isinstance(options, list | tuple) or not options:
            raise DistributionError(f"choice = {options!r}: give a list with at least one value")
        if any(isinstance(option, list | dict) for option in options):
            raise DistributionError(f"choice = {options!r}: give plain values")
        if not isinstance(weights, list | tuple):
            raise DistributionError(f"weights = {weights!r}: give a list of numbers")
        if weights and len(weights) != len(options):
            raise DistributionError(
                f"choice has {len(options)} values and weights {len(weights)}: give one weight each"
            )
        numbers = tuple(_number("weights", weight) for weight in weights)
        if numbers and (min(numbers) < 0.0 or sum(numbers) <= 0.0):
            raise DistributionError(f"weights = {list(weights)!r}: none may be below 0 and their sum must be above 0")
        return cls(tuple(options), numbers)

    @classmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        weights = {"type": "array", "items": {"type": "number", "minimum": 0}}
        options = {"type": "array", "items": dict(value), "minItems": 1}
        return _object_schema({"choice": options, "weights": weights}, ["choice"])

    def quantile(self, probability: float) -> Any:
        shares = list(accumulate(self.weights or (1.0,) * len(self.options)))
        place = bisect_right(shares, probability * shares[-1])
        return self.options[min(place, max(k for k, w in enumerate(self.weights or shares) if w > 0.0))]

    def stated(self) -> tuple[Any, ...]:
        return self.options

    def to_toml(self) -> object:
        weights = {"weights": list(self.weights)} if self.weights else {}
        return {"choice": list(self.options)} | weights


DISTRIBUTIONS: tuple[type[Distribution], ...] = (Uniform, LogUniform, Normal, Choice)
NAMES = tuple(kind.keys[0] for kind in DISTRIBUTIONS)


def parse_distribution(value: object) -> Distribution:
    """The distribution a recipe's bare value or inline table stands for; raises DistributionError."""
    if not isinstance(value, Mapping):
        return Fixed(_plain(value))
    kinds = [kind for kind in DISTRIBUTIONS if kind.keys[0] in value]
    if len(kinds) != 1:
        hint = suggestion(str(next(iter(value), "")), NAMES) if not kinds else ""
        raise DistributionError(f"keys {list(value)}: give one of {', '.join(NAMES)}{hint}")
    allowed = kinds[0].keys
    for key in value:
        if key not in allowed:
            hint = suggestion(str(key), allowed)
            raise DistributionError(f'unknown key "{key}"; allowed: {", ".join(allowed)}{hint}')
    return kinds[0].from_table(value)


def distribution_schema(value: Mapping[str, Any]) -> dict[str, Any]:
    """JSON Schema of a setting: a bare value of schema `value` or any of the inline tables that can hold it."""
    kinds = DISTRIBUTIONS if value.get("type") == "number" else (Choice,)
    return {"anyOf": [dict(value), *(kind.table_schema(value) for kind in kinds)]}


def _plain(value: object) -> Value:
    if isinstance(value, bool | str | int):
        return value
    if isinstance(value, float) and math.isfinite(value):
        return value
    raise DistributionError(f"{value!r} is neither a finite number nor a word nor a distribution ({', '.join(NAMES)})")


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise DistributionError(f"{name} = {value!r}: give a finite number")
    return float(value)


def _pair(name: str, value: object) -> tuple[float, float]:
    if not isinstance(value, list | tuple) or len(value) != 2:
        raise DistributionError(f"{name} = {value!r}: give a list of two numbers")
    return _number(name, value[0]), _number(name, value[1])


def _pair_schema(value: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": dict(value), "minItems": 2, "maxItems": 2}


def _object_schema(properties: dict[str, Any], required: list[str] | None = None) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": required or list(properties),
        "additionalProperties": False,
    }
