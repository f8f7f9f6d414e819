"""The index of a corpus: a CSV table of all labels, one row a record, read without opening a shard."""

from __future__ import annotations

import csv
import heapq
import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from datagen.corpus_files.manifest import no_corpus
from datagen.corpus_files.shard import LABEL_COLUMNS, Sidecar, shard_name
from datagen.errors import BadInput, at_line, unreadable
from datagen.files.atomic import opened_atomically
from datagen.files.places import INDEX
from labels.schema import LABELS

if TYPE_CHECKING:
    import pandas

PLACE_COLUMNS = ("shard", "position")
COLUMN_TYPES = {column: label.dtype for label in LABELS for column in label.columns}
PLACE_TYPES = {"shard": "str", "position": "int64"}
SHARD_NAME = r"shards/shard_\d{6,}\.nc"
WORDS = {"float64": "number", "int64": "whole number", "bool": "truth value, True or False"}
Row = tuple[Any, ...]


def index_path(folder: Path) -> Path:
    """Where the index of the corpus `folder` lies."""
    return folder / INDEX


def no_records(folder: Path, field: str = "") -> BadInput:
    """The refusal of a corpus without records, which the option `field` names."""
    return BadInput("this corpus has no records", file=str(folder), field=field)


def write_index(folder: Path, sidecars: Iterator[Sidecar]) -> int:
    """Write the index of the finished shards, in the order of the records; returns the number of rows.

    The `sidecars` must come in the order of the first record that each was asked for. The column `shard` is the path of
    the record's file in the folder, `position` the record's place in that file, from 0.
    """
    count = 0
    with opened_atomically(index_path(folder)) as file:
        text = io.TextIOWrapper(file, encoding="utf-8", newline="")
        table = csv.writer(text, lineterminator="\n")
        table.writerow((*LABEL_COLUMNS, *PLACE_COLUMNS))
        for row in _in_order_of_records(sidecars):
            table.writerow(row)
            count += 1
        text.detach()
    return count


class _OpenShard(NamedTuple):
    """A shard whose rows are being merged: its next `row`, the `record` of that, and the `later` rows.

    As entries of a heap they are ordered by record; no two have the same `record` and `shard`, so rows are never
    compared.
    """

    record: int
    shard: int
    row: Row
    later: Iterator[Row]


def _in_order_of_records(sidecars: Iterator[Sidecar]) -> Iterator[Row]:
    """Rows of all shards by record, holding only shards whose records interleave in memory."""
    open_shards: list[_OpenShard] = []
    for sidecar in sidecars:
        if not sidecar.records:
            continue
        # The first record that a shard was asked for may be one that could not be made.
        while open_shards and open_shards[0].record < min(sidecar.settled):
            yield _next_row(open_shards)
        rows = _rows(sidecar)
        heapq.heappush(open_shards, _OpenShard(sidecar.records[0], sidecar.shard, next(rows), rows))
    while open_shards:
        yield _next_row(open_shards)


def _next_row(open_shards: list[_OpenShard]) -> Row:
    """The row of the lowest record; its shard goes on to the next one, or is done."""
    first = open_shards[0]
    following = next(first.later, None)
    if following is None:
        heapq.heappop(open_shards)
    else:
        heapq.heapreplace(open_shards, first._replace(record=following[0], row=following))
    return first.row


def _rows(sidecar: Sidecar) -> Iterator[Row]:
    name = shard_name(sidecar.shard)
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
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except (FileNotFoundError, NotADirectoryError):
        raise no_corpus(folder, path.name) from None
    except OSError as problem:
        raise unreadable(path, problem) from None
    except (UnicodeDecodeError, csv.Error):
        raise _no_index("not a table of text", path) from None
    texts = _columns(rows, path)
    kinds = COLUMN_TYPES | PLACE_TYPES
    table = pandas.DataFrame({name: _checked(name, texts[name], kind, path) for name, kind in kinds.items()})
    _check_rows(table, path)
    return table.sort_values("record", ignore_index=True)


def _check_rows(table: pandas.DataFrame, path: Path) -> None:
    """Raise BadInput unless every record is there once, at a place that a shard can have, with what every record has
    and words of the closed lists."""
    rules = [
        ("record", ~(table["record"] >= 0), "is not a place in a corpus"),
        ("record", table["record"].duplicated(), "occurs twice"),
        ("shard", ~table["shard"].astype(str).str.fullmatch(SHARD_NAME), "is not a place in a corpus"),
        ("position", ~(table["position"] >= 0), "is not a place in a corpus"),
        *((name, ~(table[name] > 0.0), "is not above 0") for name in ("rate_hz", "duration_s")),
        *(
            (label.name, ~table[label.name].isin((*label.values, *label.imported)), "is none of its values")
            for label in LABELS
            if label.values is not None
        ),
    ]
    for column, rows, problem in rules:
        if rows.any():
            first = int(rows.to_numpy().argmax())
            raise _no_index(f"{column} = {table[column].iloc[first]} {problem}", path, first + 2)


def _columns(rows: list[list[str]], path: Path) -> dict[str, tuple[str, ...]]:
    """The cells of each column by name; BadInput for a ragged table or one that lacks a column."""
    header = rows[0] if rows else []
    missing = [name for name in (*LABEL_COLUMNS, *PLACE_COLUMNS) if name not in header]
    if missing:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        raise _no_index(f'it lacks the column "{missing[0]}"{more}', path)
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise _no_index(f"{len(row)} cells, but the table has {len(header)} columns", path, line)
    return dict(zip(header, zip(*rows[1:], strict=True), strict=True)) if len(rows) > 1 else dict.fromkeys(header, ())


def _checked(name: str, texts: tuple[str, ...], kind: str, path: Path) -> NDArray[Any] | list[str]:
    try:
        return _typed(texts, kind)
    except (ValueError, KeyError, OverflowError):
        line, text = next((k, text) for k, text in enumerate(texts, start=2) if not _is_one(text, kind))
        raise _no_index(f'{name} = "{text}" is not a {WORDS[kind]}', path, line) from None


def _is_one(text: str, kind: str) -> bool:
    try:
        _typed((text,), kind)
    except (ValueError, KeyError, OverflowError):
        return False
    return True


def _no_index(problem: str, path: Path, line: int = 0) -> BadInput:
    remedy = "delete it and generate again into the same folder, which writes it again (recordings: import again)"
    return BadInput(f"not the index of a corpus: {problem}; {remedy}", file=at_line(path, line))


def _typed(texts: tuple[str, ...], kind: str) -> NDArray[Any] | list[str]:
    if kind == "str":
        return list(texts)
    unknown = "NaN" in texts
    if kind == "bool":
        values = [{"True": True, "False": False, "NaN": math.nan}[text] for text in texts]
        return np.array(values, dtype=object if unknown else np.bool_)
    numbers = np.array(texts, dtype=np.str_).astype("float64" if unknown else kind)
    if np.isinf(numbers).any():
        raise ValueError("no label is infinite")
    return numbers
