"""What the estimator learned from simulated machines: which pair are the events, and what their lag stands for."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.trees import Trees

Array = NDArray[np.float64]
Arrays = dict[str, NDArray[Any]]
SMALLEST_SPREAD = 0.01


@dataclass(frozen=True)
class Guess:
    """A logarithmic correction and its typical error, each a sum of trees; 90 % of all errors lie within `reach` times
    the typical one."""

    centre: Trees
    spread: Trees
    reach: float

    def tell(self, row: Array) -> tuple[float, float]:
        """Correction factor of one `row` (F,) and the factor by which 90 % of all cases lie about it at most."""
        centre = float(self.centre.predict(row[None])[0])
        spread = max(float(self.spread.predict(row[None])[0]), 0.0) + SMALLEST_SPREAD
        return math.exp(centre), math.exp(self.reach * spread)


@dataclass(frozen=True)
class Calibration:
    """`pair_score` of a pair of candidates (0 to 1); `lag`, `arc` and `arc_with_load` guesses from the chosen pair;
    `trust` and `trust_with_load`: log odds that there are two events and the lag is right within 15 %; below `least`
    and `least_with_load` no size is told."""

    pair_score: Trees
    lag: Guess
    arc: Guess
    arc_with_load: Guess
    trust: Trees
    trust_with_load: Trees
    least: float
    least_with_load: float

    def to_arrays(self) -> Arrays:
        """Everything as named arrays, for a file."""
        arrays: Arrays = {}
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, Trees):
                arrays |= value.to_arrays(field.name)
            elif isinstance(value, Guess):
                arrays |= value.centre.to_arrays(f"{field.name}.centre") | value.spread.to_arrays(
                    f"{field.name}.spread"
                )
                arrays[f"{field.name}.reach"] = np.array(value.reach)
            else:
                arrays[field.name] = np.array(value)
        return arrays

    @classmethod
    def from_arrays(cls, arrays: Arrays) -> Calibration:
        """The calibration that gave these arrays; KeyError if one is missing."""

        def guess(name: str) -> Guess:
            centre, spread = (Trees.from_arrays(arrays, f"{name}.{part}") for part in ("centre", "spread"))
            return Guess(centre, spread, float(arrays[f"{name}.reach"]))

        return cls(
            Trees.from_arrays(arrays, "pair_score"),
            guess("lag"),
            guess("arc"),
            guess("arc_with_load"),
            Trees.from_arrays(arrays, "trust"),
            Trees.from_arrays(arrays, "trust_with_load"),
            float(arrays["least"]),
            float(arrays["least_with_load"]),
        )
