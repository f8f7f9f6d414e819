"""Files that are either absent or whole, whatever is killed in between."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from datagen.errors import BadInput
from datagen.files.places import OUT

TEMPORARY_SUFFIX = ".part"
# Rights of its owner that every file has.
OWNERS = stat.S_IRUSR | stat.S_IWUSR
NO_SPACE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def write_atomically(path: Path, data: bytes | memoryview) -> None:
    """Put `data` at `path`, on the disk: a crash leaves the old file or the whole new one; OSError if it cannot be."""
    with opened_atomically(path) as file:
        file.write(data)


@contextmanager
def opened_atomically(path: Path) -> Iterator[BinaryIO]:
    """A file to write into that is at `path` once the block ends well; after anything else the old one is as it was.

    Who may read the old one may read the new one, as may its owner, and nobody else.
    """
    # A name that no other thread, process or computer has, and that is not too long where that of the file is not;
    # mkstemp would hide the file from all but its owner.
    temporary = path.with_name(f".{os.urandom(16).hex()}{TEMPORARY_SUFFIX}")
    try:
        with temporary.open("xb") as file:
            with suppress(OSError):  # a new file, or a file system without such rights
                os.fchmod(file.fileno(), stat.S_IMODE(path.stat().st_mode) | OWNERS)
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    sync_folder(path.parent)


def write_file(path: Path, data: bytes, option: str) -> None:
    """Put `data` at `path`, which the user has named with an `option`, whole or not at all; raises BadInput.

    A pipe or a device is written to as it is, and not replaced by a file; nor is a link, but what it leads to.
    """
    try:
        if path.exists() and not path.is_file():
            path.write_bytes(data)
        else:
            write_atomically(Path(os.path.realpath(path)), data)
    except OSError as problem:
        raise BadInput(f"cannot write this file: {problem.strerror}", file=str(path), field=option) from None


def write_results(folder: Path, files: Mapping[str, bytes], gone: Iterable[str] = ()) -> None:
    """Make `folder`, which the user has named with `--out`, put the named `files` there, and delete those called as in
    `gone`, of an earlier run; raises BadInput.

    Where the first of them cannot be written, folders that were not there before are not left there either.
    """
    with writing(folder), leaving_no_folders(folder):
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            write_atomically(folder / name, content)
        for name in gone:
            (folder / name).unlink(missing_ok=True)


@contextmanager
def writing(folder: Path) -> Iterator[None]:
    """BadInput that names `folder`, given with `--out`, in place of an OSError of the block, which only writes."""
    try:
        yield
    except OSError as problem:
        raise BadInput(f"cannot write here: {problem.strerror}", file=str(folder), field=OUT) from None


@contextmanager
def leaving_no_folders(folder: Path) -> Iterator[None]:
    """If the block fails, delete `folder` and those around it that were not there before, as far as they are empty."""
    new = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        yield
    except BaseException:
        with suppress(OSError):
            for path in new:
                path.rmdir()
        raise


def sync_folder(folder: Path) -> None:
    """Have what lies in `folder`, by name, on the disk; OSError if that cannot be."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def is_temporary(path: Path) -> bool:
    """True if `path` is called like a file that a writer had not finished, and is no folder."""
    return path.name.startswith(".") and path.name.endswith(TEMPORARY_SUFFIX) and not path.is_dir()


def sweep_temporaries(folder: Path) -> None:
    """Delete what killed writers left in `folder`. Call it with the folder locked."""
    for path in filter(is_temporary, folder.glob(f".*{TEMPORARY_SUFFIX}")):
        path.unlink(missing_ok=True)
