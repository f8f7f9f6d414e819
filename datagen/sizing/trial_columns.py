"""Training trials column by column, and which of them a stage of the fit looks at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from datagen.sizing.scored_record import NO_EVENT_SAMPLES, lacks_event
from datagen.sizing.training_rows import Trial
from physics.arrays import Array, Flags

SURE_LAG = 3.0  # samples


@dataclass(frozen=True)
class TrialColumns:
    """N trials, each column (N,) and as in Trial; `period` tracked, samples; `typical` those of the corpus for whose
    mixture of spalls the intervals are to hold."""

    bearing: NDArray[np.str_]
    stored: Flags
    clean: Flags
    asked: Flags
    typical: Flags
    true_lag: Array
    lag: Array
    arc: Array
    period: Array

    @classmethod
    def of(cls, made: list[Trial], typical: Flags) -> TrialColumns:
        """The columns of the trials `made` (N,), of which these are `typical` (N,)."""
        return cls(
            bearing=np.array([trial.bearing_id for trial in made]),
            stored=np.array([trial.stored for trial in made], dtype=np.bool_),
            clean=np.array([trial.clean for trial in made], dtype=np.bool_),
            asked=np.array([trial.asked for trial in made], dtype=np.bool_),
            typical=typical,
            true_lag=np.array([trial.true_lag for trial in made]),
            lag=np.array([trial.lag for trial in made]),
            arc=np.array([trial.arc for trial in made]),
            period=np.array([trial.evidence.mean.period for trial in made]),
        )

    @property
    def eventless(self) -> Flags:
        """As stored, and no size may be given: no event, or a lag below two samples."""
        return self.stored & lacks_event(self.true_lag)

    @property
    def decided(self) -> Flags:
        """Whether there are events is beyond doubt: none, or a lag that is not between two samples and three."""
        return ~((self.true_lag >= NO_EVENT_SAMPLES) & (self.true_lag < SURE_LAG))

    @property
    def as_stored(self) -> Flags:
        """Typical ones as stored."""
        return self.typical & self.stored

    @property
    def asked_as_stored(self) -> Flags:
        """Typical ones as stored of which a size must be given."""
        return self.typical & self.asked & self.stored

    @property
    def asked_clean(self) -> Flags:
        """Typical ones, whole and without noise, of which a size must be given."""
        return self.typical & self.asked & self.clean
