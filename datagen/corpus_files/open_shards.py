"""The shard files that were read last, kept open in one place: each is open only once in a process, whoever reads it.

HDF5 2.2.0 crashes when texts of variable length, as earlier versions stored them, are read from a file that was opened
twice and whose first handle has been closed: both handles share what belongs to the first. A forked process inherits
the handles of its parent, so none is kept open during a fork.
"""

from __future__ import annotations

import itertools
import os
import weakref
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.corpus_files.reading import reading
from datagen.files.netcdf import ONE_AT_A_TIME

if TYPE_CHECKING:
    import netCDF4

OPEN_FILES = 32
_numbers = itertools.count()
FileKey = tuple[int, int]


@dataclass
class _OpenFile:
    """An open `file`, where it was found, its `state` when it was opened, and the OpenShards (numbers) that read it."""

    file: netCDF4.Dataset
    path: Path
    state: tuple[int, int]
    readers: set[int] = field(default_factory=set)


class _OpenFiles:
    """The open files of this process, those read last at the end.

    They are known by device and inode, as HDF5 knows them: links and other spellings of a path lead to one file.
    """

    def __init__(self) -> None:
        self.files: OrderedDict[FileKey, _OpenFile] = OrderedDict()
        self.blocks = 0  # `reading` blocks under way, all in the thread that holds ONE_AT_A_TIME

    @contextmanager
    def reading(self, path: Path, reader: int) -> Iterator[netCDF4.Dataset]:
        """The file at a path, opened again if another one has taken its place; OSError if it cannot be."""
        self.blocks += 1
        try:
            yield self._opened(path, reader)
        finally:
            self.blocks -= 1

    def _opened(self, path: Path, reader: int) -> netCDF4.Dataset:
        import netCDF4

        found = os.stat(path)
        key, state = (found.st_dev, found.st_ino), (found.st_size, found.st_mtime_ns)
        if key in self.files and self.files[key].state != state:
            self._close(key)
        for replaced in [other for other, held in self.files.items() if held.path == path and other != key]:
            self._close(replaced)
        if key not in self.files:
            with _nothing_cached():
                file = netCDF4.Dataset(path)
            file.set_auto_mask(False)
            self.files[key] = _OpenFile(file, path, state)
            if len(self.files) > OPEN_FILES:
                self._close(next(iter(self.files)))
        self.files[key].readers.add(reader)
        self.files.move_to_end(key)
        return self.files[key].file

    def read_by(self, reader: int) -> list[Path]:
        """Paths of the files that a reader has had opened."""
        return [held.path for held in tuple(self.files.values()) if reader in held.readers]

    def leave(self, reader: int) -> None:
        """Close the files that no other reader has open."""
        for key, held in tuple(self.files.items()):
            held.readers.discard(reader)
            if not held.readers:
                self._close(key)

    def before_fork(self) -> None:
        """Close all files, unless one is being read, and let nobody open any."""
        ONE_AT_A_TIME.acquire()
        while self.files and not self.blocks:
            self._close(next(iter(self.files)))

    def after_fork(self) -> None:
        """Let files be opened again, on either side."""
        ONE_AT_A_TIME.release()

    def _close(self, key: FileKey) -> None:
        self.files.pop(key).file.close()


@contextmanager
def _nothing_cached() -> Iterator[None]:
    """Files opened in this block keep no chunks that they have read.

    By default each signal of each open file keeps up to 64 MB of them, and all files together gigabytes; but a chunk is
    a whole signal of a record, so that no part of it is left to be read.
    """
    import netCDF4

    usual = netCDF4.get_chunk_cache()
    netCDF4.set_chunk_cache(size=0)
    try:
        yield
    finally:
        netCDF4.set_chunk_cache(*usual)


_open_files = _OpenFiles()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(
        before=_open_files.before_fork,
        after_in_parent=_open_files.after_fork,
        after_in_child=_open_files.after_fork,
    )


class OpenShards:
    """A reader of the shards of a corpus, also after a fork or a pickle.

    netCDF4 crashes when an open file is left to the garbage collector, so they are closed by hand before that.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._number = next(_numbers)
        self._closer = weakref.finalize(self, _leave, self._number)

    @contextmanager
    def reading(self, shard: str) -> Iterator[netCDF4.Dataset]:
        """The open file of a shard (its name relative to the folder), for this thread alone until the block ends.

        Take what is read out of the block, never the file: another thread may close it then. Raises BadInput if the
        file cannot be read, whether by opening it or by what is done in the block.
        """
        path = (self.folder / shard).resolve()
        with ONE_AT_A_TIME, reading(self.folder, shard), _open_files.reading(path, self._number) as file:
            yield file

    @property
    def open_files(self) -> list[Path]:
        """Paths of the files that are open for this reader."""
        with ONE_AT_A_TIME:
            return _open_files.read_by(self._number)

    def close(self) -> None:
        """Close all but those that others read too; they open again when needed."""
        _leave(self._number)

    def __reduce__(self) -> tuple[type[OpenShards], tuple[Path]]:
        return OpenShards, (self.folder,)


def _leave(reader: int) -> None:
    with ONE_AT_A_TIME:
        _open_files.leave(reader)
