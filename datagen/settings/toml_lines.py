"""Line numbers of the settings of a TOML text, for messages."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from datagen.errors import at_line

Location = tuple[str | int, ...]
HEADER = re.compile(r"^\s*(\[\[?)\s*([A-Za-z0-9_.\-\s]+?)\s*\]\]?\s*(#.*)?$")
KEY = re.compile(r"^\s*([A-Za-z0-9_\-.]+)\s*=")


def line_of(text: str, location: Location) -> int | None:
    """Line (from 1) of the setting at `location`, or of the innermost table that holds it; None if not found.

    A location lists keys and, after an array of tables, the index of its element: ("part", 2, "defect", "depth_um").
    """
    lines = _lines(text)
    for length in range(len(location), 0, -1):
        if location[:length] in lines:
            return lines[location[:length]]
    return None


def place_in_file(path: str, location: Location) -> str:
    """The file `path` for a message, with the line of the setting at `location` where it can be found now."""
    return at_line(path, line_of(text_of(path), location))


def text_of(path: str) -> str:
    """What a recipe's file says now; empty if it is gone."""
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError):
        return ""


def _lines(text: str) -> dict[Location, int]:
    lines: dict[Location, int] = {}
    arrays: Counter[tuple[str, ...]] = Counter()
    table: Location = ()
    for number, line in _outside_long_texts(text):
        header = HEADER.match(line)
        if header:
            keys = tuple(key.strip() for key in header.group(2).split("."))
            if header.group(1) == "[[":
                arrays[keys] += 1
                for inner in [other for other in arrays if len(other) > len(keys) and other[: len(keys)] == keys]:
                    del arrays[inner]
            table = _indexed(keys, arrays)
            lines.setdefault(tuple(keys), number)
            lines.setdefault(table, number)
        elif key := KEY.match(line):
            lines.setdefault((*table, *key.group(1).split(".")), number)
    return lines


def _outside_long_texts(text: str) -> Iterator[tuple[int, str]]:
    inside = False
    for number, line in enumerate(text.split("\n"), start=1):  # the only end of a line that TOML has
        if not inside:
            yield number, line
        inside ^= (line.count('"""') + line.count("'''")) % 2 == 1


def _indexed(keys: tuple[str, ...], arrays: Counter[tuple[str, ...]]) -> Location:
    location: list[str | int] = []
    for depth, key in enumerate(keys, start=1):
        location.append(key)
        if arrays[keys[:depth]]:
            location.append(arrays[keys[:depth]] - 1)
    return tuple(location)
