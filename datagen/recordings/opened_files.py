"""Files of recordings, each opened and hashed once during an import."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path

from datagen.errors import unreadable
from datagen.files.digest import file_hash
from datagen.formats.arrays import Arrays
from datagen.formats.csv_layout import CsvLayout
from datagen.formats.reading import read_arrays
from datagen.recordings.listing import Request
from datagen.recordings.source import Source
from datagen.recordings.unchanged import first_state, require_unchanged


def open_source(request: Request) -> Source:
    """The opened file of a request; the file read last is kept, as its channels come one after the other.

    Raises BadInput if it cannot be read, or has changed since it was first opened.
    """
    require_unchanged(request.path)
    layout = request.settings.get("csv", CsvLayout())
    return Source(request, _opened(request.path, request.settings.get("format"), layout))


@lru_cache(maxsize=1)
def _opened(path: Path, kind: str | None, layout: CsvLayout) -> Arrays:
    return read_arrays(path, kind, layout)


@lru_cache(maxsize=100_000)
def source_hash(path: Path) -> str:
    """SHA-256 of a file, computed once for all that is read from it; BadInput if it cannot be read."""
    try:
        return file_hash(path)
    except OSError as problem:
        raise unreadable(path, problem) from None


REMEMBERED = (_opened, source_hash, first_state)


@contextmanager
def remembered_files() -> Iterator[None]:
    """What is remembered of files inside is forgotten before and afterwards."""
    for remembered in REMEMBERED:
        remembered.cache_clear()
    try:
        yield
    finally:
        for remembered in REMEMBERED:
            remembered.cache_clear()
