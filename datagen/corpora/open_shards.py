"""The shard files of a corpus that were read last, kept open behind one door."""

from __future__ import annotations

import os
import weakref
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from datagen.corpora.netcdf import ONE_AT_A_TIME
from datagen.corpora.reading import reading

if TYPE_CHECKING:
    import netCDF4

OPEN_FILES = 32


class OpenShards:
    """The shard files read last, kept open. Each process opens its own, also after a fork or a pickle.

    netCDF4 crashes when an open file is left to the garbage collector, so they are closed by hand before that.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._start()

    def _start(self) -> None:
        self.files: OrderedDict[str, netCDF4.Dataset] = OrderedDict()
        self.owner = os.getpid()
        self.closer = weakref.finalize(self, _close_all, self.files, self.owner)

    @contextmanager
    def reading(self, shard: str) -> Iterator[netCDF4.Dataset]:
        """The open file of a shard (its name relative to the folder), for this thread alone until the block ends.

        Take what is read out of the block, never the file: another thread may close it then. Raises BadInput if the
        file cannot be read, whether by opening it or by what is done in the block.
        """
        with ONE_AT_A_TIME, reading(self.folder, shard):
            yield self._opened(shard)

    def _opened(self, shard: str) -> netCDF4.Dataset:
        import netCDF4

        if self.owner != os.getpid():
            self._start()
        if shard not in self.files:
            file = netCDF4.Dataset(self.folder / shard)
            file.set_auto_mask(False)
            self.files[shard] = file
            if len(self.files) > OPEN_FILES:
                self.files.popitem(last=False)[1].close()
        self.files.move_to_end(shard)
        return self.files[shard]

    def close(self) -> None:
        """Close all."""
        _close_all(self.files, self.owner)

    def __reduce__(self) -> tuple[type[OpenShards], tuple[Path]]:
        return OpenShards, (self.folder,)


def _close_all(files: OrderedDict[str, netCDF4.Dataset], owner: int) -> None:
    with ONE_AT_A_TIME:
        while files and os.getpid() == owner:
            files.popitem()[1].close()
