"""A signal cut into turns of the shaft, over which everything that a running machine does is about the same."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from physics.arrays import Array, Index

# In fewer turns of the shaft nothing says what is usual.
FEWEST_TURNS = 8
FEWEST_SAMPLES_A_TURN = 16


class WholeTurns(NamedTuple):
    """A signal in B parts of about a turn each, which begin and end at the samples `edges` (B + 1,)."""

    parts: list[Array]
    edges: Index

    @property
    def spread(self) -> float:
        """The usual standard deviation within a turn."""
        return float(np.median([part.std() for part in self.parts]))

    @property
    def length(self) -> float:
        """Samples in a turn."""
        return float(self.edges[-1] / len(self.parts))


def whole_turns(signal: Array, turns: float) -> WholeTurns | None:
    """The turns of a signal (T,) in which the shaft makes so many; None where that is fewer than FEWEST_TURNS. A part
    is longer than a turn where that would have fewer than FEWEST_SAMPLES_A_TURN samples."""
    count = min(int(turns), signal.size // FEWEST_SAMPLES_A_TURN)
    if count < FEWEST_TURNS:
        return None
    edges = np.arange(count + 1) * signal.size // count
    return WholeTurns(np.split(signal, edges[1:-1]), edges)
