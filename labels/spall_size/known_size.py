"""A size made better by a record of the same machine whose spall was measured."""

from __future__ import annotations

from dataclasses import replace

from labels.spall_size.size_estimate import SizeEstimate

# Part of the logarithmic error that two records of one machine share; the edges of the other spall are not its part.
SHARE = 0.3


def known_size_factor(estimated: float, known: float) -> float:
    """Factor for other sizes of a machine where a spall of the `known` extent was `estimated`: their ratio^0.3."""
    return float((known / estimated) ** SHARE)


def corrected(estimate: SizeEstimate, factor: float) -> SizeEstimate:
    """The same estimate with every extent times `factor`; the lag, which was seen, stays."""
    return replace(
        estimate,
        extent=estimate.extent * factor,
        extent_interval=(estimate.extent_interval[0] * factor, estimate.extent_interval[1] * factor),
        extent_mm=estimate.extent_mm * factor,
        extent_mm_interval=(estimate.extent_mm_interval[0] * factor, estimate.extent_mm_interval[1] * factor),
        candidates=tuple(value * factor for value in estimate.candidates),
        method=f"{estimate.method}, known size of another record",
    )
