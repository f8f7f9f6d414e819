"""Changes of contact read from who touches at each sample."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics.arrays import Flags
from physics.trace import ContactChanges


def changes_between_samples(touching: Flags, sample: NDArray[np.integer], rate: float) -> ContactChanges:
    """Changes of contact, half-way between two samples, from who is `touching` (S, rows, balls) from each `sample` (S,)
    on to the next: rising numbers, the first of them 0, at `rate` (Hz)."""
    change, row, ball = np.nonzero(touching[1:] != touching[:-1])
    return ContactChanges(
        time=np.asarray((sample[1:][change] - 0.5) / rate, dtype=np.float64),
        row=(row + 1).astype(np.int16),
        ball=(ball + 1).astype(np.int16),
        made=touching[change + 1, row, ball],
        initial=touching[0].copy(),
    )
