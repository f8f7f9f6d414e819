"""A stretch of somebody's recording of a healthy machine."""

from __future__ import annotations

import numpy as np

from physics.checks import require


def draw_starts(generator: np.random.Generator, recording_samples: int, samples: int) -> tuple[int, int]:
    """First samples of two stretches of `samples`, equally likely anywhere in the recording: two whole numbers.

    InvalidParameter if the recording is too short: to repeat it would put a line at one over its length, which an
    envelope spectrum shows as if it were a fault.
    """
    require(
        recording_samples >= samples,
        f"the recording holds {recording_samples} samples; a record needs {samples}",
        "recording",
    )
    first, second = generator.integers(0, recording_samples - samples, size=2, endpoint=True)
    return int(first), int(second)
