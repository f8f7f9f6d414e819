"""The first half of a run: from records to a rule and models."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from datagen.benchmark.importance import importances
from datagen.benchmark.learning_curve import learning_curve
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.trained import Trained
from datagen.benchmark.training import train, train_rule
from datagen.benchmark.training_source import CorpusRecords, TrainingSource
from datagen.progress import Listener
from labels.classifier.alarm import Alarm


def learn(benchmark: Benchmark, source: TrainingSource, listener: Listener) -> Trained:
    """The rule and the models, learned from a `source`; raises BadInput if nothing can be learned."""
    training = source.features(listener)
    rule = train_rule(training)
    model_input = training
    if benchmark.learning.takes_windows and isinstance(source, CorpusRecords):
        model_input = source.windows(listener)
    # The curve comes first: it needs copies of the user's estimator from before it has learned.
    curve = None
    if benchmark.learning_curve:
        curve = learning_curve(model_input, benchmark.learning, benchmark.estimator, listener)
    models = train(model_input, benchmark.learning, benchmark.estimator, listener.step)
    listener.step("importances of the features")
    facts: dict[str, Any] = {
        "training_records": int(np.unique(training.rows.record).size),
        "rule_threshold": rule.threshold,
        "rule_of_several_axes": rule.of_several,
        "alarms": {model.name: _plain(model.alarm) for model in models},
        "importances": {model.name: importances(model, training) for model in models if not model.takes_windows},
    }
    if curve is not None:
        facts["learning_curve"] = curve
    return Trained(rule, models, source.machines, benchmark.learning, source.recipe, facts)


def _plain(alarm: Alarm | float) -> dict[str, float] | float:
    return asdict(alarm) if isinstance(alarm, Alarm) else alarm
