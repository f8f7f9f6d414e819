"""The rows of features of the recipe `transfer` that come with the program, so that recordings can be judged without
making its corpus first.

    python -m datagen.benchmark.kept_rows CORPUS

writes them anew from a whole corpus of that recipe: of the records outside its split "test", which is left to score.
"""

from __future__ import annotations

import argparse
import io
import sys
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from datagen.benchmark.machines import LearnedMachines, machines
from datagen.benchmark.options import TRAIN, TRANSFER_ROWS, Learning
from datagen.benchmark.plan import training_reading_of
from datagen.benchmark.rows import Rows
from datagen.benchmark.training import FEWEST_BEARINGS, TrainingSet, too_few_bearings, training_records, training_set
from datagen.corpus import Corpus
from datagen.counts import counted
from datagen.errors import BadInput
from datagen.exits import BAD_INPUT, print_error
from datagen.files.atomic import write_file
from datagen.progress import Listener
from labels.classifier.classes import CLASSES
from labels.features.table import FEATURE_NAMES

KEPT_FILE = Path(__file__).with_name("transfer_rows.npz")
WORKERS = 2


def is_kept(train: Path) -> bool:
    """Whether `--train` names the rows that come with the program."""
    return str(train) == TRANSFER_ROWS


class KeptRows:
    """The rows in a `file`, of the `first` so many records (None: of all).

    Raises BadInput if the features have changed since they were kept, or so many records are of too few bearings.
    """

    def __init__(self, first: int | None = None, file: Path = KEPT_FILE) -> None:
        with np.load(file) as kept:
            if kept["features"].tolist() != list(FEATURE_NAMES):
                problem = "the features have changed since these rows were kept"
                raise BadInput(problem, field=TRAIN, value=TRANSFER_ROWS, allowed="a corpus of the recipe transfer")
            table, record, axis = kept["table"].astype(np.float64), kept["record"], kept["axis"]
            rows = Rows(table, record.astype(np.int64), axis.astype(np.int64), kept["noisy"])
            whole = TrainingSet(rows, np.array(CLASSES)[kept["class_of_row"]], kept["bearings"][kept["bearing_of_row"]])
            self._bearings, self._machines, self.recipe = kept["bearings"], kept["machines"], str(kept["recipe"])
        chosen = np.unique(rows.record)[:first]
        self._training = whole.subset(np.isin(rows.record, chosen))
        if np.unique(self._training.bearings).size < FEWEST_BEARINGS:
            raise too_few_bearings(first)

    @cached_property
    def machines(self) -> LearnedMachines:
        """The machines of these rows, and all of the corpus that they were read from."""
        return LearnedMachines(self._machines[np.isin(self._bearings, self._training.bearings)], self._machines)

    def features(self, listener: Listener) -> TrainingSet:
        """The rows."""
        records, bearings = np.unique(self._training.rows.record).size, np.unique(self._training.bearings).size
        listener.say(f"learning from {TRANSFER_ROWS}: {records} records of {bearings} virtual bearings")
        return self._training


def keep(folder: Path, file: Path = KEPT_FILE) -> int:
    """Write the rows of the corpus in a `folder`, but of its split "test", to a `file`; the number of their records."""
    corpus, labels = Corpus(folder), training_records(folder, also_tested=True)
    training = training_set(folder, labels, training_reading_of(Learning()), WORKERS)
    bearings, first = np.unique(corpus.labels["bearing_id"].to_numpy(np.str_), return_index=True)
    rows = training.rows
    packed = io.BytesIO()
    np.savez_compressed(
        packed,
        features=np.array(FEATURE_NAMES),
        table=rows.table.astype(np.float32),  # half the size; nothing that is said of the scored records changes
        record=rows.record.astype(np.int32),
        axis=rows.axis.astype(np.int8),
        noisy=rows.noisy,
        class_of_row=np.array([CLASSES.index(name) for name in training.classes], dtype=np.int8),
        bearing_of_row=np.searchsorted(bearings, training.bearings).astype(np.int16),
        bearings=bearings,
        machines=machines(corpus)[first],
        recipe=np.array(corpus.manifest.identity.recipe_hash),
        physics=np.array(corpus.manifest.identity.model_hash),
    )
    write_file(file, packed.getvalue(), option="")
    return len(labels)


def _require_whole_transfer(folder: Path) -> None:
    """Raise BadInput unless the corpus in a `folder` is all of the recipe transfer, as it is now."""
    from datagen.recipes.recipe import load_recipe

    manifest, recipe = Corpus(folder).manifest, load_recipe("transfer")
    if manifest.identity.recipe_hash != recipe.short_hash:
        raise BadInput("this is no corpus of the recipe transfer as it is now", file=str(folder))
    if manifest.records < manifest.recipe_records:
        problem = f"this corpus has {manifest.records} of {manifest.recipe_records} records"
        raise BadInput(problem, file=str(folder), allowed="all of the recipe transfer")


def main(arguments: Sequence[str] | None = None) -> int:
    """Keep the rows of a corpus; exit code 0, or 2 with a message."""
    parser = argparse.ArgumentParser(prog="python -m datagen.benchmark.kept_rows", description=__doc__)
    parser.add_argument("corpus", type=Path, help="folder of a whole corpus of the recipe transfer")
    folder = parser.parse_args(arguments).corpus
    try:
        _require_whole_transfer(folder)
        kept = keep(folder)
    except BadInput as problem:
        print_error(problem)
        return BAD_INPUT
    print(f"kept the rows of {counted(kept, 'record')} in {KEPT_FILE.name}, {KEPT_FILE.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
