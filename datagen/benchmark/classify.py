"""`classify`: learn from one corpus, test on others, report."""

from __future__ import annotations

import time
from dataclasses import replace

from datagen.benchmark.chosen import chosen_records
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.results import Results
from datagen.benchmark.run_learning import learn
from datagen.benchmark.run_scoring import score_corpus
from datagen.benchmark.trained import Trained, is_saved, load_trained, save_trained
from datagen.benchmark.training_source import passed_over, source_of
from datagen.progress import SILENT, Listener


def run(benchmark: Benchmark, listener: Listener = SILENT) -> Results:
    """What the models say and score on every corpus; raises BadInput."""
    began = time.monotonic()
    if sentence := passed_over(benchmark.train):
        listener.say(sentence)
    source = load_trained(benchmark.train) if is_saved(benchmark.train) else source_of(benchmark)
    # Before anything is learned, which takes long: a corpus of which no record may be scored is refused at once.
    chosen = [chosen_records(folder, source.machines) for folder in benchmark.tests]
    trained = source if isinstance(source, Trained) else learn(benchmark, source, listener)
    benchmark = replace(benchmark, options=replace(benchmark.options, learning=trained.learning))
    if benchmark.save is not None:
        save_trained(benchmark.save, trained)
    tests = [score_corpus(benchmark, records, trained, listener) for records in chosen]
    return Results(str(benchmark.train), benchmark.options, trained.facts, tests, time.monotonic() - began)
