"""Records read by this process and worked on by several."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

from datagen.processes import processes

CALLS_AT_ONCE = 4  # for each process


def in_blocks(calls: Iterator[Any], workers: int) -> Iterator[Any]:
    """The results, in order, of the `calls` (of joblib's `delayed`), made by so many processes.

    The calls are taken from the iterator here, a few at a time, since each reads a record: if a thread of joblib's went
    on reading netCDF files after an error, it would crash whoever opens the next one. A call may change its arguments.
    Linear algebra has one thread, in this process too: on a busy machine threads take longer by waiting for each other.
    Raises what a call, or taking it, raises.
    """
    from joblib import Parallel
    from threadpoolctl import threadpool_limits

    with processes(workers):
        parallel = Parallel()
    with parallel:
        while block := list(islice(calls, CALLS_AT_ONCE * workers)):
            with threadpool_limits(limits=1):
                results = parallel(block)
            yield from results
