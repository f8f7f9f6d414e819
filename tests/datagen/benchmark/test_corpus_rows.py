"""The rows of a corpus, read by several processes."""

import numpy as np
import pytest

from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.reading_policy import Reading
from datagen.corpus_files.index import read_index

pytestmark = pytest.mark.usefixtures("short_records_are_judged")


@pytest.mark.parametrize("workers", [1, 2])
def test_how_many_records_are_read_is_told(workers, tiny_corpus, monkeypatch):
    monkeypatch.setattr("datagen.benchmark.corpus_rows.RECORDS_A_TASK", 5)
    counts = []
    found = read_rows(tiny_corpus, np.arange(14), Reading(), workers, lambda *pair: counts.append(pair))
    assert sorted(found.facts) == list(range(14))
    assert found.rows.axis.tolist() == [0, 1] * (len(found.rows) // 2)
    assert counts == [(0, 14), (5, 14), (10, 14), (14, 14)]


def test_the_index_is_read_once_however_many_tasks_there_are(tiny_corpus, monkeypatch):
    monkeypatch.setattr("datagen.benchmark.corpus_rows.RECORDS_A_TASK", 5)
    read = []
    for module in ("datagen.benchmark.corpus_rows", "datagen.corpus"):
        monkeypatch.setattr(f"{module}.read_index", lambda folder: read.append(folder) or read_index(folder))
    read_rows(tiny_corpus, np.arange(14), Reading(), 1)
    assert len(read) == 1
