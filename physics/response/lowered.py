"""A response whose rate is lowered: far less may be left of the signal than of its error."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from physics.response.lead_in import MOST_ATTEMPTS, NEXT_SHARE
from physics.rms import rms
from physics.trace import Trace


def respond_lowered(
    respond: Callable[[float], tuple[Trace, float]], share: float, accuracy: float, least_error: float
) -> Trace:
    """The trace that `respond` gives, to a relative RMS `accuracy` of what is left of it at the lower rate.

    `respond` is called with smaller and smaller accuracies, and gives a trace at the lower rate and the RMS (m/s²) that
    it had before. Of its error the `share` is left, until that is within the `accuracy` of the trace, or within
    `least_error` (m/s², RMS). The error estimate is never below that of the trace before.
    """
    asked = accuracy
    for _ in range(MOST_ATTEMPTS):
        trace, before = respond(asked)
        error, size = share * trace.error_estimate * before, rms(trace.acceleration)
        allowed = max(accuracy * size, least_error)
        if trace.chaotic or error <= allowed:
            break
        asked *= NEXT_SHARE * allowed / error
    if trace.chaotic or size == 0.0:
        return trace
    return replace(trace, error_estimate=max(trace.error_estimate, error / size))
