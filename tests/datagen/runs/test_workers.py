from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Any

import pytest

from datagen.errors import BadInput
from datagen.runs.workers import Engine, WorkerLost, engaged, run_tasks


def results(engine: Engine, function: Callable[..., Any], tasks: list[tuple[Any, ...]]) -> list[Any]:
    with engaged(engine):
        return list(run_tasks(function, tasks, time_limit=1.0))


def test_results_of_all_tasks_come_back() -> None:
    assert sorted(results(Engine(workers=2), pow, [(k, 2) for k in range(20)])) == [k * k for k in range(20)]


def test_several_workers_are_processes_of_their_own_and_one_is_this_process() -> None:
    assert set(results(Engine(workers=1), os.getpid, [()] * 3)) == {os.getpid()}
    assert os.getpid() not in results(Engine(workers=2), os.getpid, [()] * 3)


def test_an_exception_of_a_task_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        results(Engine(workers=2), divmod, [(1, 0)])


def test_a_worker_that_dies_is_reported_as_lost() -> None:
    with pytest.raises(WorkerLost):
        results(Engine(workers=2), os._exit, [(3,)] * 4)


def test_a_task_that_never_ends_on_dask_is_reported_as_lost_after_its_time_limit() -> None:
    with pytest.raises(WorkerLost):
        results(Engine(workers=2, backend="dask"), time.sleep, [(600.0,)] * 2)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"workers": 0}, r"--workers = 0\b.*allowed: 1 or more"),
        ({"backend": "ray"}, r'--backend = "ray".*allowed: loky, dask'),
        ({"scheduler": "tcp://localhost:1"}, "a scheduler needs --backend dask"),
    ],
)
def test_an_impossible_engine_is_refused(settings: dict[str, object], sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        Engine(**settings)  # type: ignore[arg-type]


def test_a_scheduler_that_does_not_answer_is_refused() -> None:
    with pytest.raises(BadInput, match="no Dask scheduler answers there"):
        results(Engine(backend="dask", scheduler="nonsense://localhost:1"), pow, [(1, 1)])
