"""What stands in braces in a SPEC's texts, filled in for each file."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from string import Formatter

from datagen.errors import BadInput

# A width or a number of decimals of more than three figures, or one that another placeholder gives.
WIDE = re.compile(r"\d{4}|\{")


def filled(text: str, path: Path, field: str, more: Mapping[str, str] | None = None) -> str:
    """`text` with `{stem}`, `{number}` and `{folder}` of the file at `path`, and with `more`; raises BadInput.

    They are the file's name without its ending, the first whole number in it, and the name of the folder it lies in.
    """
    if any(WIDE.search(part or "") for _, _, part, _ in _parts(text)):
        raise BadInput("a width in braces", file=str(path), field=field, value=text, allowed="at most 999 characters")
    number = re.search(r"\d+", path.stem)
    values: dict[str, str | int] = {"stem": without_ending(path), "number": int(number.group()) if number else ""}
    values |= {"folder": path.parent.name, **(more or {})}
    try:
        return text.format(**values)
    except (AttributeError, KeyError, IndexError, OverflowError, TypeError, ValueError):
        nameless = "{number" in text and number is None
        problem = "cannot be filled in for this file" + (", whose name contains no number" if nameless else "")
        allowed = ", ".join(f"{{{name}}}" for name in values) + ", as in X{number:03}_DE_time"
        raise BadInput(problem, file=str(path), field=field, value=text, allowed=allowed) from None


def _parts(text: str) -> list[tuple[str, str | None, str | None, str | None]]:
    """What stands in the text, as `string.Formatter` parts it; nothing of a text that it cannot part."""
    try:
        return list(Formatter().parse(text))
    except ValueError:
        return []


def without_ending(path: Path | PurePosixPath) -> str:
    """Name of a file without its ending, nor .gz behind it; figures alone are none, as in 2003.10.22.12.06.24."""
    path = path.with_suffix("") if path.suffix.lower() == ".gz" else path
    return path.name if re.fullmatch(r"\.\d+", path.suffix) else path.stem


def place_without_ending(name: str) -> str:
    """Name of a file from the root, folders and all, without its ending."""
    place = PurePosixPath(name)
    return str(place.with_name(without_ending(place)))
