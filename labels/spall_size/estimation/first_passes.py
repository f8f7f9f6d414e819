"""How much of a record an estimate looks at."""

from __future__ import annotations

import math

from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import MOST_PASSES
from physics.arrays import Array


def first_passes(signal: Array, rate: float, situation: Situation) -> Array:
    """The first MOST_PASSES, on the race with the longer time between them, of a `signal` (T,) at `rate` (Hz).

    More would take memory and time and make no estimate nearer.
    """
    return signal[: math.ceil(MOST_PASSES * max(situation.pass_periods().values()) * rate)]
