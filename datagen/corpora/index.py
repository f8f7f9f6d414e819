"""The index of a corpus: a CSV table of all labels, one row a record, read without opening a shard."""

from __future__ import annotations

import csv
import heapq
import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.corpora.atomic import write_atomically
from datagen.corpora.shard import Sidecar, shard_path
from datagen.errors import BadInput
from labels.schema import LABELS

if TYPE_CHECKING:
    import pandas

PLACE_COLUMNS = ("shard", "position")
LABEL_COLUMNS = tuple(column for label in LABELS for column in label.columns)
COLUMN_TYPES = {column: label.dtype for label in LABELS for column in label.columns}
Row = tuple[Any, ...]


def index_path(folder: Path) -> Path:
    """Where the index of the corpus `folder` lies."""
    return folder / "index.csv"


def write_index(folder: Path, sidecars: Iterator[Sidecar]) -> int:
    """Write the index of the finished shards, in the order of the records; returns the number of rows.

    `shard` is the path of the record's file in the folder, `position` its place in that file, from 0.
    """
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow((*LABEL_COLUMNS, *PLACE_COLUMNS))
    count = 0
    for row in _in_order_of_records(sidecars, folder):
        table.writerow(row)
        count += 1
    write_atomically(index_path(folder), text.getvalue().encode())
    return count


def _in_order_of_records(sidecars: Iterator[Sidecar], folder: Path) -> Iterator[Row]:
    """Rows of all shards by record, with only those shards in memory whose records interleave."""
    open_shards: list[tuple[int, int, Iterator[Row], Row]] = []
    for sidecar in sidecars:
        if not sidecar.records:
            continue
        while open_shards and open_shards[0][0] < sidecar.records[0]:
            yield _next_row(open_shards)
        rows = _rows(sidecar, folder)
        heapq.heappush(open_shards, (sidecar.records[0], sidecar.shard, rows, next(rows)))
    while open_shards:
        yield _next_row(open_shards)


def _next_row(open_shards: list[tuple[int, int, Iterator[Row], Row]]) -> Row:
    _, shard, rows, row = open_shards[0]
    following = next(rows, None)
    if following is None:
        heapq.heappop(open_shards)
    else:
        heapq.heapreplace(open_shards, (following[0], shard, rows, following))
    return row


def _rows(sidecar: Sidecar, folder: Path) -> Iterator[Row]:
    name = shard_path(folder, sidecar.shard).relative_to(folder).as_posix()
    columns = [sidecar.labels[column] for column in LABEL_COLUMNS]
    for position in range(len(sidecar.records)):
        yield (*("NaN" if column[position] is None else column[position] for column in columns), name, position)


def read_index(folder: Path) -> pandas.DataFrame:
    """The index as a table of `labels.schema`'s columns and types, in the order of the records; raises BadInput.

    A column of counts that are not all known holds floats with NaN, one of truth values objects with NaN.
    """
    import pandas

    path = index_path(folder)
    try:
        with path.open(newline="") as file:
            header, *rows = csv.reader(file)
        texts = dict(zip(header, zip(*rows, strict=True), strict=True)) if rows else dict.fromkeys(header, ())
        columns = {name: _typed(texts[name], kind) for name, kind in COLUMN_TYPES.items()}
        table = pandas.DataFrame(columns | {"shard": texts["shard"], "position": _typed(texts["position"], "int64")})
    except FileNotFoundError:
        raise BadInput("this folder has no index.csv; it is no corpus, or an interrupted one", str(folder)) from None
    except (OSError, ValueError, KeyError) as problem:
        raise BadInput(f"not an index of labels: {problem!r}", str(path)) from None
    return table.sort_values("record", ignore_index=True)


def _typed(texts: tuple[str, ...], kind: str) -> NDArray[Any] | list[str]:
    if kind == "str":
        return list(texts)
    unknown = "NaN" in texts
    if kind == "bool":
        values = [{"True": True, "False": False, "NaN": math.nan}[text] for text in texts]
        return np.array(values, dtype=object if unknown else np.bool_)
    return np.array(texts, dtype=np.str_).astype("float64" if unknown else kind)
