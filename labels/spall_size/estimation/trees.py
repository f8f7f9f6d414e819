"""Sums of regression trees, kept as plain arrays so that they depend on no library's file format."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Array
from physics.compiled import njit

FIELDS = ("feature", "threshold", "left", "right", "value", "root")


@dataclass(frozen=True)
class Trees:
    """Nodes (N,) of all trees, `root` (M,) the first node of each.

    A row goes `left` where its `feature` is at most `threshold`, else `right`; `feature` is −1 at a leaf, whose `value`
    is added to `base`.
    """

    feature: NDArray[np.int16]
    threshold: NDArray[np.float32]
    left: NDArray[np.int32]
    right: NDArray[np.int32]
    value: NDArray[np.float32]
    root: NDArray[np.int32]
    base: float

    def predict(self, rows: Array) -> Array:
        """Sums (P,) for `rows` (P, F); ValueError if they have too few columns."""
        needed = int(self.feature.max(initial=-1)) + 1
        if rows.shape[1] < needed:
            raise ValueError(f"rows have {rows.shape[1]} columns; the trees need {needed}")
        single = np.ascontiguousarray(rows, dtype=np.float32)
        return self.base + _sums(single, self.feature, self.threshold, self.left, self.right, self.value, self.root)

    def to_arrays(self, name: str) -> dict[str, NDArray[Any]]:
        """Everything by keys that begin with `name`, for a file of arrays."""
        return {f"{name}.{field}": getattr(self, field) for field in FIELDS} | {f"{name}.base": np.array(self.base)}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]], name: str) -> Trees:
        """The trees that gave these arrays; KeyError if they are not there."""
        held: dict[str, Any] = {field: np.ascontiguousarray(arrays[f"{name}.{field}"]) for field in FIELDS}
        return cls(**held, base=float(arrays[f"{name}.base"]))


@njit
def _sums(
    rows: NDArray[np.float32],
    feature: NDArray[np.int16],
    threshold: NDArray[np.float32],
    left: NDArray[np.int32],
    right: NDArray[np.int32],
    value: NDArray[np.float32],
    root: NDArray[np.int32],
) -> Array:
    total = np.zeros(rows.shape[0])
    for k in range(rows.shape[0]):
        for first in root:
            node = first
            while feature[node] >= 0:
                node = left[node] if rows[k, feature[node]] <= threshold[node] else right[node]
            total[k] += value[node]
    return total
