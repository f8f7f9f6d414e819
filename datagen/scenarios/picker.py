"""Values for the settings of one table, in order, each from one number in [0, 1)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from datagen.recipes.distributions import Distribution


class Picker:
    """Draws setting after setting; each takes exactly one number, whatever its distribution and even if it is absent.

    So fixing a setting that was drawn moves no other, and a table may grow at its end without moving what was there.
    """

    def __init__(self, next_number: Callable[[], float]) -> None:
        self._next_number = next_number

    @classmethod
    def of(cls, generator: np.random.Generator) -> Picker:
        """A picker fed by a generator."""
        return cls(generator.random)

    def number(self, setting: Distribution, per_unit: float = 1.0) -> float:
        """A number, divided by `per_unit` (how many of the setting's units make one SI unit)."""
        return float(setting.quantile(self._next_number())) / per_unit

    def optional(self, setting: Distribution | None, per_unit: float = 1.0) -> float | None:
        """A number as above, or None where the setting is not given."""
        probability = self._next_number()
        return None if setting is None else float(setting.quantile(probability)) / per_unit

    def word(self, setting: Distribution) -> str:
        """A word."""
        return str(setting.quantile(self._next_number()))

    def whole(self, setting: Distribution | None) -> int | None:
        """A whole number, or None where the setting is not given."""
        probability = self._next_number()
        return None if setting is None else int(setting.quantile(probability))
