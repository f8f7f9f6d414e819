"""A response of which a part alone counts: far less may be left there of the signal than of its error."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from physics.trace import Trace

# The relative accuracies that a response may be asked for.
SMALLEST_ACCURACY, LARGEST_ACCURACY = 1e-6, 0.1
# Of the accuracy that would just do, what a response that was not exact enough is made to next; how many are made.
NEXT_SHARE, MOST_ATTEMPTS = 0.9, 3


class Part(NamedTuple):
    """A `trace`, the `error` in that part of it which counts, and the `size` of this part, both m/s² (RMS)."""

    trace: Trace
    error: float
    size: float


def exact_in_part(respond: Callable[[float], Part], accuracy: float, least_error: float) -> Part:
    """What `respond` gives, to a relative RMS `accuracy` of the part that counts, or to `least_error` (m/s², RMS).

    `respond` is called with smaller and smaller accuracies until that is reached, or SMALLEST_ACCURACY, three times at
    most, and once if the response is chaotic.
    """
    asked = accuracy
    for _ in range(MOST_ATTEMPTS):
        part = respond(asked)
        allowed = max(accuracy * part.size, least_error)
        if part.trace.chaotic or part.error <= allowed or asked == SMALLEST_ACCURACY:
            break
        asked = max(asked * NEXT_SHARE * allowed / part.error, SMALLEST_ACCURACY)
    return part
