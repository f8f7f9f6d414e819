"""A training set of plain impulse trains, made on the spot: what the contact model is compared with."""

from __future__ import annotations

import re
from contextlib import closing
from dataclasses import fields
from pathlib import Path

import numpy as np

from datagen.benchmark.impulse_signal import Ingredients, draw_train
from datagen.benchmark.options import TRAIN
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import feature_rows, signal_rows
from datagen.benchmark.rows import joined
from datagen.benchmark.training import FEWEST_BEARINGS, TrainingSet
from datagen.errors import BadInput
from datagen.processes import processes
from datagen.progress import Count, Listener
from labels.classifier.classes import joint_class
from labels.schema import HEALTHY, LOCATIONS

NAME = "impulse-trains"
SEED = 20_140
MACHINES = 240


def ingredients_of(train: Path) -> Ingredients | None:
    """The ingredients that `--train impulse-trains` or `impulse-trains-without-NAME` asks for, None for anything else.

    Raises BadInput for a name that is no ingredient.
    """
    text = str(train)
    asked = re.fullmatch(rf"{NAME}(?:-without-(.*))?", text)
    if asked is None:
        return None
    left_out = asked[1]
    names = [field.name for field in fields(Ingredients)]
    if left_out is not None and left_out not in names:
        allowed = ", ".join((NAME, *(f"{NAME}-without-{name}" for name in names)))
        raise BadInput("no such ingredient", field=TRAIN, value=text, allowed=allowed)
    return Ingredients(**{left_out: False}) if left_out else Ingredients()


class ImpulseTrains:
    """Impulse trains of such `ingredients` as something to learn from, for a `benchmark`."""

    machines = None
    recipe = ""

    def __init__(self, ingredients: Ingredients, benchmark: Benchmark) -> None:
        self._ingredients, self._benchmark = ingredients, benchmark

    def features(self, listener: Listener) -> TrainingSet:
        """Their rows of features, made on the spot."""
        listener.say("learning from plain impulse trains")
        benchmark, count = self._benchmark, listener.counting("impulse trains")
        reading, first = benchmark.training_reading(), benchmark.learning.first
        return impulse_training(self._ingredients, reading, benchmark.workers, first, count)


def impulse_training(
    ingredients: Ingredients, reading: Reading, workers: int, records: int | None, count: Count
) -> TrainingSet:
    """Rows of about that many `records` (720 if None): of each machine a healthy one and a spall on either race.

    `count` is called with how many are done.
    """
    from joblib import Parallel, delayed

    machines = MACHINES if records is None else max(FEWEST_BEARINGS, records // len(LOCATIONS))
    with processes(workers):
        parallel = Parallel(return_as="generator")
    found: list[TrainingSet] = []
    with closing(parallel(delayed(_machine)(machine, ingredients, reading) for machine in range(machines))) as results:
        for part in results:
            found.append(part)
            count(len(found) * len(LOCATIONS), machines * len(LOCATIONS))
    return TrainingSet(
        joined([part.rows for part in found]),
        np.concatenate([part.classes for part in found]),
        np.concatenate([part.bearings for part in found]),
    )


def _machine(machine: int, ingredients: Ingredients, reading: Reading) -> TrainingSet:
    parts, classes = [], []
    for record, location in enumerate(LOCATIONS):
        drawn = draw_train(SEED, machine, record, ingredients)
        found = signal_rows(drawn.signal, drawn.rate, drawn.kinematics, reading, [SEED, machine, record])
        parts.append(feature_rows(found, machine * len(LOCATIONS) + record))
        classes += [joint_class(HEALTHY if location == "none" else "line", location)] * len(found)
    rows = joined(parts)
    return TrainingSet(rows, np.array(classes), np.full(len(rows), f"machine_{machine:04}"))
