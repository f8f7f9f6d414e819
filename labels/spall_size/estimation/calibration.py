"""What the estimator learned from simulated machines: which pair are the events, and what their lag stands for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from labels.spall_size.columns.table import (
    LEADING_COLUMNS,
    LEADING_COLUMNS_WITH_LOAD,
    PAIR_COLUMNS,
    ROW_COLUMNS,
    ROW_COLUMNS_WITH_LOAD,
)
from labels.spall_size.estimation.trees import Trees
from physics.arrays import Array

Arrays = dict[str, NDArray[Any]]
# Typical error (logarithm) that is added to what the trees say, so that no interval vanishes.
SMALLEST_SPREAD = 0.01
# The columns that each model uses, by the name under which its arrays are kept.
FITTED_ON: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"pair_score": PAIR_COLUMNS, "blind.rank": LEADING_COLUMNS, "with_load.rank": LEADING_COLUMNS_WITH_LOAD}
    | {f"blind.{model}": ROW_COLUMNS for model in ("lag", "arc", "doubt")}
    | {f"with_load.{model}": ROW_COLUMNS_WITH_LOAD for model in ("lag", "arc", "doubt")}
)


class MisfitCalibration(ValueError):
    """A calibration that was fitted to other columns than are computed now, or does not say to which."""


@dataclass(frozen=True)
class Guess:
    """A logarithmic correction and its typical error, each a sum of trees; 90 % of the errors on unseen machines were
    below `reach` times the typical error.

    These errors are of records of the first corpus of the fit, as stored (neither cut short nor with other noise), to
    which a size was given.
    """

    centre: Trees
    spread: Trees
    reach: float

    def correction(self, row: Array) -> tuple[float, float]:
        """Factor that corrects the quantity described by one `row` (F,), and the factor of its 90 % interval: from the
        corrected quantity divided by the second factor to the corrected quantity times it.
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
    error to be expected of its lag, 3 standing for no events at all; above `most` no size is given."""

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
    `blind`, and `with_load` and Hertz factor; `origin` says in words from what it was fitted, empty if that is not
    given."""

    pair_score: Trees
    blind: Judgement
    with_load: Judgement
    origin: str = ""

    def to_arrays(self) -> Arrays:
        """Everything as named arrays, for a file, with the names of the columns that each model was fitted on."""
        judged = self.blind.to_arrays("blind") | self.with_load.to_arrays("with_load")
        columns = {f"{model}.columns": np.array(names) for model, names in FITTED_ON.items()}
        return self.pair_score.to_arrays("pair_score") | judged | columns | {"origin": np.array(self.origin)}

    @classmethod
    def from_arrays(cls, arrays: Arrays) -> Calibration:
        """The calibration that gave these arrays.

        Raises MisfitCalibration if a model was fitted on other columns than FITTED_ON, or if that is not said, and
        KeyError if an array is missing.
        """
        for model, names in FITTED_ON.items():
            _require_columns(model, arrays.get(f"{model}.columns"), names)
        blind, with_load = (Judgement.from_arrays(arrays, name) for name in ("blind", "with_load"))
        return cls(Trees.from_arrays(arrays, "pair_score"), blind, with_load, str(arrays["origin"]))


def _require_columns(model: str, fitted: NDArray[Any] | None, names: tuple[str, ...]) -> None:
    """Raise MisfitCalibration unless `model` was `fitted` on columns of these `names`, in their order."""
    if fitted is None:
        raise MisfitCalibration(f"the calibration does not say on which columns {model} was fitted")
    if fitted.shape != (len(names),):
        raise MisfitCalibration(f"{model} was fitted on {fitted.size} columns, and there are {len(names)} now")
    for place, (old, new) in enumerate(zip(fitted.tolist(), names, strict=True)):
        if old != new:
            raise MisfitCalibration(f'column {place} of {model} was "{old}" when it was fitted, and is "{new}" now')
