"""The stretch of a record that a picture shows enlarged."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class CloseUp(NamedTuple):
    """From `start` to `end` (s)."""

    start: float
    end: float

    def part(self, times: NDArray[np.float64]) -> slice:
        """The part of rising `times` (s) that lies in it."""
        first, last = np.searchsorted(times, self)
        return slice(int(first), int(last))
