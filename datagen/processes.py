"""Worker processes on this machine: as many as asked for, none of which outlives its parent."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from datagen.garbage import collect_seldom

PARENT_POLL = 0.25
MOST_WORKERS = 1024  # more are a slip of the finger, and would bring the machine to a halt
# Bytes by which a worker may grow. loky takes 300 MB for a leak, warns of it and starts another worker, where psutil is
# installed; but long records take more, and their arrays are kept for the next ones (datagen/freed_memory.py).
GROWTH = 4 << 30


@contextmanager
def processes(count: int) -> Iterator[None]:
    """joblib works with so many processes in this context; what a task is given it may change, in every process."""
    from joblib import parallel_config

    with parallel_config(
        backend="loky",
        n_jobs=count,
        inner_max_num_threads=1,
        max_nbytes=None,
        initializer=_begin_worker,
        initargs=(os.getpid(),),
    ):
        yield


def _watch_parent(parent: int) -> None:
    """Start a thread that ends this process within a second of the death of its `parent`; Ctrl-C, and SIGTERM to the
    whole group, are left to the parent."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    threading.Thread(target=_exit_with, args=(parent,), daemon=True).start()


def _begin_worker(parent: int) -> None:
    """What every worker process does first: watch its `parent`, start fast, and let itself grow."""
    from joblib.externals.loky import process_executor

    _watch_parent(parent)
    collect_seldom()
    # No setting of loky's has this bound; where a version of it has another name, workers are replaced as before.
    process_executor._MAX_MEMORY_LEAK_SIZE = GROWTH


def _exit_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(PARENT_POLL)
    os._exit(1)
