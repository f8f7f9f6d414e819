"""The rows of a CSV file, each with the number of its line, for messages."""

from __future__ import annotations

import codecs
import csv
import errno
import gzip
import io
import os
import zlib
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import IO

from datagen.errors import BadInput, at_line

BLANKS = " "
UTF_8 = "utf-8"
GZIP = b"\x1f\x8b"
# What reading compressed text raises where it breaks off or is damaged.
BROKEN = (EOFError, zlib.error, gzip.BadGzipFile)
# What old systems and some loggers fill the end of a file with: Ctrl-Z and zeros.
FILLING = "\x1a\0"
Row = tuple[int, list[str]]


class NotText(BadInput):
    """The bytes of the file are no text in its encoding."""


def open_text(path: Path, encoding: str) -> IO[str]:
    """The text file at `path`, opened with its line ends as they are, without what fills its end; in UTF-8 a byte order
    mark is no matter, and text compressed by gzip is read as it unpacks: to an error of BROKEN if it is damaged."""
    known = "utf-8-sig" if codecs.lookup(encoding).name == UTF_8 else encoding
    if _is_compressed(path):
        return gzip.open(path, "rt", newline="", encoding=known)
    if not _may_be_filled(path):
        return path.open(newline="", encoding=known)
    text = path.read_bytes().decode(known)
    return io.StringIO(text.rstrip(FILLING + "\r\n"), newline="")


def _is_compressed(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(len(GZIP)) == GZIP


def _may_be_filled(path: Path) -> bool:
    """Whether the last byte of a file, but for a line end, is of what fills it, or half of a letter of two bytes."""
    with path.open("rb") as file:
        file.seek(-min(2, file.seek(0, os.SEEK_END)), os.SEEK_END)
        return file.read().rstrip(b"\r\n").endswith((b"\x1a", b"\0"))


def read_csv_rows(
    path: Path,
    delimiter: str = ",",
    skip_lines: int = 0,
    encoding: str = UTF_8,
    most: int | None = None,
    *,
    blank: bool = False,
) -> list[Row]:
    """Each row, or the first `most`, of a file that is not blank: the number of its first line, from 1, and its cells.

    Rows that are `blank` come too, without cells, if that is asked for. A `delimiter` of one space stands for any run
    of blanks, between which nothing is quoted; the first `skip_lines` are left out. Raises NotText, BadInput with the
    line where a quoted cell does not end as one should, and OSError if the file cannot be read.
    """
    try:
        with open_text(path, encoding) as file:
            lines = islice(file, skip_lines, None)
            rows = _split(lines) if delimiter == BLANKS else _parsed(lines, delimiter, path, skip_lines)
            return list(islice(((skip_lines + line, cells) for line, cells in rows if cells or blank), most))
    except UnicodeError:
        raise NotText(
            f"not a text file in {encoding}", file=str(path), allowed=f"the text saved in {encoding}"
        ) from None
    except BROKEN:
        raise OSError(errno.EIO, "its compressed text is damaged or breaks off") from None


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
            raise BadInput(f"not a row of a CSV table: {problem}", file=at_line(path, skipped + first)) from None
        yield first, cells
