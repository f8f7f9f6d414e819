"""Tables of text: one column a channel."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Container, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from datagen.errors import BadInput, at_line
from datagen.files.csv_rows import BLANKS, BROKEN, NotText, Row, open_text, read_csv_rows
from datagen.files.number_texts import may_be_parted, number
from datagen.formats.csv_hints import (
    DECIMAL_COMMA,
    THOUSANDS,
    above_hint,
    cells_hint,
    delimiter_hint,
    headless_hint,
    refuse_halves,
    refuse_split_numbers,
    titled_hint,
)
from datagen.formats.csv_layout import CsvLayout
from physics.arrays import Array

# How packed files and workbooks begin: zip (.xlsx too), 7z, rar, OLE (.xls).
PACKED = (b"\xd0\xcf\x11\xe0", b"PK\x03\x04", b"7z\xbc\xaf\x27\x1c", b"Rar!")

# What is allowed where a row has more or fewer cells than there are columns.
ROWS_ALIKE = (
    "as many in every row; csv.skip_lines leaves out what is above the table, csv.skip_below what is between header "
    "and numbers, and csv.header = false with skip_lines a header that names more or fewer columns than there are"
)


# What text tables have where a sample is missing.
EMPTY = ("", "nan", "na", "n/a", "null", "none", "-")
Cell = tuple[int, str]


class Columns(dict[str, Array]):
    """The columns of a table by name, NaN where a cell is no number: one is refused for them only where it is used.

    `odd` holds line and text of the first cell of each column that is no finite number, `worded` those of the first one
    that is not EMPTY either; `hint` is a closing remark for messages where the table seems to have another layout, else
    empty.
    """

    def __init__(
        self, columns: dict[str, Array], odd: dict[str, Cell], worded: dict[str, Cell] | None = None, hint: str = ""
    ) -> None:
        super().__init__(columns)
        self.odd, self.worded, self.hint = odd, worded or {}, hint


def read_csv(path: Path, layout: CsvLayout) -> Columns:
    """The columns of a text table by name ("1", "2", … without a header); raises BadInput with the line."""
    _refuse_packed(path)
    try:
        refuse_halves(path, layout)
        clean = _clean_table(path, layout)
        if clean is not None:
            return clean
        rows = read_csv_rows(path, layout.delimiter, layout.skip_lines, layout.encoding, blank=True)
        return _columns(path, layout, _without_blanks(rows, layout))
    except NotText:
        raise BadInput(
            "is not text in this encoding", file=str(path), field="csv.encoding", value=layout.encoding,
            allowed='the encoding of the file, such as "latin-1" or "utf-16"',
        ) from None  # fmt: skip


def _refuse_packed(path: Path) -> None:
    with path.open("rb") as file:
        if file.read(max(map(len, PACKED))).startswith(PACKED):
            raise BadInput("is packed or a workbook, not text", file=str(path), allowed="the table as text, unpacked")


def _clean_table(path: Path, layout: CsvLayout) -> Columns | None:
    """The columns of a table whose columns hold either nothing but finite numbers below its header or no number at all,
    as clocks do, or lack one in one of the first two rows, up to ten times as fast and in less than half of the memory;
    None of any other.

    A delimiter may end each row: the last column is then empty.
    """
    head = layout.head_rows
    rows = read_csv_rows(path, layout.delimiter, layout.skip_lines, layout.encoding, most=head + 2)
    if len(rows) <= head:
        return None
    line, cells = rows[head]
    shape = _shape(rows[head:], layout)
    if shape.words:
        refuse_split_numbers(path, line, cells, layout)
    converters = shape.converters()
    table = _loaded(path, layout, rows[head - 1][0] if head else layout.skip_lines, converters)
    if table is None or (table.shape[1] == 1 and _has_gaps(path, layout, line)):
        return None
    names, width = _without_end(_names(path, rows[0], layout, table.shape[1]), table.shape[1], shape.ends_empty)
    numbers = [column for column in range(table.shape[1]) if column not in converters]
    if len(names) != width or not numbers or not np.isfinite(table[:, numbers]).all():
        return None
    table = table[:, :width]
    first = dict.fromkeys(shape.words + [shape.last] * shape.ends_empty, (line, cells)) | shape.gaps
    odd = {names[column]: (where, row[column]) for column, (where, row) in first.items() if column < width}
    worded = {name: cell for name, cell in odd.items() if not _is_empty(cell[1])}
    columns = dict(zip(names, np.ascontiguousarray(table.T), strict=True))
    return Columns(columns, odd, worded, headless_hint(names, layout))


@dataclass(frozen=True)
class _Shape:
    """What the first rows tell of a table's columns, up to the `last`: which hold `words`, which have `gaps`, with the
    first row that has one, and whether the table `ends_empty` in the last, as where a delimiter ends each row."""

    last: int
    words: list[int]
    gaps: dict[int, Row]
    ends_empty: bool

    def converters(self) -> dict[int | str, Callable[[str], float]]:
        """How the cells of each column that is not made of numbers alone are read."""
        found: dict[int | str, Callable[[str], float]] = dict.fromkeys(self.words, _no_number)
        found |= dict.fromkeys(self.gaps, _number_or_nothing)
        return found | ({self.last: _nothing} if self.ends_empty else {})


def _shape(rows: list[Row], layout: CsvLayout) -> _Shape:
    """The shape of a table that begins with these `rows`, at least one."""
    cells = rows[0][1]
    last = len(cells) - 1
    ends_empty = bool(last) and not cells[last].strip()
    counted = cells[:last] if ends_empty else cells
    gaps = _gaps(rows, len(counted))
    return _Shape(last, _columns_of_words(counted, layout, gaps), gaps, ends_empty)


def _loaded(
    path: Path, layout: CsvLayout, skip: int, converters: dict[int | str, Callable[[str], float]]
) -> Array | None:
    """The cells (rows, columns) below the first `skip` lines as numbers, those of some columns by their `converters`;
    None if one is none."""
    try:
        with open_text(path, layout.encoding) as file, warnings.catch_warnings(action="ignore"):
            return np.loadtxt(
                _lines(file, layout.decimal), delimiter=None if layout.delimiter == BLANKS else layout.delimiter,
                comments=None, skiprows=skip, ndmin=2, converters=converters or None,
            )  # fmt: skip
    except (ValueError, TypeError, *BROKEN):
        return None


def _has_gaps(path: Path, layout: CsvLayout, first: int) -> bool:
    """Whether a line is blank after line number `first`, from 1, and before the last that is not."""
    with open_text(path, layout.encoding) as file:
        full = [number for number, text in enumerate(file, start=1) if number >= first and text.strip()]
    return full[-1] - first >= len(full)


def _without_blanks(rows: list[Row], layout: CsvLayout) -> list[Row]:
    """The rows that are not blank; a blank one between the numbers of a table of one column is an empty cell."""
    full = [row for row in rows if row[1]]
    head = layout.head_rows
    if len(full) <= head or len(full[0][1]) > 1:
        return full
    first, last = full[head][0], full[-1][0]
    return full[:head] + [(line, cells or [""]) for line, cells in rows if first <= line <= last]


def _gaps(rows: list[Row], width: int) -> dict[int, Row]:
    """Which of the first `width` columns are empty in one of the `rows`, and the first of these."""
    empty = [(column, row) for row in rows for column, cell in enumerate(row[1][:width]) if not cell.strip()]
    return dict(reversed(empty))


def _columns_of_words(cells: list[str], layout: CsvLayout, gaps: Container[int]) -> list[int]:
    """Which of the first row's `cells`, but for the `gaps`, are words that no other layout of the table would make
    numbers."""
    words = [
        column for column, cell in enumerate(cells) if column not in gaps and not math.isfinite(layout.number(cell))
    ]
    told = [cells[column].strip() for column in words]
    if any('"' in cell or DECIMAL_COMMA.fullmatch(cell) or THOUSANDS.fullmatch(cell) for cell in told):
        return []
    return words


def _no_number(cell: str) -> float:
    if math.isfinite(number(cell)):
        raise ValueError(cell)
    return math.nan


def _number_or_nothing(cell: str) -> float:
    if not cell.strip():
        return math.nan
    if not math.isfinite(found := number(cell)):
        raise ValueError(cell)
    return found


def _is_empty(cell: str) -> bool:
    return cell.strip().lower() in EMPTY


def _nothing(cell: str) -> float:
    if cell.strip():
        raise ValueError(cell)
    return math.nan


def _lines(lines: Iterator[str], decimal: str) -> Iterator[str]:
    return lines if decimal == "." else (line.replace(decimal, ".") for line in lines)


def _names(path: Path, head: Row, layout: CsvLayout, width: int) -> list[str]:
    if not layout.header:
        return [str(column) for column in range(1, width + 1)]
    names = [name.strip() for name in head[1]]
    twice = next((name for name in names if name and names.count(name) > 1), None)
    if twice is not None:
        raise BadInput(
            "this column occurs twice", file=at_line(path, head[0]), field=twice,
            allowed='different names, or csv = {header = false, skip_lines = …}, which calls the columns "1", "2", …',
        )  # fmt: skip
    return names


def _without_end(names: list[str], width: int, empty: bool) -> tuple[list[str], int]:
    """The names of a table's columns, and of its `width` cells in each row as many as count, without one last cell that
    is nothing but a delimiter at the end of the header alone, or of all rows alone, where the last is `empty`."""
    if width == len(names) + 1 and empty:
        return names, width - 1
    if width == len(names) - 1 and not names[-1]:
        return names[:-1], width
    return names, width


def _columns(path: Path, layout: CsvLayout, rows: list[Row]) -> Columns:
    """The columns of any table, cell by cell."""
    if not rows:
        return Columns({}, {})
    names = _names(path, rows[0], layout, len(rows[0][1]))
    whole, rows = rows, rows[layout.head_rows :]
    if rows:
        refuse_split_numbers(path, *rows[0], layout)
    if len({len(row) for _, row in rows}) == 1:
        names, width = _without_end(names, len(rows[0][1]), not any(row[-1].strip() for _, row in rows))
        rows = [(line, row[:width]) for line, row in rows] if width < len(rows[0][1]) else rows
    for line, row in rows:
        if len(row) != len(names):
            hint = delimiter_hint(row, rows[len(rows) // 2][1], layout) if len(names) == 1 else ""
            hint = hint or titled_hint(rows, layout)
            problem = f"{len(row)} cells, but the table has {len(names)} columns{hint or above_hint(whole, layout)}"
            raise BadInput(problem, file=at_line(path, line), allowed="" if hint else ROWS_ALIKE)
    columns = {name: _numbers([row[place] for _, row in rows], layout.decimal) for place, name in enumerate(names)}
    odd: dict[str, Cell] = {}
    worded: dict[str, Cell] = {}
    for name, numbers in columns.items():
        place = names.index(name)
        for k in np.flatnonzero(~np.isfinite(numbers)).tolist():
            cell = rows[k][0], rows[k][1][place]
            odd.setdefault(name, cell)
            if not _is_empty(cell[1]):
                worded[name] = cell
                break
    return Columns(columns, odd, worded, cells_hint(rows, columns, odd, layout))


def _numbers(cells: list[str], decimal: str) -> Array:
    texts = cells if decimal == "." else [cell.replace(decimal, ".") for cell in cells]
    try:
        if not any(map(may_be_parted, texts)):
            return np.array(texts, dtype=np.str_).astype(np.float64)
    except ValueError:
        pass  # some of them are no numbers
    return np.array([number(text) for text in texts])
