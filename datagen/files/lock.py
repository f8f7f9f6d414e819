"""A folder used by one run at a time."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from datagen.errors import BadInput

# By which a run holds its folder.
LOCK = ".lock"
# Seconds, in all and between two tries, that a run waits for what may be but the moment of a look by `is_held`.
PATIENCE, PAUSE = 0.2, 0.01


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold `folder` for this process alone; BadInput if another run holds it or it cannot be written into.

    The lock dies with its process. On a file system without locks, as some network ones are, nothing is held.
    """
    try:
        descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as problem:
        raise BadInput(f"cannot write into this folder: {problem.strerror}", file=str(folder)) from problem
    try:
        _take(descriptor)
    except BlockingIOError as problem:
        os.close(descriptor)
        raise BadInput("another run is writing into this folder", file=str(folder)) from problem
    except OSError:
        pass  # a file system without locks: go on unprotected
    try:
        yield
    finally:
        os.close(descriptor)


def _take(descriptor: int) -> None:
    """Lock an open file for this process alone; BlockingIOError if another holds it for longer than a look at it."""
    import fcntl

    given_up = time.monotonic() + PATIENCE
    while True:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            if time.monotonic() >= given_up:
                raise
        time.sleep(PAUSE)


def is_held(folder: Path) -> bool:
    """True while a process holds `folder` by `locked`."""
    import fcntl

    try:
        descriptor = os.open(folder / LOCK, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False  # a file system without locks
    finally:
        os.close(descriptor)
    return False
