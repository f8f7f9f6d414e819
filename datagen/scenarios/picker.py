"""Values for the settings of one table, in order, each from one number in [0, 1)."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from datagen.recipes.distributions import Balanced, Distribution, Fixed
from datagen.scenarios.turns import Turns

DEGREES_PER_RADIAN = math.degrees(1.0)
Refine = Callable[[int, float], float]


def unrefined(position: int, number: float) -> float:
    """The number as it comes."""
    return number


class Picker:
    """Draws setting after setting; each takes exactly one number, whatever its distribution and even if it is absent.

    So fixing a setting that was drawn moves no other, and a table may grow at its end without moving what was there.
    `refine` turns the number at a position (from 0) into that of a design; `turns` gives balanced settings their value.
    """

    def __init__(
        self, next_number: Callable[[], float], refine: Refine = unrefined, turns: Turns | None = None
    ) -> None:
        self._next_number = next_number
        self._refine = refine
        self._turns = turns
        self._position = -1

    @classmethod
    def of(cls, generator: np.random.Generator) -> Picker:
        """A picker fed by a generator."""
        return cls(generator.random)

    def value(self, setting: Distribution | None) -> Any:
        """A value in the setting's own unit, or None where the setting is not given."""
        number = float(self._next_number())
        self._position += 1
        if setting is None or isinstance(setting, Fixed):
            return None if setting is None else setting.value
        if isinstance(setting, Balanced) and self._turns is not None:
            return self._turns.take(setting)
        return setting.quantile(self._refine(self._position, number))

    def share(self) -> float:
        """The number itself, in [0, 1)."""
        number = float(self._next_number())
        self._position += 1
        return self._refine(self._position, number)

    def number(self, setting: Distribution, per_unit: float = 1.0) -> float:
        """A number, divided by `per_unit` (how many of the setting's units make one SI unit)."""
        return float(self.value(setting)) / per_unit

    def optional(self, setting: Distribution | None, per_unit: float = 1.0) -> float | None:
        """A number as above, or None where the setting is not given."""
        value = self.value(setting)
        return None if value is None else float(value) / per_unit

    def word(self, setting: Distribution) -> str:
        """A word."""
        return str(self.value(setting))

    def whole(self, setting: Distribution | None) -> int | None:
        """A whole number, or None where the setting is not given."""
        value = self.value(setting)
        return None if value is None else int(value)
