"""Changes of contact read from who touches at each sample."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from physics.trace import ContactChanges


def changes_between_samples(touching: NDArray[np.bool_], rate: float) -> ContactChanges:
    """Changes of contact from `touching` (T, rows, balls) at the instants k / rate, half-way between two samples."""
    sample, row, ball = np.nonzero(touching[1:] != touching[:-1])
    return ContactChanges(
        time=np.asarray((sample + 0.5) / rate, dtype=np.float64),
        row=(row + 1).astype(np.int16),
        ball=(ball + 1).astype(np.int16),
        made=touching[sample + 1, row, ball],
        initial=touching[0].copy(),
    )
