"""Distributions a recipe can name: a bare value is fixed, an inline table with the distribution's name is drawn.

    5.0                                          fixed
    {uniform = [2, 8]}                           equally likely between two numbers
    {log_uniform = [0.1, 10]}                    equally likely in the logarithm
    {normal = [5, 1], low = 0, high = 8}         mean and standard deviation; low and high cut it off (optional)
    {choice = ["outer", "inner"], weights = [3, 1]}   one of a list; weights are optional
    {balanced = ["outer", "inner"], weights = [3, 1]}   by turns: of every 4 draws exactly 3 and 1, in random order

Each is known by its quantile function, so that one number in [0, 1) gives one value whether that number comes from a
generator, a Latin hypercube or a Sobol sequence. To add one: write its class and add it to DISTRIBUTIONS.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from datagen.distributions.choices import Balanced, Choice
from datagen.distributions.distribution import Distribution, DistributionError, Drawn, Fixed, Value
from datagen.distributions.ranges import LogUniform, Normal, Uniform
from datagen.errors import value_text
from physics.spelling import suggestion

__all__ = [
    "DISTRIBUTIONS",
    "NAMES",
    "Balanced",
    "Choice",
    "Distribution",
    "DistributionError",
    "Fixed",
    "LogUniform",
    "Normal",
    "Uniform",
    "distribution_schema",
    "parse_distribution",
]

DISTRIBUTIONS: tuple[type[Drawn], ...] = (Uniform, LogUniform, Normal, Choice, Balanced)
NAMES = tuple(kind.keys[0] for kind in DISTRIBUTIONS)


def parse_distribution(value: object) -> Distribution:
    """The distribution a recipe's bare value or inline table stands for; raises DistributionError."""
    if not isinstance(value, Mapping):
        return Fixed(_plain(value))
    kinds = [kind for kind in DISTRIBUTIONS if kind.keys[0] in value]
    if len(kinds) != 1:
        hint = suggestion(str(next(iter(value), "")), NAMES) if not kinds else ""
        keys = f"the keys {', '.join(map(str, value))} are" if value else "an empty table is"
        raise DistributionError(f"{keys} no distribution: give one of {', '.join(NAMES)}{hint}")
    allowed = kinds[0].keys
    for key in value:
        if key not in allowed:
            hint = suggestion(str(key), allowed)
            raise DistributionError(f'unknown key "{key}"; allowed: {", ".join(allowed)}{hint}')
    return kinds[0].from_table(value)


def distribution_schema(value: Mapping[str, Any]) -> dict[str, Any]:
    """JSON Schema of a setting: a bare value of schema `value` or any of the inline tables that can hold it."""
    kinds = DISTRIBUTIONS if value.get("type") == "number" else (Choice, Balanced)
    return {"anyOf": [dict(value), *(kind.table_schema(value) for kind in kinds)]}


def _plain(value: object) -> Value:
    if isinstance(value, bool | str | int):
        return value
    if isinstance(value, float) and math.isfinite(value):
        return value
    raise DistributionError(
        f"{value_text(value)} is neither a finite number nor a word nor a distribution ({', '.join(NAMES)})"
    )
