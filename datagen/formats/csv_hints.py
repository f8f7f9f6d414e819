"""What layout a table of text was probably written in, if not the one that it is said to have: remarks that close
messages, and refusals of numbers that would be read as others."""

from __future__ import annotations

import json
import math
import re
from itertools import takewhile
from pathlib import Path

import numpy as np

from datagen.errors import BadInput, at_line
from datagen.files.csv_rows import BLANKS, Row, read_csv_rows
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


def refuse_split_numbers(path: Path, line: int, row: list[str], layout: CsvLayout) -> None:
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
                file=at_line(path, line), field="csv.delimiter", value=",",
            )  # fmt: skip


def refuse_halves(path: Path, layout: CsvLayout) -> None:
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
            f"these commas seem to be decimal signs{ONE_COLUMN if width == 2 else ''}",
            file=at_line(path, rows[0][0]),
            field="csv.delimiter",
            value=",",
            allowed="" if width == 2 else "another delimiter than the decimal sign, in the file itself",
        )


def cells_hint(rows: list[Row], columns: dict[str, Array], odd: dict[str, tuple[int, str]], layout: CsvLayout) -> str:
    """A remark on the `rows` below the head, of which some columns begin with an `odd` cell (line and text) that is no
    number; empty if nothing shows what was meant."""
    told = [cell.strip() for _, cell in odd.values()]
    hint = headless_hint(list(columns), layout) or _decimal_hint(told, layout) or _thousands_hint(told)
    above = max((_words_above(text, columns[name]) for name, (_, text) in odd.items()), default=0)
    if not hint and above and not layout.header:
        hint = f"; did you mean csv = {{skip_lines = {rows[above - 1][0]}}}?"
    elif not hint and above == 1:
        hint = f"; did you mean csv = {{skip_below = {layout.skip_below + 1}}}?"
    if len(columns) == 1 and odd:
        [(line, text)] = odd.values()
        if line == rows[0][0]:
            hint = delimiter_hint([text], rows[len(rows) // 2][1], layout) or titled_hint(rows, layout) or hint
    return hint


def titled_hint(rows: list[Row], layout: CsvLayout) -> str:
    """A remark for `rows` that another delimiter parts into numbers, two or more in each of most of them, below lines
    of titles; empty for any others."""
    for sign in DELIMITERS:
        last, middle = (_numbers_in(row, sign, layout) for row in (rows[-1], rows[len(rows) // 2]))
        if sign in (layout.delimiter, layout.decimal) or min(last, middle) < 2:
            continue
        titles = next(place for place, row in enumerate(rows) if _numbers_in(row, sign, layout) == last)
        if 0 < titles <= len(rows) / 2:
            said = f"header = false, skip_lines = {rows[titles][0] - 1}, delimiter = {json.dumps(sign)}"
            return f"; did you mean csv = {{{said}}}?"
    return ""


def _numbers_in(row: Row, sign: str, layout: CsvLayout) -> int:
    """Into how many numbers a delimiter parts a row; 0 if one of its cells is anything else, or none."""
    cells = [cell for cell in _parts(layout.delimiter.join(row[1]), sign) if cell.strip()]
    return len(cells) if all(math.isfinite(layout.number(cell)) for cell in cells) else 0


def headless_hint(names: list[str], layout: CsvLayout) -> str:
    """A remark for a table whose column names are all numbers; empty for any other."""
    if not layout.header or not all(math.isfinite(layout.number(name)) for name in names):
        return ""
    return "; did you mean csv = {header = false}?"


def _words_above(text: str, column: Array) -> int:
    """How many cells that are no numbers, such as units, names or comments of which the first is `text`, are above a
    `column` of nothing but numbers; 0 if it is none, or these are not most of it."""
    count = int(np.argmax(np.isfinite(column)))
    return count if text.strip() and count < column.size / 2 and np.isfinite(column[count:]).all() else 0


def above_hint(rows: list[Row], layout: CsvLayout) -> str:
    """A remark on how many lines are above those `rows`, most of all, that have as many cells as the last; empty if
    there are none, or if among them are numbers of the table, which one odd line parts from the rest."""
    width = len(rows[-1][1])
    table = rows[len(rows) - sum(1 for _ in takewhile(lambda row: len(row[1]) == width, reversed(rows))) :]
    if not len(rows) / 2 < len(table) < len(rows):
        return ""
    above = rows[: len(rows) - len(table)]
    if any(len(cells) == width and all(math.isfinite(layout.number(cell)) for cell in cells) for _, cells in above):
        return ""
    line, cells = table[0]
    headless = layout.header and any(math.isfinite(layout.number(cell)) for cell in cells)
    return f"; did you mean csv = {{{'header = false, ' * headless}skip_lines = {line - 1}}}?"


def _decimal_hint(cells: list[str], layout: CsvLayout) -> str:
    """A remark where a cell that is no number would be one with a decimal comma; empty for any other."""
    found = layout.delimiter != "," and any(map(DECIMAL_COMMA.fullmatch, cells))
    return '; did you mean csv = {decimal = ","}?' if found else ""


def _thousands_hint(cells: list[str]) -> str:
    """A remark where a cell is a number with signs between its thousands; empty for any other."""
    return "; numbers are read without signs between thousands only" if any(map(THOUSANDS.fullmatch, cells)) else ""


def delimiter_hint(cells: list[str], others: list[str], layout: CsvLayout) -> str:
    """A remark on the layout that was probably meant by whoever wrote a row of these `cells`; empty if nothing else
    parts it, and one of the `others`, from the middle of the table, into as many."""
    row, other = layout.delimiter.join(cells), layout.delimiter.join(others)
    if DECIMAL_COMMA.fullmatch(row.strip()):
        return ONE_COLUMN if layout.delimiter == "," else ""
    delimiter = next((sign for sign in DELIMITERS if sign in row.strip()), layout.delimiter)
    if delimiter in (layout.delimiter, layout.decimal) or len(_parts(row, delimiter)) != len(_parts(other, delimiter)):
        return ""
    decimal = ', decimal = ","' if delimiter != "," and re.search(r"\d,\d", row) else ""
    return f"; did you mean csv = {{delimiter = {json.dumps(delimiter)}{decimal}}}?"


def _parts(row: str, delimiter: str) -> list[str]:
    return row.split() if delimiter == BLANKS else row.split(delimiter)
