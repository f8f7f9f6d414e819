"""The second half of a run: what was learned, tested on one corpus."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from datagen.benchmark.corpus_rows import CorpusRows, read_rows
from datagen.benchmark.log_line import log_run
from datagen.benchmark.machines import LearnedMachines, unseen_records
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.predictions import record_predictions
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.results import CorpusResults, NoisyScores
from datagen.benchmark.summary import summarise
from datagen.benchmark.trained import Trained
from datagen.benchmark.verdicts import judge, pooled_draws
from datagen.corpus import Corpus
from datagen.judging.scored_runs import write_line
from datagen.progress import Count, Listener
from physics.bearing import RACES

if TYPE_CHECKING:
    import pandas


def tested_records(folder: Path, learned: LearnedMachines | None) -> pandas.DataFrame:
    """Labels of the records of `folder` that are tested on: none of machines that were learned from."""
    return Corpus(folder).labels if learned is None else unseen_records(Corpus(folder), learned)


def score_corpus(
    benchmark: Benchmark, folder: Path, labels: pandas.DataFrame, trained: Trained, listener: Listener
) -> CorpusResults:
    """What the rule and the models say about the records with these labels, and their scores, without and with added
    noise. Raises BadInput if a run on recordings cannot be logged."""
    imported = bool(Corpus(folder).manifest.imported)
    if imported:
        write_line(folder, {"began": benchmark.options.to_dict(), "train": str(benchmark.train)})
    listener.say(f"testing on {len(labels)} records of {folder}")
    rows = _rows(
        folder, labels, benchmark.reading(), benchmark.workers, listener.counting(f"features of {folder.name}")
    )
    if benchmark.learning.takes_windows:
        rows = replace(rows, raw=benchmark.windows(folder, labels, listener))
    tested = judge(folder, labels, rows, trained.rule, trained.models, benchmark.scoring.reject, imported)
    scores = summarise(tested)
    noise_tells = imported and np.isin(tested.truth, RACES).any()
    levels = benchmark.scoring.levels if noise_tells else ()
    if benchmark.scoring.levels and not noise_tells:
        listener.say(f"no noise is added to {folder}: --noise-db is for recordings of faults, and it holds none")
    noise = [_noisy(benchmark, folder, labels, trained, level, listener) for level in levels]
    if imported:
        log_run(folder, benchmark.train, trained.recipe, benchmark.options.to_dict(), scores.models)
    return CorpusResults(scores, record_predictions(tested), noise)


def _rows(folder: Path, labels: pandas.DataFrame, reading: Reading, workers: int, count: Count) -> CorpusRows:
    return read_rows(folder, labels["record"].to_numpy(np.int64), reading, workers, count)


def _noisy(
    benchmark: Benchmark, folder: Path, labels: pandas.DataFrame, trained: Trained, level: float, listener: Listener
) -> NoisyScores:
    """Scores with white noise of that level (signal over noise, dB) added, all draws pooled."""
    draws = benchmark.scoring.noise_draws
    listener.say(f"testing on {folder} with noise at {level:g} dB, {draws} draws")
    pooled = []
    for draw in range(draws):
        reading = replace(benchmark.reading(), noise_db=level, noise_draw=draw)
        count = listener.counting(f"{level:g} dB, draw {draw + 1} of {draws}")
        rows = _rows(folder, labels, reading, benchmark.workers, count)
        pooled.append(judge(folder, labels, rows, trained.rule, trained.models, benchmark.scoring.reject, True))
    return NoisyScores(level, draws, summarise(pooled_draws(pooled)))
