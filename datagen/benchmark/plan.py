"""What a run of `classify` is to learn from and to test on, and how its records are read."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.benchmark.options import Learning, Options, Scoring
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.rows import Rows
from datagen.benchmark.training import COPIES_DB, LOWEST_BANDWIDTH
from datagen.benchmark.windows import common_rate, read_windows
from datagen.progress import Listener

if TYPE_CHECKING:
    import pandas


def reading_of(learning: Learning) -> Reading:
    """How the records to judge are read, with these options."""
    return Reading() if learning.bandwidth is None else Reading(bandwidth=learning.bandwidth)


def training_reading_of(learning: Learning) -> Reading:
    """How the records to learn from are read, with these options."""
    return replace(
        reading_of(learning),
        speed_error=learning.speed_error,
        lowest_bandwidth=LOWEST_BANDWIDTH,
        copies_db=COPIES_DB,
    )


@dataclass(frozen=True)
class Benchmark:
    """What is learned from, what is tested on, and how.

    `train` is a corpus, a file with models that have learned already, or one of the names that stand for something to
    learn from (`training_source.py`); newly trained models are saved at `save`, if given.
    `estimator` is the user's own that the options name, None for our learners. With `learning_curve`, models are also
    learned from fractions of the bearings.
    """

    train: Path
    tests: tuple[Path, ...]
    options: Options = field(default_factory=Options)
    estimator: Any | None = None
    learning_curve: bool = False
    workers: int = 2
    save: Path | None = None

    @property
    def learning(self) -> Learning:
        """The options of learning."""
        return self.options.learning

    @property
    def scoring(self) -> Scoring:
        """The options of scoring."""
        return self.options.scoring

    @cached_property
    def window_rate(self) -> float:
        """Common rate of raw windows, Hz."""
        return common_rate((self.train, *self.tests), self.reading().bandwidth)

    def reading(self) -> Reading:
        """How the records that are tested on are read."""
        return reading_of(self.learning)

    def training_reading(self) -> Reading:
        """How the records that are learned from are read: with speeds only roughly known, any bandwidth, and noisy
        copies."""
        return training_reading_of(self.learning)

    def windows(self, folder: Path, labels: pandas.DataFrame, listener: Listener) -> Rows:
        """Raw windows of the records of the corpus in `folder` that have these labels."""
        records = labels["record"].to_numpy(np.int64)
        return read_windows(folder, records, self.window_rate, listener.counting(f"windows of {folder.name}"))
