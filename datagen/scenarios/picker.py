"""Values for the settings of one table, in order, each from one number in [0, 1)."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from datagen.distributions.kinds import Balanced, Distribution, Fixed
from datagen.scenarios.turns import Turns

DEGREES_PER_RADIAN = math.degrees(1.0)
Refine = Callable[[int, float], float]


class Picker:
    """Draws one setting after another; each uses up exactly one number, whatever its distribution and even if absent.

    So fixing a setting that was drawn changes no other, and a table may grow at its end without changing what was
    there. `open_stream` gives the generator of the numbers, asked for when the first of them counts; `refine` turns the
    number at a position (from 0) into that of a design; `turns` gives balanced settings their value.
    """

    def __init__(self, open_stream: Callable[[], np.random.Generator], refine: Refine, turns: Turns) -> None:
        self._open_stream = open_stream
        self._refine = refine
        self._turns = turns
        self._position = -1
        self._passed_over = 0

    @cached_property
    def _generator(self) -> np.random.Generator:
        return self._open_stream()

    def value(self, setting: Distribution | None) -> Any:
        """A value in the setting's own unit, or None where the setting is not given."""
        if setting is None or isinstance(setting, Fixed):
            self._pass_over()
            return None if setting is None else setting.value
        if isinstance(setting, Balanced):
            self._pass_over()
            return self._turns.take(setting)
        return setting.quantile(self.share())

    def _pass_over(self) -> None:
        """Skip the next number; it is taken from the generator only with the first after it that counts."""
        self._position += 1
        self._passed_over += 1

    def share(self) -> float:
        """The number itself, in [0, 1)."""
        self._position += 1
        if self._passed_over:
            self._generator.random(self._passed_over)
            self._passed_over = 0
        return self._refine(self._position, self._generator.random())

    def number(self, setting: Distribution, per_unit: float = 1.0) -> float:
        """A number, divided by `per_unit` (how many of the setting's units make one SI unit)."""
        return float(self.value(setting)) / per_unit

    def optional(self, setting: Distribution | None) -> float | None:
        """A number in the setting's own unit, or None where the setting is not given."""
        value = self.value(setting)
        return None if value is None else float(value)

    def word(self, setting: Distribution) -> str:
        """A word."""
        return str(self.value(setting))

    def whole(self, setting: Distribution | None) -> int | None:
        """A whole number, or None where the setting is not given."""
        value = self.value(setting)
        return None if value is None else int(value)
