"""The second half of a run: what was learned, tested on one corpus."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from datagen.benchmark.chosen import ChosenRecords
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.log_line import log_run
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.predictions import record_predictions
from datagen.benchmark.results import CorpusResults, NoisyScores
from datagen.benchmark.summary import summarise
from datagen.benchmark.trained import Trained
from datagen.benchmark.verdicts import Judges, pool
from datagen.counts import counted
from datagen.judging.scored_runs import write_line
from datagen.progress import Listener
from physics.bearing import RACES


def score_corpus(benchmark: Benchmark, chosen: ChosenRecords, trained: Trained, listener: Listener) -> CorpusResults:
    """What the rule and the models say about the `chosen` records, and their scores, without and with added noise.
    Raises BadInput if a run on recordings cannot be logged."""
    folder, scoring, options = chosen.folder, benchmark.scoring, benchmark.options.to_dict()
    if chosen.imported:
        write_line(folder, {"began": options, "train": str(benchmark.train)})
    listener.say(f"testing on {counted(len(chosen.labels), 'record')} of {folder}")
    count = listener.counting(f"features of {folder.name}")
    rows = read_rows(folder, chosen.numbers, benchmark.reading(), benchmark.workers, count)
    if benchmark.learning.takes_windows:
        rows = replace(rows, raw=benchmark.windows(folder, chosen.labels, listener))
    judges = Judges(trained.rule, trained.models, scoring.reject)
    tested = judges.judge(chosen, rows)
    scores = summarise(tested)
    noise_tells = chosen.imported and np.isin(tested.truth, RACES).any()
    if scoring.levels and not noise_tells:
        listener.say(f"no noise is added to {folder}: --noise-db is for recordings of faults, and it holds none")
    levels = scoring.levels if noise_tells else ()
    noise = [_noisy(benchmark, chosen, judges, level, listener) for level in levels]
    if chosen.imported:
        log_run(folder, benchmark.train, trained.recipe, options, scores.models)
    return CorpusResults(scores, record_predictions(tested), noise)


def _noisy(
    benchmark: Benchmark, chosen: ChosenRecords, judges: Judges, level: float, listener: Listener
) -> NoisyScores:
    """Scores with white noise of that level (signal over noise, dB) added, all draws pooled."""
    draws = benchmark.scoring.noise_draws
    listener.say(f"testing on {chosen.folder} with noise at {level:g} dB, {draws} draws")
    pooled = []
    for draw in range(draws):
        reading = replace(benchmark.reading(), noise_db=level, noise_draw=draw)
        count = listener.counting(f"{level:g} dB, draw {draw + 1} of {draws}")
        rows = read_rows(chosen.folder, chosen.numbers, reading, benchmark.workers, count)
        pooled.append(judges.judge(chosen, rows))
    return NoisyScores(level, draws, summarise(pool(pooled)))
