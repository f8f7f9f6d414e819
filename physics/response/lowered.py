"""A response whose rate is lowered behind it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from physics.response.part import Part, exact_in_part
from physics.rms import rms
from physics.trace import Trace


def respond_lowered(
    respond: Callable[[float], tuple[Trace, float]], share: float, accuracy: float, least_error: float
) -> Trace:
    """The trace that `respond` gives, to a relative RMS `accuracy` of what is left of it at the lower rate.

    `respond` is called with an accuracy, and gives a trace at the lower rate and the RMS (m/s²) that it had before. Of
    its error the `share` is left; `least_error` (m/s², RMS) of that is always allowed. The error estimate is never
    below that of the trace before.
    """

    def left(asked: float) -> Part:
        trace, before = respond(asked)
        return Part(trace, share * trace.error_estimate * before, rms(trace.acceleration))

    trace, error, size = exact_in_part(left, accuracy, least_error)
    if trace.chaotic or size == 0.0:
        return trace
    return replace(trace, error_estimate=max(trace.error_estimate, error / size))
