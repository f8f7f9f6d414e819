"""The first half of a run: from records to a rule and models."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.benchmark.importance import importances
from datagen.benchmark.impulse_signal import Ingredients
from datagen.benchmark.impulse_training import impulse_training, ingredients_of
from datagen.benchmark.learning import learning_curve
from datagen.benchmark.machines import LearnedMachines, share_machines
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.trained import Trained
from datagen.benchmark.training import (
    TrainingSet,
    labelled,
    train,
    train_rule,
    training_records,
    training_set,
)
from datagen.corpus import Corpus
from datagen.progress import Listener
from labels.classifier.alarm import Alarm

if TYPE_CHECKING:
    import pandas


def training_labels(benchmark: Benchmark) -> pandas.DataFrame | None:
    """Labels of the records to learn from; None for plain impulse trains."""
    if ingredients_of(benchmark.train) is not None:
        return None
    corpus = Corpus(benchmark.train)
    also_tested = any(share_machines(corpus, Corpus(folder)) for folder in benchmark.tests)
    return training_records(benchmark.train, also_tested, benchmark.learning.first)


def learn(
    benchmark: Benchmark, labels: pandas.DataFrame | None, learned: LearnedMachines | None, listener: Listener
) -> Trained:
    """The rule and the models, learned from the records with these `labels`, or from impulse trains if None.

    `learned` are the machines of those records, which must not be scored. Raises BadInput if nothing can be learned.
    """
    training = _learned_from(benchmark, labels, listener)
    rule = train_rule(training)
    model_input = _model_input(benchmark, training, labels, listener)
    # The curve comes first: it needs copies of the user's estimator from before it has learned.
    curve = None
    if benchmark.learning_curve:
        curve = learning_curve(model_input, benchmark.learning, benchmark.estimator, listener.step)
    models = train(model_input, benchmark.learning, benchmark.estimator, listener.step)
    listener.step("importances of the features")
    facts: dict[str, Any] = {
        "training_records": int(np.unique(training.rows.record).size) if labels is None else len(labels),
        "rule_threshold": rule.threshold,
        "rule_of_several_axes": rule.of_several,
        "alarms": {model.name: _plain(model.alarm) for model in models},
        "importances": {model.name: importances(model, training) for model in models if not model.takes_windows},
    }
    if curve is not None:
        facts["learning_curve"] = curve
    recipe = "" if labels is None else Corpus(benchmark.train).manifest.identity.recipe_hash
    return Trained(rule, models, learned, benchmark.learning, recipe, facts)


def _plain(alarm: Alarm | float) -> dict[str, float] | float:
    return asdict(alarm) if isinstance(alarm, Alarm) else alarm


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
    raw = benchmark.windows(benchmark.train, labels, listener)
    return labelled(raw, labels)
