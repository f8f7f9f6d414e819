"""Finding files by name: there may be thousands, and each line of a label table names one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fnmatch import translate
from functools import cache
from os.path import normcase
from pathlib import Path, PurePath
from unicodedata import normalize

WILD = "*?["
ANY_FOLDERS = re.compile(r"(?:\*\*/)+")
# What `translate` puts behind a pattern, so that it holds for whole names alone; Python 3.14 writes it another way.
END = translate("").removeprefix("(?s:)")
DIGITS = re.compile("([0-9]+)")


class FileNames:
    """Files and their names relative to the root; `fitting` finds those that a name or a pattern means."""

    def __init__(self, names: Mapping[Path, str]) -> None:
        self.names = names
        self.known: dict[str, list[Path]] = {}
        for path, name in names.items():
            for spelling in {_plain(name), _plain(path.name)}:
                self.known.setdefault(spelling, []).append(path)

    def fitting(self, name: str) -> list[Path]:
        """The files that are called `name`, or, if there are none, those that match it as a pattern (see `fits`); in
        order."""
        called = self.known.get(_plain(name), [])
        if called or not any(sign in name for sign in WILD):
            return called
        return [path for path in self.names if not hidden(path, name) and fits(path, self.names[path], name)]


def fits(path: Path, name: str, pattern: str) -> bool:
    """True if a file equals or matches the `pattern`: by its bare name or, if the pattern holds a /, by its `name` from
    the root, where **/ stands for any folders or none.

    A pattern without / says nothing of folders: n* must not mean all that lies in new/.
    """
    pattern, whole, bare = _plain(pattern), _plain(name), _plain(path.name)
    meant = whole if "/" in pattern else bare
    return pattern in (whole, bare) or _compiled(pattern).fullmatch(meant) is not None


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    """What matches a pattern as `fnmatch` has it, each **/ kept or left out: one expression, as there are twice as many
    ways with every further **/."""
    parts = ANY_FOLDERS.split(pattern)
    return re.compile("(?s:.*/)?".join(translate(part).removesuffix(END) for part in parts))


def hidden(path: Path, pattern: str) -> bool:
    """True if a file's name begins with a dot and the pattern's does not: some systems leave such files anywhere."""
    return path.name.startswith(".") and not PurePath(pattern).name.startswith(".")


def by_number(path: PurePath) -> tuple[list[list[str | int]], PurePath]:
    """A key that sorts paths as people number them, 2.csv before 10.csv; 01.csv comes before 1.csv."""
    parts = (DIGITS.split(part) for part in path.parts)
    return [[int(text) if place % 2 else text for place, text in enumerate(texts)] for texts in parts], path


def spellings(name: str) -> set[str]:
    """The Unicode spellings of a name that look the same: accented letters as one code point or as two."""
    return {normalize("NFC", name), normalize("NFD", name)}


def _plain(name: str) -> str:
    return normcase(normalize("NFC", name))
