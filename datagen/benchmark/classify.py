"""`classify`: learn from one corpus, test on others, report."""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.benchmark.corpus_rows import CorpusRows, read_rows
from datagen.benchmark.importance import importances
from datagen.benchmark.impulse_signal import Ingredients
from datagen.benchmark.impulse_training import impulse_training, ingredients_of
from datagen.benchmark.learning import learning_curve
from datagen.benchmark.log_line import log_run
from datagen.benchmark.machines import LearnedMachines, learned_machines, share_machines, unseen_records
from datagen.benchmark.options import Learning, Options, Scoring
from datagen.benchmark.predictions import record_predictions
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.results import CorpusResults, NoisyScores, Results
from datagen.benchmark.rows import Rows
from datagen.benchmark.summary import summarise
from datagen.benchmark.trained import Trained, is_saved, load_trained, save_trained
from datagen.benchmark.training import (
    COPIES_DB,
    LOWEST_BANDWIDTH,
    Model,
    TrainingSet,
    labelled,
    train_models,
    train_rule,
    train_user_estimator,
    training_records,
    training_set,
)
from datagen.benchmark.verdicts import judge, pooled_draws
from datagen.benchmark.windows import common_rate, read_windows
from datagen.corpus import Corpus
from datagen.progress import SILENT, Count, Listener
from datagen.scored_runs import write_line
from labels.classifier.alarm import Alarm
from physics.bearing import RACES

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Benchmark:
    """What is learned from, what is tested on, and how.

    `train` is a corpus, or a file of what was learned from one; what is learned is kept at `save`, if given.
    `estimator` is the user's that the options name, None for our learners. With `learning_curve` it is also learned
    from shares.
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
        return Reading() if self.learning.bandwidth is None else Reading(bandwidth=self.learning.bandwidth)

    def training_reading(self) -> Reading:
        """How the records that are learned from are read: with speeds only roughly known, any bandwidth, and noisy
        copies."""
        return replace(
            self.reading(),
            speed_error=self.learning.speed_error,
            lowest_bandwidth=LOWEST_BANDWIDTH,
            copies_db=COPIES_DB,
        )


def run(benchmark: Benchmark, listener: Listener = SILENT) -> Results:
    """What the models say and score on every corpus; raises BadInput."""
    began = time.monotonic()
    if is_saved(benchmark.train):
        trained = load_trained(benchmark.train)
        benchmark = replace(benchmark, options=replace(benchmark.options, learning=trained.learning))
        chosen = [_tested_records(folder, trained.machines) for folder in benchmark.tests]
    else:
        labels = _training_labels(benchmark)
        learned = None
        if labels is not None:
            learned = learned_machines(Corpus(benchmark.train), labels["record"].to_numpy(np.int64))
        chosen = [_tested_records(folder, learned) for folder in benchmark.tests]
        trained = _learn(benchmark, labels, learned, listener)
    if benchmark.save is not None:
        save_trained(benchmark.save, trained)
    tests = [
        _test(benchmark, folder, records, trained, listener)
        for folder, records in zip(benchmark.tests, chosen, strict=True)
    ]
    return Results(str(benchmark.train), benchmark.options, trained.facts, tests, time.monotonic() - began)


def _learn(
    benchmark: Benchmark, labels: pandas.DataFrame | None, learned: LearnedMachines | None, listener: Listener
) -> Trained:
    """What is learned from the records with these labels, of the machines `learned`; from impulse trains if None."""
    training = _learned_from(benchmark, labels, listener)
    rule = train_rule(training)
    model_input = _model_input(benchmark, training, labels, listener)
    # The curve comes first: it needs copies of the user's estimator from before it has learned.
    curve = _curve(benchmark, model_input, listener)
    models = _models(benchmark, model_input, listener)
    listener.step("importances of the features")
    facts: dict[str, Any] = {
        "training_records": int(np.unique(training.rows.record).size) if labels is None else len(labels),
        "rule_threshold": rule.threshold,
        "rule_of_several_axes": rule.of_several,
        "alarms": {model.name: _plain(model.alarm) for model in models},
        "importances": {model.name: importances(model, training) for model in models if not model.takes_windows},
    }
    recipe = "" if labels is None else Corpus(benchmark.train).manifest.identity.recipe_hash
    return Trained(rule, models, learned, benchmark.learning, recipe, facts | curve)


def _plain(alarm: Alarm | float) -> dict[str, float] | float:
    return asdict(alarm) if isinstance(alarm, Alarm) else alarm


def _training_labels(benchmark: Benchmark) -> pandas.DataFrame | None:
    """Labels of the records to learn from; None for plain impulse trains."""
    if ingredients_of(benchmark.train) is not None:
        return None
    corpus = Corpus(benchmark.train)
    also_tested = any(share_machines(corpus, Corpus(folder)) for folder in benchmark.tests)
    return training_records(benchmark.train, also_tested, benchmark.learning.first)


def _learned_from(benchmark: Benchmark, labels: pandas.DataFrame | None, listener: Listener) -> TrainingSet:
    reading, workers = benchmark.training_reading(), benchmark.workers
    if labels is None:
        listener.say("learning from plain impulse trains")
        ingredients = ingredients_of(benchmark.train) or Ingredients()
        count = listener.counting("impulse trains")
        return impulse_training(ingredients, reading, workers, benchmark.learning.first, count)
    listener.say(f"learning from {len(labels)} records of {labels['bearing_id'].nunique()} virtual bearings")
    return training_set(
        benchmark.train, labels, reading, workers, listener.counting(f"features of {benchmark.train.name}")
    )


def _model_input(
    benchmark: Benchmark, training: TrainingSet, labels: pandas.DataFrame | None, listener: Listener
) -> TrainingSet:
    """What the models learn from: the same records as raw windows where the user's estimator takes those."""
    if labels is None or not benchmark.learning.takes_windows:
        return training
    raw = _windows(benchmark, benchmark.train, labels, listener)
    return labelled(raw, labels)


def _curve(benchmark: Benchmark, training: TrainingSet, listener: Listener) -> dict[str, Any]:
    if not benchmark.learning_curve:
        return {}
    options = benchmark.learning
    found = learning_curve(
        training, options.learner, benchmark.estimator, options.takes_windows, options.estimator or "", listener.step
    )
    return {"learning_curve": found}


def _models(benchmark: Benchmark, training: TrainingSet, listener: Listener) -> list[Model]:
    options = benchmark.learning
    if benchmark.estimator is None:
        return train_models(training, options.learner, listener.step)
    listener.step(f"learning: {options.estimator}")
    return [train_user_estimator(training, benchmark.estimator, options.takes_windows, options.estimator or "")]


def _tested_records(folder: Path, learned: LearnedMachines | None) -> pandas.DataFrame:
    return Corpus(folder).labels if learned is None else unseen_records(Corpus(folder), learned)


def _test(
    benchmark: Benchmark, folder: Path, labels: pandas.DataFrame, trained: Trained, listener: Listener
) -> CorpusResults:
    imported = bool(Corpus(folder).manifest.imported)
    if imported:
        write_line(folder, {"began": benchmark.options.to_dict(), "train": str(benchmark.train)})
    listener.say(f"testing on {len(labels)} records of {folder}")
    rows = _rows(
        folder, labels, benchmark.reading(), benchmark.workers, listener.counting(f"features of {folder.name}")
    )
    if benchmark.learning.takes_windows:
        rows = replace(rows, raw=_windows(benchmark, folder, labels, listener))
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


def _windows(benchmark: Benchmark, folder: Path, labels: pandas.DataFrame, listener: Listener) -> Rows:
    records = labels["record"].to_numpy(np.int64)
    return read_windows(folder, records, benchmark.window_rate, listener.counting(f"windows of {folder.name}"))


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
