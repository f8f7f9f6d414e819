"""A new folder that appears whole: filled beside its place, moved there at the end, gone if anything goes wrong."""

from __future__ import annotations

import os
import re
import shutil
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from datagen.corpus_files.shard import shards_folder
from datagen.files.atomic import TEMPORARY_SUFFIX, leaving_no_folders, sync_folder, writing

# Of a folder's name that the one beside it is called by.
NAME_BYTES = 64


@contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """A folder beside `folder` that takes its place at the end, or is gone if anything goes wrong.

    A link is left where it is, and the folder that it leads to is filled. What goes wrong in the block is left as it
    is: it may be a recording that cannot be read.
    """
    folder = folder.resolve()
    # Short enough where the name of the folder is.
    name = os.fsencode(folder.name)[:NAME_BYTES].decode(errors="ignore")
    beginning = f".{name}.{socket.gethostname()}."
    staging = folder.with_name(f"{beginning}{os.getpid()}{TEMPORARY_SUFFIX}")
    _sweep(folder.parent, beginning)
    with leaving_no_folders(folder.parent):
        try:
            with writing(folder):
                shards_folder(staging).mkdir(parents=True)
            yield staging
            with writing(folder):
                if folder.exists():
                    folder.rmdir()
                staging.rename(folder)
                sync_folder(folder.parent)
        finally:
            shutil.rmtree(staging, ignore_errors=True)


def _sweep(place: Path, beginning: str) -> None:
    """Delete what imports of the same name left in `place` whose process, on this computer, was killed.

    What one of this process's own number left is of an earlier process: in containers numbers return.
    """
    name = re.compile(re.escape(beginning) + r"(\d+)" + re.escape(TEMPORARY_SUFFIX))
    for path in place.glob(".*") if place.is_dir() else ():
        found = name.fullmatch(path.name)
        if found and (int(found[1]) == os.getpid() or not _alive(int(found[1]))):
            shutil.rmtree(path, ignore_errors=True)


def _alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        pass  # somebody else's
    return True
