"""The labels of a corpus in the words of the package `bearing-datasets`: a CSV table, one row a signal."""

from __future__ import annotations

from typing import Any

from datagen.corpus import Corpus
from datagen.files.text_tables import csv_text
from labels.vocabulary import common_row

ONLY_GROUP = 0  # a file of that package has several groups of rows, a shard one


def vocabulary_table(corpus: Corpus) -> str:
    """The table as CSV text; a column that is not known for every signal is left out, as that vocabulary asks."""
    rows: list[dict[str, Any]] = []
    for labels in corpus.labels.to_dict("records"):
        place = {
            "dataset": corpus.manifest.name,
            "signal_file": labels["shard"],
            "signal_row_group": ONLY_GROUP,
            "signal_row": labels["position"],
        }
        rows += [common_row(labels, axis) | place for axis in corpus.axes(labels["record"])]
    known = [name for name in (rows[0] if rows else ()) if all(row[name] == row[name] for row in rows)]
    columns = [name for name in known if name != "load_unit" or "load" in known]
    return csv_text(columns, ([row[name] for name in columns] for row in rows))
