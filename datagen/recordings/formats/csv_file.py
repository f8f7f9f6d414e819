"""Tables of text: one column a channel."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from datagen.csv_rows import read_csv_rows
from datagen.errors import BadInput
from datagen.recordings.formats.arrays import Arrays
from datagen.recordings.settings import CsvLayout


def read_csv(path: Path, layout: CsvLayout) -> Arrays:
    """The columns of a text table by name ("1", "2", … without a header); raises BadInput with the line.

    Cells that are no numbers are NaN; a column is refused for them only where it is used.
    """
    rows = read_csv_rows(path, layout.delimiter, layout.skip_lines)
    header, heads = rows.pop(0) if layout.header and rows else (0, [])
    names = [name.strip() for name in heads]
    twice = next((name for name in names if name and names.count(name) > 1), None)
    if twice is not None:
        raise BadInput(
            "this column is there twice", f"{path}, line {header}", twice,
            allowed='different names, or csv = {header = false, skip_lines = …}, which calls the columns "1", "2", …',
        )  # fmt: skip
    width = len(names) or (len(rows[0][1]) if rows else 0)
    names = names or [str(column) for column in range(1, width + 1)]
    for line, row in rows:
        if len(row) != width:
            raise BadInput(f"{len(row)} cells, but the table has {width} columns", f"{path}, line {line}")
    return {name: _numbers([row[place] for _, row in rows], layout.decimal) for place, name in enumerate(names)}


def _numbers(cells: list[str], decimal: str) -> np.ndarray:
    texts = np.array(cells if decimal == "." else [cell.replace(decimal, ".") for cell in cells], dtype=np.str_)
    try:
        return texts.astype(np.float64)
    except ValueError:
        return np.array([_number(text) for text in texts.tolist()])


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return float("nan")
