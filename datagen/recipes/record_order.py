"""In which order the records of a recipe's parts come."""

from __future__ import annotations

from bisect import bisect_right
from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Size = tuple[int, int]


class Place(NamedTuple):
    """Where a record stands, all from 0: its part; its machine in the corpus; it in its part; its machine there; it
    among the records of its machine."""

    part: int
    machine: int
    record_in_part: int
    machine_in_part: int
    record_in_machine: int


def place_by_part(sizes: tuple[Size, ...], record: int) -> Place:
    """Place of a record where parts follow one another; `sizes` are records and records per machine of each part."""
    first_records = list(accumulate((records for records, _ in sizes), initial=0))
    part = bisect_right(first_records, record) - 1
    return _place(sizes, part, record - first_records[part])


def place_interleaved(sizes: tuple[Size, ...], record: int) -> Place:
    """Place of a record where parts take turns, machine by machine, each spread evenly over the whole corpus."""
    turns = _interleaved(sizes)
    turn = int(np.searchsorted(turns.first_record, record, side="right")) - 1
    part = int(turns.part[turn])
    before = int(turns.machine[turn]) * sizes[part][1]
    return _place(sizes, part, before + record - int(turns.first_record[turn]))


def machines(size: Size) -> int:
    """Number of virtual machines of a part, the last one perhaps with fewer records."""
    return -(-size[0] // size[1])


def _place(sizes: tuple[Size, ...], part: int, record: int) -> Place:
    machine, in_machine = divmod(record, sizes[part][1])
    return Place(part, sum(map(machines, sizes[:part])) + machine, record, machine, in_machine)


class _Turns(NamedTuple):
    """For each machine in the order of the corpus: its part, its number there and its first record."""

    part: NDArray[np.int32]
    machine: NDArray[np.int64]
    first_record: NDArray[np.int64]


@lru_cache(maxsize=4)
def _interleaved(sizes: tuple[Size, ...]) -> _Turns:
    counts = [machines(size) for size in sizes]
    part = np.repeat(np.arange(len(sizes), dtype=np.int32), counts)
    machine = np.concatenate([np.arange(count) for count in counts])
    share = (machine + 0.5) / np.repeat(counts, counts)
    order = np.lexsort((part, share))
    part, machine = part[order], machine[order]
    records, per_machine = np.array(sizes).T
    held = np.minimum(per_machine[part], records[part] - machine * per_machine[part])
    return _Turns(part, machine, np.cumsum(held) - held)
