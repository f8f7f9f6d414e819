"""The features of corpora as a table for people: what `classify` judges and learns from, beside the labels."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.benchmark.corpus_rows import read_records
from datagen.benchmark.options import Learning
from datagen.benchmark.plan import reading_of, training_reading_of
from datagen.benchmark.record_rows import RecordFacts, RecordRows, Row
from datagen.benchmark.request import require_bandwidth
from datagen.benchmark.truth import true_classes
from datagen.corpus import Corpus
from datagen.corpus_files.index import no_records
from datagen.errors import BadInput
from datagen.judging.splits import ALL, require_split
from datagen.progress import SILENT, Listener
from labels.features.table import FEATURE_NAMES
from physics.angular_speed import RPM_PER_HZ

if TYPE_CHECKING:
    import pandas

LABELS_SHOWN = (
    "record",
    "part",
    "recording",
    "channel",
    "split",
    "rig",
    "bearing",
    "bearing_id",
    "condition",
    "location",
    "extent_mm",
    "extent_spacing",
    "depth",
    "speed_rpm",
    "speed_basis",
    "load_n",
    "rate_hz",
    "duration_s",
    "snr_db",
)
OF_RECORD = ("reason", *RecordFacts().shown())
OF_ROW = ("axis", "window", "noisy", *OF_RECORD, "found_speed_rpm")
COLUMNS = ("corpus", *LABELS_SHOWN, "class", *OF_ROW, *FEATURE_NAMES)


def feature_table(
    folders: Sequence[str | Path],
    split: str = ALL,
    bandwidth: float | None = None,
    as_learned: bool = False,
    workers: int = 1,
    listener: Listener = SILENT,
) -> pandas.DataFrame:
    """The features of every record of the corpora in `folders`, with COLUMNS: a row for each axis and window.

    A window is a record, or an equal piece of one longer than 10.5 s. The rows are those by which `classify` judges; if
    `as_learned` those that it learns from: at a speed and a bandwidth that are off, and with noisy copies. Of a record
    that it does not judge there is one row with the `reason` and without features, unless it learns from it. `split` is
    "all" or one split; `bandwidth` (Hz) limits all records.

    Raises BadInput for a folder without a corpus, or without records of the split, or given twice, and for a bandwidth
    below 1 kHz.
    """
    import pandas

    require_bandwidth(bandwidth)
    chosen = [(folder, _labels(folder, split)) for folder in map(Path, folders)]
    _require_distinct([folder for folder, _ in chosen])
    learning = Learning(bandwidth=bandwidth)
    reading = training_reading_of(learning) if as_learned else reading_of(learning)
    rows: list[tuple[Any, ...]] = []
    for folder, labels in chosen:
        count = listener.counting(f"features of {folder.name}")
        found = read_records(folder, labels["record"].to_numpy(np.int64), reading, workers, count)
        rows += _corpus_rows(folder, labels, found, as_learned)
    return pandas.DataFrame(rows, columns=list(COLUMNS))


def _labels(folder: Path, split: str) -> pandas.DataFrame:
    """Labels of the records of a split of the corpus in `folder`; raises BadInput where there are none."""
    labels = Corpus(folder).labels
    if labels.empty:
        raise no_records(folder)
    require_split(folder, labels["split"], split)
    return labels if split == ALL else labels[labels["split"] == split]


def _require_distinct(folders: Sequence[Path]) -> None:
    seen = set()
    for folder in folders:
        if folder.resolve() in seen:
            raise BadInput("this corpus is given twice", file=str(folder), allowed="each corpus once")
        seen.add(folder.resolve())


def _corpus_rows(
    folder: Path, labels: pandas.DataFrame, found: dict[int, RecordRows], as_learned: bool
) -> Iterator[tuple[Any, ...]]:
    """Rows of the table, in the order of the labels."""
    known, classes = labels[list(LABELS_SHOWN)].itertuples(index=False, name=None), true_classes(labels).tolist()
    axes = _axes_by_shard(folder, labels)
    for facts, class_, shard in zip(known, classes, labels["shard"], strict=True):
        of_record = found[int(facts[0])]
        for of_row in _record_rows(of_record, axes[shard], as_learned):
            yield (str(folder), *facts, class_, *of_row)


def _axes_by_shard(folder: Path, labels: pandas.DataFrame) -> dict[str, list[str]]:
    """Names of the axes of the records in each shard, which are the same for all of them."""
    with Corpus(folder) as corpus:
        first = labels.drop_duplicates("shard")
        return {str(shard): corpus.axes(record) for shard, record in zip(first["shard"], first["record"], strict=True)}


def _record_rows(found: RecordRows, axes: Sequence[str], as_learned: bool) -> Iterator[tuple[Any, ...]]:
    """What OF_ROW and the features are in each row of one record."""
    facts = found.facts
    of_record = (facts.reason, *facts.shown().values())
    if not found.rows or (facts.reason and not as_learned):
        nothing = [math.nan] * (1 + len(FEATURE_NAMES))
        yield ("", 0, False, *of_record, *nothing)
        return
    for row in found.rows:
        yield (axes[row.axis], row.window, row.noisy, *of_record, *_numbers(row))


def _numbers(row: Row) -> list[float]:
    return [RPM_PER_HZ * row.shaft_hz, *row.values.tolist()]


def rejections(table: pandas.DataFrame) -> dict[str, int]:
    """How many records of a feature table have each reason not to be judged."""
    of_records = table[table["reason"] != ""].drop_duplicates(["corpus", "record"])
    return {str(reason): int(count) for reason, count in of_records["reason"].value_counts().items()}
