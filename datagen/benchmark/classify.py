"""`classify`: learn from one corpus, test on others, report."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from datagen.benchmark.chosen import chosen_records
from datagen.benchmark.machines import LearnedMachines, learned_machines
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.results import Results
from datagen.benchmark.run_learning import learn, training_labels
from datagen.benchmark.run_scoring import score_corpus
from datagen.benchmark.trained import is_saved, load_trained, save_trained
from datagen.corpus import Corpus
from datagen.progress import SILENT, Listener

if TYPE_CHECKING:
    import pandas


def run(benchmark: Benchmark, listener: Listener = SILENT) -> Results:
    """What the models say and score on every corpus; raises BadInput."""
    began = time.monotonic()
    trained = load_trained(benchmark.train) if is_saved(benchmark.train) else None
    labels = training_labels(benchmark) if trained is None else None
    if trained is not None:
        benchmark = replace(benchmark, options=replace(benchmark.options, learning=trained.learning))
    learned = _machines_of(benchmark, labels) if trained is None else trained.machines
    # Before anything is learned, which takes long: a corpus of which no record may be scored is refused at once.
    chosen = [chosen_records(folder, learned) for folder in benchmark.tests]
    if trained is None:
        trained = learn(benchmark, labels, learned, listener)
    if benchmark.save is not None:
        save_trained(benchmark.save, trained)
    tests = [score_corpus(benchmark, records, trained, listener) for records in chosen]
    return Results(str(benchmark.train), benchmark.options, trained.facts, tests, time.monotonic() - began)


def _machines_of(benchmark: Benchmark, labels: pandas.DataFrame | None) -> LearnedMachines | None:
    """The machines of the records with these labels, which are learned from; None for plain impulse trains."""
    return None if labels is None else learned_machines(Corpus(benchmark.train), labels["record"].to_numpy(np.int64))
