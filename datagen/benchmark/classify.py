"""`classify`: learn from one corpus, test on others, report."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from datagen.benchmark.machines import learned_machines
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.results import Results
from datagen.benchmark.run_learning import learn, training_labels
from datagen.benchmark.run_scoring import score_corpus, tested_records
from datagen.benchmark.trained import is_saved, load_trained, save_trained
from datagen.corpus import Corpus
from datagen.progress import SILENT, Listener


def run(benchmark: Benchmark, listener: Listener = SILENT) -> Results:
    """What the models say and score on every corpus; raises BadInput."""
    began = time.monotonic()
    if is_saved(benchmark.train):
        trained = load_trained(benchmark.train)
        benchmark = replace(benchmark, options=replace(benchmark.options, learning=trained.learning))
        chosen = [tested_records(folder, trained.machines) for folder in benchmark.tests]
    else:
        labels = training_labels(benchmark)
        learned = None
        if labels is not None:
            learned = learned_machines(Corpus(benchmark.train), labels["record"].to_numpy(np.int64))
        chosen = [tested_records(folder, learned) for folder in benchmark.tests]
        trained = learn(benchmark, labels, learned, listener)
    if benchmark.save is not None:
        save_trained(benchmark.save, trained)
    tests = [
        score_corpus(benchmark, folder, records, trained, listener)
        for folder, records in zip(benchmark.tests, chosen, strict=True)
    ]
    return Results(str(benchmark.train), benchmark.options, trained.facts, tests, time.monotonic() - began)
