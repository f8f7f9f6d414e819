"""What the estimator learned from simulated machines: which pair are the events, and what their lag stands for."""

from __future__ import annotations

import math
from dataclasses import dataclass
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

    def correction(self, row: Array) -> tuple[float, float]:
        """Factor that corrects the quantity which one `row` (F,) describes, and the factor of its 90 % interval.

        In 90 % of the training cases the truth lay between the corrected quantity divided by the second and times it.
        """
        centre = float(self.centre.predict(row[None])[0])
        spread = max(float(self.spread.predict(row[None])[0]), 0.0) + SMALLEST_SPREAD
        return math.exp(centre), math.exp(self.reach * spread)

    def to_arrays(self, name: str) -> Arrays:
        """Everything by keys that begin with `name`, for a file of arrays."""
        trees = self.centre.to_arrays(f"{name}.centre") | self.spread.to_arrays(f"{name}.spread")
        return trees | {f"{name}.reach": np.array(self.reach)}

    @classmethod
    def from_arrays(cls, arrays: Arrays, name: str) -> Guess:
        """The guess that gave these arrays; KeyError if they are not there."""
        centre, spread = (Trees.from_arrays(arrays, f"{name}.{part}") for part in ("centre", "spread"))
        return cls(centre, spread, float(arrays[f"{name}.reach"]))


@dataclass(frozen=True)
class Judgement:
    """`rank` of a leading pair (0 to 1); `lag` and `arc` guesses from the pair of the best rank; `doubt`: the relative
    error to be expected of its lag, 3 standing for no events at all; above `most` no size is told."""

    rank: Trees
    lag: Guess
    arc: Guess
    doubt: Trees
    most: float

    def to_arrays(self, name: str) -> Arrays:
        """Everything by keys that begin with `name`, for a file of arrays."""
        arrays = self.rank.to_arrays(f"{name}.rank") | self.doubt.to_arrays(f"{name}.doubt")
        arrays |= self.lag.to_arrays(f"{name}.lag") | self.arc.to_arrays(f"{name}.arc")
        return arrays | {f"{name}.most": np.array(self.most)}

    @classmethod
    def from_arrays(cls, arrays: Arrays, name: str) -> Judgement:
        """The judgement that gave these arrays; KeyError if they are not there."""
        rank, doubt = (Trees.from_arrays(arrays, f"{name}.{part}") for part in ("rank", "doubt"))
        lag, arc = (Guess.from_arrays(arrays, f"{name}.{part}") for part in ("lag", "arc"))
        return cls(rank, lag, arc, doubt, float(arrays[f"{name}.most"]))


@dataclass(frozen=True)
class Calibration:
    """`pair_score` of a pair of candidates (0 to 1), by which the leading pairs are chosen; how those are judged
    `blind`, and `with_load` and Hertz factor."""

    pair_score: Trees
    blind: Judgement
    with_load: Judgement

    def to_arrays(self) -> Arrays:
        """Everything as named arrays, for a file."""
        judged = self.blind.to_arrays("blind") | self.with_load.to_arrays("with_load")
        return self.pair_score.to_arrays("pair_score") | judged

    @classmethod
    def from_arrays(cls, arrays: Arrays) -> Calibration:
        """The calibration that gave these arrays; KeyError if one is missing."""
        judged = (Judgement.from_arrays(arrays, name) for name in ("blind", "with_load"))
        return cls(Trees.from_arrays(arrays, "pair_score"), *judged)
