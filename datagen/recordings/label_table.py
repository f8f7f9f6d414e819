"""A table of labels beside the recordings: a CSV file whose columns are named like settings."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

from pydantic import ValidationError

from datagen.errors import BadInput, at_line, unreadable
from datagen.files.csv_rows import Row, read_csv_rows
from datagen.files.number_texts import may_be_parted
from datagen.recordings.settings import RecordingSettings
from datagen.settings.problems import bad_settings
from physics.spelling import suggestion

FILE_COLUMN = "file"
# Sizes, which many tables give as 0 where a bearing is healthy.
SIZES = ("extent_mm", "extent_deg", "depth_um")
NOT_COLUMNS = ("csv", "channel", "tach", "envelope_band_hz", "notes")
SETTINGS = tuple(name for name in RecordingSettings.model_fields if name not in NOT_COLUMNS)
WITH_POINT = re.compile(r"[-+]?\d+\.\d+")
# What is a thousand and more if the comma is no decimal sign.
THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}")


@dataclass(frozen=True)
class TableRow:
    """One line of a label table: the possible names of its file, in order of preference, and what it says."""

    place: str
    files: tuple[str, ...]
    settings: dict[str, Any]


def read_label_table(path: Path, note_columns: tuple[str, ...]) -> list[TableRow]:
    """The rows of the table at `path`; raises BadInput naming the file, the line and the column.

    Cells are parted by commas; or by semicolons or tabulators, and then a comma is a decimal sign, as where Excel saves
    tables in languages that write decimal commas. An empty cell says nothing. A cell of the column `file` may hold
    several names separated by |, of which the first that exists is meant. Folders in it may be separated by
    backslashes, as on Windows.
    """
    try:
        delimiter = _delimiter(path)
        rows = [(line, cells) for line, cells in read_csv_rows(path, delimiter) if any(map(str.strip, cells))]
    except OSError as problem:
        raise unreadable(path, problem) from None
    if len(rows) < 2:
        raise BadInput("the table has no rows", file=str(path))
    first, heads = rows[0]
    header = [cell.strip() for cell in heads]
    _check_header(header, note_columns, at_line(path, first))
    decimal = "." if delimiter == "," else ","
    if decimal == ",":
        _refuse_two_decimals(header, rows[1:], path)
    return [_row(header, cells, note_columns, at_line(path, line), decimal) for line, cells in rows[1:]]


def _delimiter(path: Path) -> str:
    """What parts the cells of a table: a comma, unless its first line has none but semicolons or tabulators."""
    return next((sign for sign in ",;\t" if _parts_heads(path, sign)), ",")


def _parts_heads(path: Path, sign: str) -> bool:
    try:
        return any(len(heads) > 1 for _, heads in read_csv_rows(path, sign, most=1))
    except BadInput:  # a quote that ends before another sign
        return False


def _check_header(header: list[str], note_columns: tuple[str, ...], place: str) -> None:
    known = (FILE_COLUMN, *SETTINGS, *note_columns)
    for column in header:
        if column in NOT_COLUMNS:
            allowed = "stated in [defaults], in a [[recording]] or in an override"
            raise BadInput("a label table cannot set this", file=place, field=column, allowed=allowed)
        if column not in known:
            hint = f"unknown column{suggestion(column, known)}; list it in note_columns to keep it as a note"
            raise BadInput(hint, file=place, field=column, allowed=", ".join(known))
        if header.count(column) > 1:
            raise BadInput("this column occurs twice", file=place, field=column)
    for column in (FILE_COLUMN, *note_columns):
        if column not in header:
            raise BadInput("this column is missing", file=place, field=column)


def _refuse_two_decimals(header: list[str], rows: list[Row], path: Path) -> None:
    """Refuse a number whose comma may stand between thousands, as others of the table have a point before decimals."""
    places = [place for place, name in enumerate(header) if name in SETTINGS and not _is_text(name)]
    told = [(line, place, cells[place].strip()) for line, cells in rows for place in places if place < len(cells)]
    odd = next(((line, header[place], cell) for line, place, cell in told if THOUSANDS.fullmatch(cell)), None)
    if odd and any(WITH_POINT.fullmatch(cell) for _, _, cell in told):
        line, name, cell = odd
        problem = "other numbers of this table have a point as decimal sign"
        raise BadInput(
            problem,
            file=at_line(path, line),
            field=name,
            value=cell,
            allowed="numbers without signs between thousands",
        )


def _row(header: list[str], cells: list[str], note_columns: tuple[str, ...], place: str, decimal: str) -> TableRow:
    if len(cells) != len(header):
        raise BadInput(f"{len(cells)} cells, but the table has {len(header)} columns", file=place)
    said = {name: cell.strip() for name, cell in zip(header, cells, strict=True) if cell.strip()}
    named = said.pop(FILE_COLUMN, "").replace("\\", "/")
    files = tuple(name.strip() for name in named.split("|") if name.strip())
    if not files:
        raise BadInput("this cell is empty", file=place, field=FILE_COLUMN)
    notes: dict[str, Any] = {name: _plain(said.pop(name), decimal) for name in note_columns if name in said}
    settings = {name: _setting(name, cell, decimal) for name, cell in said.items()}
    if settings.get("location") == "none" or settings.get("condition") == "healthy":
        settings = {name: value for name, value in settings.items() if name not in SIZES or value != 0}
    try:
        checked = RecordingSettings.model_validate(settings | ({"notes": notes} if notes else {}))
    except ValidationError as error:
        raise bad_settings(error, RecordingSettings, place, "") from None
    return TableRow(place, files, checked.given())


def _setting(name: str, cell: str, decimal: str) -> Any:
    """What the cell of a setting says: a table in braces as in TOML, a number or a text."""
    if cell.startswith("{"):
        try:
            return tomllib.loads(f"cell = {cell}")["cell"]
        except tomllib.TOMLDecodeError:  # a text such as {stem}_DE
            pass
    return cell if _is_text(name) else _plain(cell, decimal)


def _is_text(name: str) -> bool:
    return _allows_text(RecordingSettings.model_fields[name].annotation)


def _allows_text(annotation: Any) -> bool:
    return annotation is str or any(_allows_text(inner) for inner in get_args(annotation))


def _plain(cell: str, decimal: str) -> float | int | str:
    if may_be_parted(cell):
        return cell
    for kind in (int, float):
        try:
            return kind(cell.replace(decimal, "."))
        except ValueError:
            continue
    return cell
