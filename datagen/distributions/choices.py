"""Distributions over a list of values: drawn freely, or by turns so that every block of draws has exact counts."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate
from typing import Any, ClassVar

import numpy as np

from datagen.distributions.distribution import DistributionError, Drawn, Value, number, object_schema
from datagen.errors import value_text

LONGEST_BLOCK = 1000


@dataclass(frozen=True)
class Choice(Drawn):
    """One of `options`, each with its share of the summed `weights` (equal when there are none)."""

    options: tuple[Value, ...]
    weights: tuple[float, ...] = ()
    keys: ClassVar[tuple[str, ...]] = ("choice", "weights")
    weight_type: ClassVar[str] = "number"

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Choice:
        name = cls.keys[0]
        options, weights = table[name], table.get("weights", [])
        if not isinstance(options, list | tuple) or not options:
            raise DistributionError(f"{name} = {value_text(options)}: give a list with at least one value")
        if any(isinstance(option, list | dict) for option in options):
            raise DistributionError(f"{name} = {value_text(options)}: give plain values")
        if not isinstance(weights, list | tuple):
            raise DistributionError(f"weights = {value_text(weights)}: give a list of numbers")
        if weights and len(weights) != len(options):
            raise DistributionError(
                f"{name} has {len(options)} values and weights {len(weights)}: give one weight each"
            )
        numbers = tuple(number("weights", weight) for weight in weights)
        if numbers and (min(numbers) < 0.0 or sum(numbers) <= 0.0):
            raise DistributionError(
                f"weights = {value_text(weights)}: none may be below 0 and their sum must be above 0"
            )
        if not math.isfinite(sum(numbers)):
            raise DistributionError(f"weights = {value_text(weights)}: their sum is too large a number")
        return cls(tuple(options), numbers)

    @classmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        weights = {"type": "array", "items": {"type": cls.weight_type, "minimum": 0}}
        options = {"type": "array", "items": dict(value), "minItems": 1}
        return object_schema({cls.keys[0]: options, "weights": weights}, [cls.keys[0]])

    def quantile(self, probability: float) -> Any:
        shares = list(accumulate(self.weights or (1.0,) * len(self.options)))
        place = bisect_right(shares, probability * shares[-1])
        return self.options[min(place, max(k for k, w in enumerate(self.weights or shares) if w > 0.0))]

    def stated(self) -> tuple[Any, ...]:
        return self.options

    def to_toml(self) -> object:
        weights = {"weights": list(self.weights)} if self.weights else {}
        return {self.keys[0]: list(self.options)} | weights


@dataclass(frozen=True)
class Balanced(Choice):
    """The `options` by turns: each block of draws holds every option exactly as often as its whole `weights` say.

    A draw without a place in a block (`quantile`) is that of a choice with these weights.
    """

    keys: ClassVar[tuple[str, ...]] = ("balanced", "weights")
    weight_type: ClassVar[str] = "integer"

    def __post_init__(self) -> None:
        if any(weight != round(weight) for weight in self.weights):
            raise DistributionError(f"weights = {value_text(self.weights)}: balanced takes whole numbers")
        if self.block > LONGEST_BLOCK:
            raise DistributionError(f"weights add up to {self.block}: balanced takes at most {LONGEST_BLOCK}")

    @cached_property
    def counts(self) -> tuple[int, ...]:
        """How often each option comes in a block."""
        return tuple(round(weight) for weight in self.weights) or (1,) * len(self.options)

    @property
    def block(self) -> int:
        """Number of draws in a block."""
        return sum(self.counts)

    def shuffled(self, generator: np.random.Generator) -> list[int]:
        """The places in `options` that the draws of one block take, in the order that `generator` gives them."""
        return [int(place) for place in generator.permutation(np.repeat(np.arange(len(self.counts)), self.counts))]
