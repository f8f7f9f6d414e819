"""Rows of the feature table of a corpus: one for each axis and window of a record, read shard by shard."""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import RecordFacts, RecordRows, feature_rows, record_rows
from datagen.benchmark.rows import Rows, joined
from datagen.corpus import Corpus
from datagen.corpus_files.index import read_index
from datagen.processes import processes
from datagen.progress import Count, ignore
from labels.features.turning import Turning
from labels.variables import SHAFT_ANGLE

if TYPE_CHECKING:
    import pandas

RECORDS_A_TASK = 24


@dataclass(frozen=True)
class CorpusRows:
    """The `rows` of features of records of a corpus, and the `facts` about each record by its index. `raw` are the
    windows of the same records, for models that take them instead."""

    rows: Rows
    facts: dict[int, RecordFacts] = field(default_factory=dict)
    raw: Rows | None = None

    def asked_for(self, windows: bool) -> Rows:
        """The raw windows if `windows` are asked for and there are any, else the rows of features."""
        return self.raw if windows and self.raw is not None else self.rows


def read_rows(
    folder: Path, records: NDArray[np.int64], reading: Reading, workers: int, count: Count = ignore
) -> CorpusRows:
    """Rows of the `records` of a corpus as one table; `count` is called with how many are done."""
    return rows_of_records(read_records(folder, records, reading, workers, count))


def read_records(
    folder: Path, records: NDArray[np.int64], reading: Reading, workers: int, count: Count
) -> dict[int, RecordRows]:
    """Rows of each of the `records` of a corpus, made by several processes, each with one waveform in memory; `count`
    is called with how many are done."""
    labels = read_index(folder).set_index("record", drop=False)
    parts = [records[start : start + RECORDS_A_TASK] for start in range(0, records.size, RECORDS_A_TASK)]
    tasks = [(part, labels[labels.index.isin(part)]) for part in parts]
    found: dict[int, RecordRows] = {}
    count(0, records.size)
    with closing(_results(folder, tasks, reading, workers)) as results:
        for part in results:
            found |= part
            count(len(found), records.size)
    return found


def rows_of_records(found: Mapping[int, RecordRows]) -> CorpusRows:
    """What was `found` in each record, by its index, as one table."""
    parts = [feature_rows(of.rows, record) for record, of in found.items()]
    return CorpusRows(joined([feature_rows([], 0), *parts]), {record: of.facts for record, of in found.items()})


def _results(
    folder: Path, tasks: Sequence[tuple[NDArray[np.int64], pandas.DataFrame]], reading: Reading, workers: int
) -> Generator[dict[int, RecordRows], None, None]:
    """What each task, some records and their labels, finds, in order, as it comes."""
    from joblib import Parallel, delayed

    if workers <= 1 or len(tasks) < 2:
        return (_task(folder, *task, reading) for task in tasks)
    with processes(workers):
        parallel = Parallel(batch_size=1, return_as="generator")
    results: Generator[dict[int, RecordRows], None, None] = parallel(
        delayed(_task)(folder, *task, reading) for task in tasks
    )
    return results


def _task(
    folder: Path, records: NDArray[np.int64], labels: pandas.DataFrame, reading: Reading
) -> dict[int, RecordRows]:
    with Corpus(folder) as corpus:
        if len(labels) == records.size:  # otherwise one is missing, which is told from the whole index
            corpus.labels = labels  # a large index takes long to read again for every task
        return {
            record: record_rows(corpus.waveform(record), labels.loc[record], reading, _turning(corpus, record))
            for record in records.tolist()
        }


def _turning(corpus: Corpus, record: int) -> Turning | None:
    """How the shaft of a record turns, if its speed is known to change."""
    return Turning(corpus.waveform(record, SHAFT_ANGLE.name)) if corpus.has(record, SHAFT_ANGLE.name) else None
