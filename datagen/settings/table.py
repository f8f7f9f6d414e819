"""Kinds of setting in a recipe: numbers, whole numbers and words, each fixed or drawn, each with what is allowed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Annotated, Any
from unicodedata import category

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from datagen.distributions.kinds import (
    Choice,
    Distribution,
    DistributionError,
    Fixed,
    Normal,
    distribution_schema,
    parse_distribution,
)
from physics.spelling import suggestion


class Table(BaseModel):
    """A table of a recipe: unknown keys are refused and nothing changes after reading."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class _Setting:
    """Annotation of a `Distribution` field: says which stated values are allowed, to pydantic and to JSON Schema."""

    def allowed(self) -> str:
        """What is allowed, in words."""
        raise NotImplementedError

    def accepts(self, value: Any) -> bool:
        """True if a stated value is allowed."""
        raise NotImplementedError

    def normal_form(self, distribution: Distribution) -> Distribution:
        """The distribution as it is kept; raises DistributionError if its kind is not allowed."""
        return distribution

    def confined(self, distribution: Distribution) -> Distribution:
        """The distribution without its tails where these are not allowed."""
        return distribution

    def value_schema(self) -> dict[str, Any]:
        """JSON Schema of one value."""
        raise NotImplementedError

    def parse(self, value: object) -> Distribution:
        """The checked distribution of what a recipe says; raises PydanticCustomError."""
        if isinstance(value, Distribution):
            return value
        try:
            distribution = self.normal_form(parse_distribution(value))
            for stated in distribution.stated():
                if not self.accepts(stated):
                    raise PydanticCustomError("allowed", "allowed: {allowed}", {"allowed": self._hint(stated)})
            return self.confined(distribution)
        except DistributionError as error:
            words = {"problem": str(error), "allowed": self.allowed()}
            raise PydanticCustomError("distribution", "{problem}", words) from None

    def _hint(self, value: object) -> str:
        return self.allowed()

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        write: Callable[[Distribution], object] = lambda distribution: distribution.to_toml()  # noqa: E731
        return core_schema.no_info_plain_validator_function(
            self.parse, serialization=core_schema.plain_serializer_function_ser_schema(write)
        )

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"setting": self.allowed()} | distribution_schema(self.value_schema())


@dataclass(frozen=True)
class Between(_Setting):
    """A number from `low` to `high`, or any if neither is given; `above` excludes `low` itself. A normal distribution
    is cut off there."""

    low: float = -math.inf
    high: float = math.inf
    above: bool = False

    def allowed(self) -> str:
        if self == Between():
            return "a number"
        return f"a number {'above' if self.above else 'from'} {self.low:g} to {self.high:g}"

    def accepts(self, value: Any) -> bool:
        if isinstance(value, bool) or not isinstance(value, int | float):
            return False
        return self.low <= value <= self.high and not (self.above and value == self.low)

    def normal_form(self, distribution: Distribution) -> Distribution:
        if isinstance(distribution, Fixed) and type(distribution.value) is int:
            return Fixed(float(distribution.value))
        if isinstance(distribution, Choice):
            options = tuple(float(v) if type(v) is int else v for v in distribution.options)
            return replace(distribution, options=options)
        return distribution

    def confined(self, distribution: Distribution) -> Distribution:
        return distribution.within(self.low, self.high) if isinstance(distribution, Normal) else distribution

    def value_schema(self) -> dict[str, Any]:
        ends = {"exclusiveMinimum" if self.above else "minimum": self.low, "maximum": self.high}
        return {"type": "number"} | {name: end for name, end in ends.items() if math.isfinite(end)}


@dataclass(frozen=True)
class Angle(Between):
    """An angle in degrees, of so few turns that enough decimals remain; a normal distribution of them has its tails."""

    low: float = -1e6
    high: float = 1e6

    def confined(self, distribution: Distribution) -> Distribution:
        if isinstance(distribution, Normal) and distribution.deviation > self.high:
            raise DistributionError(
                f"normal = [{distribution.mean:g}, {distribution.deviation:g}]: the standard deviation must be at most "
                f"{self.high:g}"
            )
        return distribution


@dataclass(frozen=True)
class Whole(_Setting):
    """A whole number from `low` to `high`, fixed or chosen from a list."""

    low: int
    high: int

    def allowed(self) -> str:
        return f"a whole number from {self.low} to {self.high}"

    def accepts(self, value: Any) -> bool:
        return type(value) is int and self.low <= value <= self.high

    def normal_form(self, distribution: Distribution) -> Distribution:
        if not isinstance(distribution, Fixed | Choice):
            raise DistributionError("a whole number is fixed or drawn by choice or balanced")
        return distribution

    def value_schema(self) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.low, "maximum": self.high}


@dataclass(frozen=True)
class OneOf(_Setting):
    """One of a closed list of words (or small numbers), fixed or chosen from several."""

    options: tuple[str | int | bool, ...]

    def allowed(self) -> str:
        return ", ".join(str(option).lower() if isinstance(option, bool) else str(option) for option in self.options)

    def accepts(self, value: Any) -> bool:
        return any(type(option) is type(value) and option == value for option in self.options)

    def normal_form(self, distribution: Distribution) -> Distribution:
        if not isinstance(distribution, Fixed | Choice):
            raise DistributionError("a word is fixed or drawn by choice or balanced")
        return distribution

    def _hint(self, value: object) -> str:
        bare = [str(option).lower() for option in self.options if not isinstance(option, str)]
        if isinstance(value, str) and value.lower() in bare:
            return f"{self.allowed()}; did you mean {value.lower()}, without quotes?"
        return self.allowed() + suggestion(str(value), [option for option in self.options if isinstance(option, str)])

    def value_schema(self) -> dict[str, Any]:
        return {"enum": list(self.options)}


def possible_words(distribution: Distribution) -> tuple[Any, ...]:
    """Every value a word setting can take (of weight above zero)."""
    return tuple(shares_of_words(distribution))


def shares_of_words(distribution: Distribution) -> dict[Any, float]:
    """The share of draws that each value of a word setting takes, of those that it can take."""
    stated = distribution.stated()
    weights = getattr(distribution, "weights", ()) or (1.0,) * len(stated)
    shares: dict[Any, float] = {}
    for value, weight in zip(stated, weights, strict=True):
        if weight > 0.0:
            shares[value] = shares.get(value, 0.0) + weight / sum(weights)
    return shares


def refuse(problem: str, field: str = "", allowed: str = "") -> PydanticCustomError:
    """The error of a table whose settings do not go together; `field` names the one to point at."""
    return PydanticCustomError("settings", "{problem}", {"problem": problem, "field": field, "allowed": allowed})


def prose(text: str) -> str:
    """The `text`; raises PydanticCustomError if it holds signs that steer a terminal, which files and pages would show
    each in its own way."""
    sign = next((sign for sign in text if category(sign) == "Cc" and sign not in "\n\t"), None)
    if sign is not None:
        raise refuse(f"holds the control character U+{ord(sign):04X}", allowed="text without control characters")
    return text


Prose = Annotated[str, AfterValidator(prose)]
# A word that needs no quotes anywhere.
CorpusName = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", max_length=60)]
PartName = Annotated[str, Field(min_length=1, max_length=80), AfterValidator(prose)]


def rising(orders: tuple[int, int]) -> tuple[int, int]:
    """The `orders`; raises PydanticCustomError unless the first comes first."""
    if orders[0] > orders[1]:
        raise refuse("the first order comes first", allowed="[first order, last order]")
    return orders


def named_differently(tables: Iterable[Any], setting: str) -> None:
    """Raise PydanticCustomError if two of the `tables` of a `setting` have the same `name`."""
    names = [table.name for table in tables]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise refuse(f'two {setting}s are called "{twice}"', setting, f"a different name for each {setting}")


def at_most_one(table: BaseModel, *fields: str) -> None:
    """Raise PydanticCustomError if more than one of these settings is given."""
    given = [field for field in fields if getattr(table, field) is not None]
    if len(given) > 1:
        raise refuse(f"{' and '.join(given)} set the same thing twice", given[1], f"only one of {', '.join(fields)}")
