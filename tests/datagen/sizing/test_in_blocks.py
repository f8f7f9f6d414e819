"""Records are read by the thread that asks for them, whoever works on them."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import joblib
import pytest

from datagen.sizing import training_rows
from datagen.sizing.in_blocks import in_blocks

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


def test_an_error_stops_the_drawing_of_calls() -> None:
    def failing() -> Iterator[object]:
        for record in read():
            yield joblib.delayed(divmod)(1, record[0])

    with joblib.parallel_config(backend="threading"), pytest.raises(ZeroDivisionError):
        list(in_blocks(failing(), 2))
    assert len(READERS) < 40


def test_records_to_learn_sizes_from_are_read_by_the_thread_that_asks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(training_rows, "sized_records", lambda *_, **__: read())
    monkeypatch.setattr(training_rows, "_of_record", list)
    with joblib.parallel_config(backend="threading"):
        assert training_rows.trials(Path(), ("train",), 2) == list(range(40))
    assert set(READERS) == {threading.current_thread()}
