from __future__ import annotations

import os
import time

import pytest

from datagen.errors import BadInput
from datagen.workers import Engine, WorkerLost, run_tasks


def test_results_of_all_tasks_come_back() -> None:
    assert sorted(run_tasks(pow, [(k, 2) for k in range(20)], Engine(workers=2))) == [k * k for k in range(20)]


def test_several_workers_are_processes_of_their_own_and_one_is_this_process() -> None:
    assert set(run_tasks(os.getpid, [()] * 3, Engine(workers=1))) == {os.getpid()}
    assert os.getpid() not in set(run_tasks(os.getpid, [()] * 3, Engine(workers=2)))


def test_an_exception_of_a_task_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        list(run_tasks(divmod, [(1, 0)], Engine(workers=2)))


def test_a_worker_that_dies_is_reported_as_lost() -> None:
    with pytest.raises(WorkerLost):
        list(run_tasks(os._exit, [(3,)] * 4, Engine(workers=2)))


def test_a_task_that_never_ends_on_dask_is_reported_as_lost_after_its_time_limit() -> None:
    with pytest.raises(WorkerLost):
        list(run_tasks(time.sleep, [(600.0,)] * 2, Engine(workers=2, backend="dask", timeout=1.0)))


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"workers": 0}, "--workers = 0: allowed: 1 or more"),
        ({"backend": "ray"}, '--backend = "ray": allowed: loky, dask'),
        ({"scheduler": "tcp://localhost:1"}, "a scheduler needs --backend dask"),
    ],
)
def test_an_impossible_engine_is_refused(settings: dict[str, object], sentence: str) -> None:
    with pytest.raises(BadInput, match=sentence):
        Engine(**settings)  # type: ignore[arg-type]


def test_a_scheduler_that_does_not_answer_is_refused() -> None:
    with pytest.raises(BadInput, match="no Dask scheduler answers there"):
        list(run_tasks(pow, [(1, 1)], Engine(backend="dask", scheduler="nonsense://localhost:1")))
