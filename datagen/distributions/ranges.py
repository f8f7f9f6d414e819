"""Distributions of numbers over a range: uniform, uniform in the logarithm, and normal, cut off or not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from scipy.special import ndtr, ndtri

from datagen.distributions.distribution import DistributionError, Drawn, number, object_schema, pair, pair_schema

SMALLEST_PROBABILITY = 2.0**-54


@dataclass(frozen=True)
class _Range(Drawn):
    low: float
    high: float

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> _Range:
        low, high = pair(cls.keys[0], table[cls.keys[0]])
        if low >= high:
            raise DistributionError(f"{cls.keys[0]} = [{low:g}, {high:g}]: the smaller number comes first")
        return cls(low, high)

    @classmethod
    def table_schema(cls, value: Mapping[str, Any]) -> dict[str, Any]:
        return object_schema({cls.keys[0]: pair_schema(value)})

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
class Normal(Drawn):
    """Gaussian with `mean` and `deviation`, cut off below `low` and above `high` (the rest keeps its shape)."""

    mean: float
    deviation: float
    low: float = -math.inf
    high: float = math.inf
    keys: ClassVar[tuple[str, ...]] = ("normal", "low", "high")

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Normal:
        mean, deviation = pair("normal", table["normal"])
        if deviation <= 0.0:
            raise DistributionError(f"normal = [{mean:g}, {deviation:g}]: the standard deviation must be above 0")
        low = number("low", table["low"]) if "low" in table else -math.inf
        high = number("high", table["high"]) if "high" in table else math.inf
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
        return object_schema({"normal": pair_schema(number), "low": number, "high": number}, ["normal"])

    def _share_above(self, bound: float) -> float:
        return float(ndtr((self.mean - bound) / self.deviation))

    def quantile(self, probability: float) -> float:
        above_low, above_high = self._share_above(self.low), self._share_above(self.high)
        above = above_low + probability * (above_high - above_low)
        drawn = self.mean - self.deviation * float(ndtri(min(max(above, SMALLEST_PROBABILITY), 1.0 - 2.0**-53)))
        return min(max(drawn, self.low), self.high)

    @property
    def lowest(self) -> float:
        """Where it is cut off, or the mean if that lies so far out that no draw comes near."""
        return self.low if self._share_above(self.low) < 1.0 - SMALLEST_PROBABILITY else self.mean

    @property
    def highest(self) -> float:
        """Where it is cut off, or the mean if that lies so far out that no draw comes near."""
        return self.high if self._share_above(self.high) > SMALLEST_PROBABILITY else self.mean

    def stated(self) -> tuple[float, ...]:
        bounds = tuple(bound for bound in (self.low, self.high) if math.isfinite(bound))
        return bounds if len(bounds) == 2 else (*bounds, self.mean)

    def to_toml(self) -> object:
        bounds = {"low": self.low, "high": self.high}
        return {"normal": [self.mean, self.deviation]} | {k: v for k, v in bounds.items() if math.isfinite(v)}
