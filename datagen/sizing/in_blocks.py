"""Records read by this process and worked on by several."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

from datagen.processes import processes

CALLS_AT_ONCE = 4  # for each process


def in_blocks(calls: Iterator[Any], workers: int) -> Iterator[Any]:
    """The results, in order, of the `calls` (of joblib's `delayed`), made by so many processes.

    The calls are drawn here, some at a time, as drawing one reads a record: a thread of joblib's that goes on reading
    netCDF files after an error crashes whoever opens the next one. What a call is given it may change. Raises
    what a call or its drawing raises.
    """
    from joblib import Parallel

    with processes(workers):
        parallel = Parallel()
    with parallel:
        while block := list(islice(calls, CALLS_AT_ONCE * workers)):
            yield from parallel(block)
