"""The arrays of a recording's file by name, and the choice of one of them as a SPEC writes it."""

from __future__ import annotations

import json
import re
from abc import abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from datagen.errors import BadInput
from datagen.files.number_texts import may_be_parted
from datagen.formats.csv_file import Columns
from datagen.formats.placeholders import filled
from physics.spelling import suggestion

Arrays = Mapping[str, NDArray[Any]]
INDEXED = re.compile(r"(?P<name>.+)\[(?P<places>[-+\d:,\s]+)\]")
COUNTED = re.compile(r"\[\d+\]")
MOST_NAMES = 12
MOST_ALIKE, LETTERS_ALIKE = 4, 3
ONLY_NAME = "data"
TEXTS = "US"


class NumericVariables(dict[str, NDArray[Any]]):
    """The variables of a file that hold numbers, by name; `unread` are the names of those that hold texts, tables or
    sparse matrices. Texts that are numbers count as these; their names are `told`, and fit no pattern: what "*_time" is
    to find is a signal, not a date beside it."""

    def __init__(self) -> None:
        super().__init__()
        self.unread: list[str] = []
        self.told: set[str] = set()

    def add(self, name: str, array: NDArray[Any] | None) -> None:
        """Take an array of numbers or of texts by its name; None stands for anything else."""
        found = None if array is None else as_numbers(array)
        if found is None or found.dtype.kind in TEXTS:
            self.unread.append(name)
            return
        self[name] = found
        if found is not array:
            self.told.add(name)


def as_numbers(array: NDArray[Any]) -> NDArray[Any]:
    """An array as it is, but of texts that are all finite numbers these."""
    if array.dtype.kind not in TEXTS:
        return array
    try:
        found = array.astype(np.float64)
    except ValueError:
        return array
    if any(map(may_be_parted, array.astype(np.str_).ravel().tolist())):
        return array
    return found if found.size and np.isfinite(found).all() else array


class ReadWhenAsked(Mapping[str, NDArray[Any]]):
    """Arrays of a file by name, each read when it is asked for; the one read last is kept, as it is often asked for
    again. Whether there is one is known without reading it."""

    def __init__(self, names: Iterable[str]) -> None:
        self._names = dict.fromkeys(names)
        self._last: tuple[str, NDArray[Any]] | None = None

    @abstractmethod
    def _read(self, name: str) -> NDArray[Any]:
        """The array of a known name; raises BadInput."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self:
            raise KeyError(name)
        if self._last is None or self._last[0] != name:
            self._last = (name, self._read(name))
        return self._last[1]

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


class NoVariable(BadInput):
    """The file has no variable of that name."""


def choose(arrays: Arrays, wish: str, path: Path, field: str) -> NDArray[Any]:
    """The array that `wish` names (see `chosen`), without dimensions of length 1; raises BadInput."""
    name, places = chosen(arrays, wish, path, field)
    found = np.asarray(arrays[name])
    if places is None:
        return found.squeeze()
    try:
        return np.asarray(found[tuple(_place(part) for part in places.split(","))])
    except (IndexError, ValueError):
        shape = "x".join(map(str, found.shape))
        problem = f"{name} is an array of {shape} numbers"
        raise BadInput(
            problem, file=str(path), field=field, value=wish, allowed=_places_in(name, found.shape)
        ) from None


def _places_in(name: str, shape: tuple[int, ...]) -> str:
    """What may be asked for of an array of this `shape`: one place along one dimension, all along the others."""
    lines = []
    for dimension, count in enumerate(shape):
        first, last = (
            ",".join(str(place) if other == dimension else ":" for other in range(len(shape)))
            for place in (0, count - 1)
        )
        lines.append(f"{name}[{first}] to {name}[{last}]")
    return f"{', '.join([name, *lines])}; from_s and to_s take a stretch"


def chosen(arrays: Arrays, wish: str, path: Path, field: str) -> tuple[str, str | None]:
    """Name of the array that `wish` means, and the places to take of it if it says so; raises BadInput.

    Names with | between them are tried in order, unless all of it is a name; * and ? stand for any text and must fit
    one name only; what stands in braces is filled in (see `filled`); "NAME[:,2]" takes one column of a table, counted
    from 0.
    """
    text = filled(wish, path, field)
    for alternative in (text, *text.split("|")):  # a name may hold the sign itself
        found = _named(arrays, alternative.strip(), path, field)
        if found is not None:
            return found
    names = sorted(arrays)
    if not names:
        raise NoVariable("the file holds no numbers", file=str(path), field=field, value=text)
    if isinstance(arrays, NumericVariables) and text in arrays.unread:
        problem, allowed = (
            "is a text, a table or a sparse matrix, which are not read",
            f"the number itself, or {_shown(names)}",
        )
        raise NoVariable(problem, file=str(path), field=field, value=text, allowed=allowed)
    hint = arrays.hint if isinstance(arrays, Columns) else ""
    hint = hint or _elements(text, names) or _alike(text, names) or suggestion(text, names)
    raise NoVariable(
        f"the file has no such variable{hint}", file=str(path), field=field, value=text, allowed=_shown(names)
    )


def _shown(names: list[str]) -> str:
    return ", ".join(names[:MOST_NAMES]) + (f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else "")


def _elements(wish: str, names: list[str]) -> str:
    """A closing remark where the wish names an element of an array of structures by a text in it, as Y.vibration_1.Data
    does, and these are counted; empty if it does not."""
    parts = wish.split(".")
    fewer = [parts[:place] + parts[place + 1 :] for place in range(1, len(parts))]
    counted = [name for name in names if COUNTED.sub("", name).split(".") in fewer and COUNTED.search(name)]
    return f"; its elements are counted from 0: {_shown(counted)}" if len(counted) > 1 else ""


def _alike(wish: str, names: list[str]) -> str:
    """A closing remark on the few names that hold the wish or only differ in capitals; empty without any."""
    whole = [name for name in names if name.casefold() == wish.casefold()]
    alike = [name for name in names if len(wish) >= LETTERS_ALIKE and wish.casefold() in name.casefold()]
    alike = whole or alike
    return f"; did you mean {' or '.join(json.dumps(name) for name in alike[:MOST_ALIKE])}?" if alike else ""


def _named(arrays: Arrays, wish: str, path: Path, field: str) -> tuple[str, str | None] | None:
    indexed = None if wish in arrays else INDEXED.fullmatch(wish)
    name = indexed["name"] if indexed else wish
    # Brackets mean themselves: they count the elements of MATLAB's arrays of structures and cells.
    pattern = name.replace("[", "[[]")
    told = arrays.told if isinstance(arrays, NumericVariables) else ()
    fitting = (held for held in arrays if _is_pattern(name) and fnmatchcase(held, pattern) and held not in told)
    known = [name] if name in arrays else list(fitting)
    if len(known) > 1:
        raise BadInput(
            f"fits {len(known)} variables: {', '.join(sorted(known)[:MOST_NAMES])}",
            file=str(path),
            field=field,
            value=wish,
        )
    return (known[0], indexed["places"] if indexed else None) if known else None


def _is_pattern(name: str) -> bool:
    return "*" in name or "?" in name


def _place(part: str) -> int | slice:
    return slice(None) if part.strip() == ":" else int(part)
