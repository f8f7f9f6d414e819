"""What `classify` can learn from: a simulated corpus, the rows that come with the program, or plain impulse trains."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Protocol

import numpy as np

from datagen.benchmark.impulse_training import ImpulseTrains, ingredients_of
from datagen.benchmark.kept_rows import KeptRows, is_kept
from datagen.benchmark.machines import LearnedMachines, learned_machines, share_machines
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.training import TrainingSet, labelled, training_records, training_set
from datagen.corpus import Corpus
from datagen.progress import Listener


class TrainingSource(Protocol):
    """Something to learn from."""

    @property
    def machines(self) -> LearnedMachines | None:
        """The machines learned from, of which no record may be scored; None if no corpus has any of them."""

    @property
    def recipe(self) -> str:
        """Hash of the recipe that its records were made by, "" without."""

    def features(self, listener: Listener) -> TrainingSet:
        """Its records as rows of features; raises BadInput if nothing can be learned from them."""


class CorpusRecords:
    """Records of a simulated corpus: all of the five classes, but for the split "test" where a corpus with the same
    machines is tested on.

    Raises BadInput if these are of too few virtual bearings.
    """

    def __init__(self, benchmark: Benchmark) -> None:
        self._benchmark, self._corpus = benchmark, Corpus(benchmark.train)
        also_tested = any(share_machines(self._corpus, Corpus(folder)) for folder in benchmark.tests)
        self._labels = training_records(benchmark.train, also_tested, benchmark.learning.first)

    @cached_property
    def machines(self) -> LearnedMachines:
        """The machines of these records."""
        return learned_machines(self._corpus, self._labels["record"].to_numpy(np.int64))

    @property
    def recipe(self) -> str:
        """Hash of the recipe of the corpus."""
        return self._corpus.manifest.identity.recipe_hash

    def features(self, listener: Listener) -> TrainingSet:
        """Rows of features of these records, read with wrong speeds, any bandwidth and noisy copies."""
        benchmark, bearings = self._benchmark, self._labels["bearing_id"].nunique()
        listener.say(f"learning from {len(self._labels)} records of {bearings} virtual bearings")
        count = listener.counting(f"features of {benchmark.train.name}")
        return training_set(benchmark.train, self._labels, benchmark.training_reading(), benchmark.workers, count)

    def windows(self, listener: Listener) -> TrainingSet:
        """Raw windows of these records."""
        return labelled(self._benchmark.windows(self._benchmark.train, self._labels, listener), self._labels)


def passed_over(train: Path) -> str:
    """In a sentence, that `--train` names something built in and not the folder of that name; "" if there is none."""
    built_in = is_kept(train) or ingredients_of(train) is not None
    if not built_in or not train.is_dir():
        return ""
    return f'"{train}" is what comes with the program; the folder of that name is --train "{train.absolute()}"'


def source_of(benchmark: Benchmark) -> TrainingSource:
    """What the benchmark learns from; raises BadInput if that cannot be learned from."""
    if is_kept(benchmark.train):
        return KeptRows(benchmark.learning.first)
    ingredients = ingredients_of(benchmark.train)
    if ingredients is not None:
        return ImpulseTrains(ingredients, benchmark)
    return CorpusRecords(benchmark)
