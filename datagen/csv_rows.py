"""The rows of a CSV file, each with the number of its line, for messages."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

from datagen.errors import BadInput

BLANKS = " "
Row = tuple[int, list[str]]


def read_csv_rows(path: Path, delimiter: str = ",", skip_lines: int = 0) -> list[Row]:
    """Each row of the file at `path` that is not blank: the number of its first line, from 1, and its cells.

    A `delimiter` of one space stands for any run of blanks, between which nothing is quoted; the first `skip_lines`
    are left out. A byte order mark is no matter. Raises BadInput, with the line where one is to blame, if this is no
    text or a quoted cell does not end as one should, and OSError if the file cannot be read.
    """
    with path.open(newline="", encoding="utf-8-sig") as file:
        try:
            lines = islice(file, skip_lines, None)
            rows = _split(lines) if delimiter == BLANKS else _parsed(lines, delimiter, path, skip_lines)
            return [(skip_lines + line, cells) for line, cells in rows if cells]
        except UnicodeDecodeError:
            raise BadInput("not a text file", str(path)) from None


def _split(lines: Iterator[str]) -> Iterator[Row]:
    return enumerate(map(str.split, lines), start=1)


def _parsed(lines: Iterator[str], delimiter: str, path: Path, skipped: int) -> Iterator[Row]:
    # Unless it is strict, a quote that is never closed makes the rest of the file one cell.
    reader = csv.reader(lines, delimiter=delimiter, strict=True)
    while True:
        first = reader.line_num + 1
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as problem:
            raise BadInput(f"not a row of a CSV table: {problem}", f"{path}, line {skipped + first}") from None
        yield first, cells
