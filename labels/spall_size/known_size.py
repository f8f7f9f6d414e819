"""Correcting sizes by a record of the same machine whose spall was measured."""

from __future__ import annotations

import math
from dataclasses import replace

from labels.spall_size.size_estimate import LONGEST_EXTENT, SizeEstimate

# Share of an error (logarithm) that is taken to hold for the other records of the machine. Errors of two records of one
# machine hardly go together (correlation 0.04 over 725 pairs of the size training), because each spall has edges of its
# own; a larger share made sizes worse.
SHARE = 0.05
# Error (logarithm) that counts at most; a longer reach made sizes worse.
FURTHEST = 0.05


def known_size_factor(estimated: float, known: float) -> float:
    """Factor for other sizes of a machine where a spall of the `known` extent was `estimated`.

    A twentieth of the logarithm of their ratio, which counts as 5 % at most.
    """
    return math.exp(SHARE * min(max(math.log(known / estimated), -FURTHEST), FURTHEST))


def corrected(estimate: SizeEstimate, factor: float) -> SizeEstimate:
    """The same estimate with its extent times `factor`, if that is not too long to be reported; the lag, which was
    seen, stays, and the other candidates stay whole ball spacings longer."""
    extent = min(estimate.extent * factor, LONGEST_EXTENT)
    factor, longer = extent / estimate.extent, extent - estimate.extent
    others = (candidate + longer for candidate in estimate.candidates[1:])
    return replace(
        estimate,
        extent=extent,
        extent_interval=(estimate.extent_interval[0] * factor, estimate.extent_interval[1] * factor),
        extent_mm=estimate.extent_mm * factor,
        extent_mm_interval=(estimate.extent_mm_interval[0] * factor, estimate.extent_mm_interval[1] * factor),
        candidates=(extent, *(other for other in others if other <= LONGEST_EXTENT)),
        method=f"{estimate.method}, known size of another record",
    )
