"""The table that classifiers learn from and judge, and where each of its rows came from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Flags


@dataclass(frozen=True)
class Rows:
    """Rows (N, F) of a `table`, of features or of raw windows, and what they are of.

    `record` (N,) is the record of each row and `axis` (N,) which of its axes; `noisy` (N,) marks the rows that had
    noise added to learn from.
    """

    table: NDArray[Any]
    record: NDArray[np.int64]
    axis: NDArray[np.int64]
    noisy: Flags

    def __len__(self) -> int:
        return len(self.record)

    def __getitem__(self, chosen: NDArray[Any] | slice) -> Rows:
        """The rows that are `chosen` by flags (N,), by places or as a stretch."""
        return Rows(self.table[chosen], self.record[chosen], self.axis[chosen], self.noisy[chosen])


def joined(parts: Sequence[Rows]) -> Rows:
    """The rows of one or more parts, one part after another."""
    return Rows(
        np.concatenate([part.table for part in parts]),
        np.concatenate([part.record for part in parts]),
        np.concatenate([part.axis for part in parts]),
        np.concatenate([part.noisy for part in parts]),
    )
