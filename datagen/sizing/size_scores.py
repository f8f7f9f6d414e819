"""All that is said of a scored corpus: its records one by one, and summed up."""

from __future__ import annotations

from dataclasses import dataclass

from datagen.sizing.known_sizes import KnownSize
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_summary import SizeSummary, StatedSizes


@dataclass(frozen=True)
class SizeScores:
    """`summary` is None where no record's ball passes are known, as in imported recordings; `stated` is what is scored
    of those by what their SPEC states, None if it states nothing. `load_given` counts the records whose load and Hertz
    factor the estimator was given, `fitted_to` those of machines that our estimator has been fitted to."""

    folder: str
    estimator: str
    split: str
    load_known: bool
    records: list[ScoredRecord]
    summary: SizeSummary | None
    known_sizes: list[KnownSize]
    stated: StatedSizes | None = None
    load_given: int = 0
    fitted_to: int = 0
