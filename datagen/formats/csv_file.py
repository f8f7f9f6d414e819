"""Tables of text: one column a channel."""

from __future__ import annotations

import json
import math
import re
import warnings
from collections.abc import Callable, Container, Iterator
from itertools import takewhile
from pathlib import Path

import numpy as np

from datagen.errors import BadInput
from datagen.files.csv_rows import BLANKS, NotText, Row, open_text, read_csv_rows
from datagen.formats.csv_layout import CsvLayout
from physics.arrays import Array

DELIMITERS = (";", "\t", "|", ",", BLANKS)
DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")
# A number with signs between its thousands and another before its decimals.
THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}([,.' \xa0])\d{3}(?:\1\d{3})*(?!\1)[.,]\d+")
WHOLE_NUMBER = re.compile(r"[-+]?\d+")
# Digits behind a decimal sign: no whole number that is written alone begins with 0.
FRACTION = re.compile(r"0\d+")
# Rows of a table that show whether its commas are decimal signs.
ROWS_SHOWN = 256
ONE_COLUMN = '; did you mean csv = {delimiter = ";", decimal = ","}?'
# How compressed and packed files begin: gzip, zip (spreadsheets too), 7z, rar.
PACKED = (b"\x1f\x8b", b"PK\x03\x04", b"7z\xbc\xaf\x27\x1c", b"Rar!")

# What is allowed where a row has more or fewer cells than there are columns.
ROWS_ALIKE = (
    "as many in every row; csv.skip_lines leaves out what is above the table, csv.skip_below what is between header "
    "and numbers, and csv.header = false with skip_lines a header that names more or fewer columns than there are"
)


class Columns(dict[str, Array]):
    """The columns of a table by name, NaN where a cell is no number: one is refused for them only where it is used.

    `odd` holds line and text of the first cell of each column that is no finite number; `hint` is a closing remark for
    messages where the table seems to have another layout, else empty.
    """

    def __init__(self, columns: dict[str, Array], odd: dict[str, tuple[int, str]], hint: str = "") -> None:
        super().__init__(columns)
        self.odd, self.hint = odd, hint


def read_csv(path: Path, layout: CsvLayout) -> Columns:
    """The columns of a text table by name ("1", "2", … without a header); raises BadInput with the line."""
    _refuse_packed(path)
    try:
        _refuse_halves(path, layout)
        clean = _clean_table(path, layout)
        if clean is not None:
            return clean
        rows = read_csv_rows(path, layout.delimiter, layout.skip_lines, layout.encoding, blank=True)
        return _columns(path, layout, _without_blanks(rows, layout))
    except NotText:
        raise BadInput(
            "is not text in this encoding", str(path), "csv.encoding", layout.encoding,
            'the encoding of the file, such as "latin-1" or "utf-16"',
        ) from None  # fmt: skip


def _refuse_packed(path: Path) -> None:
    with path.open("rb") as file:
        if file.read(max(map(len, PACKED))).startswith(PACKED):
            raise BadInput("is compressed or packed, not text", str(path), allowed="the file as text, unpacked")


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
    last = len(cells) - 1
    is_empty = bool(last) and not cells[last].strip()
    gaps = _gaps(rows[head:], last if is_empty else len(cells))
    words = _columns_of_words(cells[:last] if is_empty else cells, layout, gaps)
    if words:
        _refuse_split_numbers(path, line, cells, layout)
    converters: dict[int | str, Callable[[str], float]] = dict.fromkeys(words, _no_number)
    converters |= dict.fromkeys(gaps, _number_or_nothing)
    if is_empty:
        converters[last] = _nothing
    try:
        with open_text(path, layout.encoding) as file, warnings.catch_warnings(action="ignore"):
            table = np.loadtxt(
                _lines(file, layout.decimal), delimiter=None if layout.delimiter == BLANKS else layout.delimiter,
                comments=None, skiprows=rows[head - 1][0] if head else layout.skip_lines, ndmin=2,
                converters=converters or None,
            )  # fmt: skip
    except (ValueError, TypeError):
        return None
    if table.shape[1] == 1 and _has_gaps(path, layout, line):
        return None
    names, width = _without_end(_names(path, rows[0], layout, table.shape[1]), table.shape[1], is_empty)
    numbers = [column for column in range(table.shape[1]) if column not in converters]
    if len(names) != width or not numbers or not np.isfinite(table[:, numbers]).all():
        return None
    table = table[:, :width]
    first = dict.fromkeys(words + [last] * is_empty, (line, cells)) | gaps
    odd = {names[column]: (where, row[column]) for column, (where, row) in first.items() if column < width}
    return Columns(dict(zip(names, np.ascontiguousarray(table.T), strict=True)), odd, _headless_hint(names, layout))


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
    plain = [cell.replace(layout.decimal, ".") for cell in cells]
    words = [column for column, cell in enumerate(plain) if column not in gaps and not math.isfinite(_number(cell))]
    told = [cells[column].strip() for column in words]
    if any('"' in cell or DECIMAL_COMMA.fullmatch(cell) for cell in told):
        return []
    return words


def _no_number(cell: str) -> float:
    if math.isfinite(_number(cell)):
        raise ValueError(cell)
    return math.nan


def _number_or_nothing(cell: str) -> float:
    if not cell.strip():
        return math.nan
    if not math.isfinite(number := float(cell)):
        raise ValueError(cell)
    return number


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
            "this column occurs twice", f"{path}, line {head[0]}", twice,
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
        _refuse_split_numbers(path, *rows[0], layout)
    if len({len(row) for _, row in rows}) == 1:
        names, width = _without_end(names, len(rows[0][1]), not any(row[-1].strip() for _, row in rows))
        rows = [(line, row[:width]) for line, row in rows] if width < len(rows[0][1]) else rows
    for line, row in rows:
        if len(row) != len(names):
            middle = rows[len(rows) // 2][1]
            parted = _hint(layout.delimiter.join(row), layout.delimiter.join(middle), layout)
            hint = parted if len(names) == 1 else ""
            problem = f"{len(row)} cells, but the table has {len(names)} columns{hint or _above_hint(whole, layout)}"
            allowed = "" if hint else ROWS_ALIKE
            raise BadInput(problem, f"{path}, line {line}", allowed=allowed)
    columns = {name: _numbers([row[place] for _, row in rows], layout.decimal) for place, name in enumerate(names)}
    first = {name: int(np.argmin(np.isfinite(numbers))) for name, numbers in columns.items() if numbers.size}
    odd = {
        name: (rows[k][0], rows[k][1][names.index(name)])
        for name, k in first.items()
        if not math.isfinite(columns[name][k])
    }
    told = [cell.strip() for _, cell in odd.values()]
    hint = _headless_hint(names, layout) or _decimal_hint(told, layout) or _thousands_hint(told)
    above_numbers = max((_words_above(text, columns[name]) for name, (_, text) in odd.items()), default=0)
    if not hint and above_numbers and not layout.header:
        hint = f"; did you mean csv = {{skip_lines = {rows[above_numbers - 1][0]}}}?"
    elif not hint and above_numbers == 1:
        hint = f"; did you mean csv = {{skip_below = {layout.skip_below + 1}}}?"
    if len(names) == 1 and odd and odd[names[0]][0] == rows[0][0]:
        hint = _hint(odd[names[0]][1], rows[len(rows) // 2][1][0], layout) or hint
    return Columns(columns, odd, hint)


def _refuse_split_numbers(path: Path, line: int, row: list[str], layout: CsvLayout) -> None:
    """Refuse a `row` that was parted at the decimal commas of its numbers, of which some cells would hold a half."""
    if layout.delimiter != ",":
        return
    whole = ",".join(row)
    for sign in DELIMITERS:
        cells = [cell.strip() for cell in _parts(whole, sign) if cell.strip()]
        broken = [cell for cell in cells if DECIMAL_COMMA.fullmatch(cell)]
        numbers = len(broken) + sum(bool(WHOLE_NUMBER.fullmatch(cell)) for cell in cells)
        # Blanks part words too: among them one number with a comma proves nothing.
        if sign != "," and numbers == len(cells) > 1 and len(broken) > (sign == BLANKS):
            raise BadInput(
                "these commas seem to be decimal signs"
                f'; did you mean csv = {{delimiter = {json.dumps(sign)}, decimal = ","}}?',
                f"{path}, line {line}", "csv.delimiter", ",",
            )  # fmt: skip


def _refuse_halves(path: Path, layout: CsvLayout) -> None:
    """Refuse a table without header whose numbers were all parted at their decimal commas, into whole numbers."""
    if layout.header or layout.delimiter != ",":
        return
    rows = read_csv_rows(path, ",", layout.skip_lines, layout.encoding, most=ROWS_SHOWN)
    cells = [[cell.strip() for cell in row] for _, row in rows]
    width = len(cells[0]) if cells else 1
    if width % 2 or not all(len(row) == width and all(map(WHOLE_NUMBER.fullmatch, row)) for row in cells):
        return
    fractions = list(zip(*cells, strict=True))[1::2]
    if all(column[0].isdigit() and any(map(FRACTION.fullmatch, column)) for column in fractions):
        raise BadInput(
            f"these commas seem to be decimal signs{ONE_COLUMN if width == 2 else ''}", f"{path}, line {rows[0][0]}",
            "csv.delimiter", ",", "" if width == 2 else "another delimiter than the decimal sign, in the file itself",
        )  # fmt: skip


def _words_above(text: str, column: Array) -> int:
    """How many cells that are no numbers, such as units, names or comments of which the first is `text`, are above a
    `column` of nothing but numbers; 0 if it is none, or these are not most of it."""
    count = int(np.argmax(np.isfinite(column)))
    return count if text.strip() and count < column.size / 2 and np.isfinite(column[count:]).all() else 0


def _above_hint(rows: list[Row], layout: CsvLayout) -> str:
    """A remark on how many lines are above those `rows`, most of all, that have as many cells as the last; empty if
    there are none."""
    width = len(rows[-1][1])
    table = rows[len(rows) - sum(1 for _ in takewhile(lambda row: len(row[1]) == width, reversed(rows))) :]
    if not len(rows) / 2 < len(table) < len(rows):
        return ""
    line, cells = table[0]
    headless = layout.header and any(math.isfinite(_number(cell.replace(layout.decimal, "."))) for cell in cells)
    return f"; did you mean csv = {{{'header = false, ' * headless}skip_lines = {line - 1}}}?"


def _headless_hint(names: list[str], layout: CsvLayout) -> str:
    """A remark for a table whose column names are all numbers; empty for any other."""
    if not layout.header or not all(math.isfinite(_number(name.replace(layout.decimal, "."))) for name in names):
        return ""
    return "; did you mean csv = {header = false}?"


def _decimal_hint(cells: list[str], layout: CsvLayout) -> str:
    """A remark where a cell that is no number would be one with a decimal comma; empty for any other."""
    found = layout.delimiter != "," and any(map(DECIMAL_COMMA.fullmatch, cells))
    return '; did you mean csv = {decimal = ","}?' if found else ""


def _thousands_hint(cells: list[str]) -> str:
    """A remark where a cell is a number with signs between its thousands; empty for any other."""
    return "; numbers are read without signs between thousands only" if any(map(THOUSANDS.fullmatch, cells)) else ""


def _hint(row: str, other: str, layout: CsvLayout) -> str:
    """A remark on the layout that was probably meant by whoever wrote this `row`; empty if nothing else parts it, and
    the `other`, from the middle of the table, into as many cells."""
    if DECIMAL_COMMA.fullmatch(row.strip()):
        return ONE_COLUMN if layout.delimiter == "," else ""
    delimiter = next((sign for sign in DELIMITERS if sign in row.strip()), layout.delimiter)
    if delimiter in (layout.delimiter, layout.decimal) or len(_parts(row, delimiter)) != len(_parts(other, delimiter)):
        return ""
    decimal = ', decimal = ","' if delimiter != "," and re.search(r"\d,\d", row) else ""
    return f"; did you mean csv = {{delimiter = {json.dumps(delimiter)}{decimal}}}?"


def _parts(row: str, delimiter: str) -> list[str]:
    return row.split() if delimiter == BLANKS else row.split(delimiter)


def _numbers(cells: list[str], decimal: str) -> Array:
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
