"""What a record shows of a spall: its passes lined up, their mean and the pairs of candidate events in it."""

from __future__ import annotations

from dataclasses import dataclass

from labels.spall_size.events.pairs import Pairs
from labels.spall_size.signal.alignment import Alignment
from labels.spall_size.signal.mean_pass import MeanPass


@dataclass(frozen=True)
class Evidence:
    """What a record shows if its spall is on `race`: the passes lined up, their mean and all pairs of candidates.

    `rate` Hz; `deviation` is the standard deviation of the signal, `unit` what 1 in the prewhitened signal stands for,
    both in the unit of the signal.
    """

    race: str
    rate: float
    deviation: float
    unit: float
    alignment: Alignment
    mean: MeanPass
    pairs: Pairs
