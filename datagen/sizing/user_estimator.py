"""An estimator that users bring, guarded: what it raises or gives instead of an estimate becomes one message."""

from __future__ import annotations

import math
import numbers
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.judging.user_code import FIELD, user_code
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import LONGEST_EXTENT, SizeEstimate, SizeOutcome
from physics.bearing import RACES

ESTIMATOR_FORMS = (
    "module:Class with a method estimate(acceleration, rate, situation) that returns a SizeEstimate, "
    "or module:function that does the same"
)
NUMBERS = ("lag", "lag_arc", "extent", "extent_mm", "pass_period", "trust")
INTERVALS = ("lag_interval", "extent_interval", "extent_mm_interval")


@dataclass(frozen=True)
class UserEstimator:
    """What the user's "module:Class" or "module:function" `name` has `made`, one of ESTIMATOR_FORMS."""

    name: str
    made: Any

    def estimate(self, acceleration: NDArray[np.float64], rate: float, situation: Situation) -> SizeEstimate:
        """What the user's object makes of acceleration (T, axes), m/s², sampled at `rate` (Hz); it is given a copy.

        Raises BadInput if it raises, or gives something else.
        """
        method = getattr(self.made, "estimate", None)
        subject = "it" if method is None else "its method estimate"
        with user_code(self.name, f"{subject} fails"):
            estimate: SizeEstimate = (method or self.made)(acceleration.copy(), rate, situation)
        problem = _against(estimate)
        if problem:
            raise BadInput(f"{subject} gave {problem}", field=FIELD, value=self.name, allowed=ESTIMATOR_FORMS)
        return estimate


def _against(estimate: object) -> str:
    """What an estimator gave that is no estimate, in words; empty for an estimate."""
    if not isinstance(estimate, SizeEstimate):
        return f"{_kind(estimate)} and no SizeEstimate"
    if not isinstance(estimate.outcome, SizeOutcome):
        return f"a SizeEstimate whose outcome is {_kind(estimate.outcome)} and no SizeOutcome"
    for name in NUMBERS:
        if not _is_number(getattr(estimate, name)):
            return f"a SizeEstimate whose {name} is {_kind(getattr(estimate, name))} and no number"
    for name in INTERVALS:
        if not _are_numbers(getattr(estimate, name), 2):
            return f"a SizeEstimate whose {name} is {_kind(getattr(estimate, name))} and no pair of numbers"
    if not _are_numbers(estimate.candidates):
        return f"a SizeEstimate whose candidates are {_kind(estimate.candidates)} and not numbers"
    wrong = _impossible(estimate) if estimate.found else _beside_none(estimate)
    if wrong:
        return f"a SizeEstimate that is {estimate.outcome.name}, whose {wrong}"
    times: Any = estimate.event_times
    if not isinstance(times, np.ndarray) or times.dtype.kind not in "iuf" or times.ndim != 2 or times.shape[1] != 2:
        return f"a SizeEstimate whose event_times are {_kind(times)} and no array of numbers (K, 2)"
    return ""


def _impossible(estimate: SizeEstimate) -> str:
    """What no spall can have, in words; empty if a size can be meant."""
    if estimate.race not in ("", *RACES):
        return f"race is {_kind(estimate.race)} and not {' or '.join(RACES)}"
    if not 0.0 < estimate.extent <= LONGEST_EXTENT:
        return f"extent is {estimate.extent:g} rad and not above 0 and pi at most"
    if not 0.0 < estimate.extent_mm < math.inf:
        return f"extent_mm is {estimate.extent_mm:g} and not above 0"
    if not (math.isnan(estimate.lag) or 0.0 < estimate.lag < math.inf):
        return f"lag is {estimate.lag:g} s and not above 0"
    if not all(0.0 < arc < math.inf for arc in estimate.candidates):
        return f"candidates are {_kind(estimate.candidates)} and not all above 0"
    return _untrue(estimate.trust)


def _beside_none(estimate: SizeEstimate) -> str:
    """What cannot stand beside an outcome that gives no size, in words; empty if nothing does."""
    # A finite extent is what counts as an estimate.
    return (
        f"extent is {estimate.extent:g} rad and not nan" if math.isfinite(estimate.extent) else _untrue(estimate.trust)
    )


def _untrue(trust: float) -> str:
    return "" if 0.0 <= trust <= 1.0 else f"trust is {trust:g} and not between 0 and 1"


def _is_number(value: object) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def _are_numbers(value: Any, count: int | None = None) -> bool:
    listed = isinstance(value, Sequence | np.ndarray) and not isinstance(value, str | bytes)
    return listed and count in (None, len(value)) and all(_is_number(number) for number in value)


def _kind(value: object) -> str:
    if value is None:
        return "None"
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    text = repr(value).replace("\n", " ")
    return f"{type(value).__name__} {text if len(text) <= 40 else text[:37] + '...'}"
