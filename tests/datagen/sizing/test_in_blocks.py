"""Records are read by the thread that asks for them, whoever works on them."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from pathlib import Path

import joblib
import numpy as np
import pytest
from numpy.typing import NDArray
from threadpoolctl import threadpool_info, threadpool_limits

from datagen.sizing import training_rows
from datagen.sizing.in_blocks import in_blocks
from datagen.sizing.sized_records import SizedRecord
from labels.spall_size.situation import Situation

READERS: list[threading.Thread] = []


def read(count: int = 40) -> Iterator[tuple[int]]:
    """So many records; who reads them is noted."""
    READERS.clear()
    for number in range(count):
        READERS.append(threading.current_thread())
        yield (number,)


def test_calls_are_drawn_by_the_thread_that_asks_and_their_results_come_in_order() -> None:
    with joblib.parallel_config(backend="threading"):
        made = list(in_blocks((joblib.delayed(sum)(record) for record in read()), 2))
    assert made == list(range(40))
    assert set(READERS) == {threading.current_thread()}


def most_threads() -> int:
    """How many threads linear algebra has where this is called, at most."""
    return max(library["num_threads"] for library in threadpool_info())


@pytest.mark.parametrize("workers", [1, 2])
def test_linear_algebra_has_one_thread_where_records_are_worked_on_and_as_many_as_before_elsewhere(
    workers: int,
) -> None:
    with threadpool_limits(limits=2):
        for threads in in_blocks((joblib.delayed(most_threads)() for _ in read(12)), workers):
            assert threads == 1
            assert most_threads() == 2


def test_an_error_stops_the_drawing_of_calls() -> None:
    def failing() -> Iterator[object]:
        for record in read():
            yield joblib.delayed(divmod)(1, record[0])

    with joblib.parallel_config(backend="threading"), pytest.raises(ZeroDivisionError):
        list(in_blocks(failing(), 2))
    assert len(READERS) < 40


def negated(record: NDArray[np.float64]) -> float:
    """The first value of a long `record`, whose sign is changed in place, as an estimator of somebody's may do."""
    record *= -1.0
    return float(record[0])


@pytest.mark.parametrize("workers", [1, 2])
def test_long_records_may_be_changed_whatever_the_number_of_processes(workers: int) -> None:
    records = (np.full(1_000_000, float(number)) for number in range(1, 3))
    assert list(in_blocks((joblib.delayed(negated)(record) for record in records), workers)) == [-1.0, -2.0]


def test_records_to_learn_sizes_from_are_read_by_the_thread_that_asks(monkeypatch: pytest.MonkeyPatch) -> None:
    situation = Situation(12, 2, 38.75e-3, 7.12e-3, 190.0)
    listened: list[int] = []

    def records(*_: object, **__: object) -> Iterator[SizedRecord]:
        for (number,) in read():
            noise = np.random.default_rng(number).standard_normal((64, 2))
            yield SizedRecord(number, 1000.0, noise, None, {"snr_db": math.inf}, situation, None)

    def hears_nothing(signal: NDArray[np.float64], *_: object) -> None:
        listened.append(signal.size)

    monkeypatch.setattr(training_rows, "sized_records", records)
    monkeypatch.setattr(training_rows, "gather_evidence", hears_nothing)
    monkeypatch.setattr(
        "datagen.sizing.in_blocks.processes",
        lambda count: joblib.parallel_config(backend="threading", n_jobs=count),
    )
    assert training_rows.trials(Path(), ("train",), 2) == []
    assert len(listened) == 3 * 40  # as it is, in noise, and a part
    assert set(READERS) == {threading.current_thread()}
