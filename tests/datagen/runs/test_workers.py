from __future__ import annotations

import gc
import os
import socket
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest
from joblib import parallel_config

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


def test_unless_told_there_are_as_many_workers_as_processors_or_as_the_caller_asks_for_and_never_more_than_tasks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("joblib.cpu_count", lambda: 8)
    assert [Engine().for_tasks(tasks).workers for tasks in (0, 1, 5, 20)] == [1, 1, 5, 8]
    assert [Engine(workers=3).for_tasks(tasks).workers for tasks in (1, 2, 20)] == [1, 2, 3]
    with parallel_config("loky", n_jobs=4):
        assert [Engine().for_tasks(tasks).workers for tasks in (2, 20)] == [2, 4]


def test_workers_look_seldom_for_garbage() -> None:
    # Python's own is 700: https://docs.python.org/3.11/library/gc.html#gc.set_threshold
    assert all(youngest >= 10_000 for youngest, *_ in results(Engine(workers=2), gc.get_threshold, [()] * 2))


def grow(size: int) -> int:
    """The number of this process, which keeps `size` bytes from now on, after longer than loky lets pass unseen."""
    sys.modules[__name__].__dict__["kept"] = b"x" * size
    time.sleep(1.1)
    return os.getpid()


@pytest.mark.slow
def test_a_worker_may_grow_by_what_long_records_take(recwarn: pytest.WarningsRecorder) -> None:
    pytest.importorskip("psutil", reason="loky looks at the memory of workers only where psutil is installed")
    with engaged(Engine(workers=2)):
        first, later = (set(run_tasks(grow, tasks)) for tasks in ([(0,)] * 2, [(400 << 20,)] * 4))
    assert len(first | later) <= 2  # none was replaced
    assert not recwarn.list


def test_an_exception_of_a_task_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        results(Engine(workers=2), divmod, [(1, 0)])


def test_a_worker_that_dies_is_reported_as_lost() -> None:
    with pytest.raises(WorkerLost):
        results(Engine(workers=2), os._exit, [(3,)] * 4)


def test_without_dask_the_message_says_how_a_checkout_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(BadInput, match=r'pip install -e "\.\[dask\]"'):
        results(Engine(backend="dask"), pow, [(1, 1)])


@pytest.mark.slow
def test_a_task_that_never_ends_on_dask_is_reported_as_lost_after_its_time_limit() -> None:
    with pytest.raises(WorkerLost):
        results(Engine(workers=2, backend="dask"), time.sleep, [(600.0,)] * 2)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"workers": 0}, r"--workers = 0\b.*allowed: 1 to 1024"),
        ({"workers": 100_000}, r"--workers = 100000; allowed: 1 to 1024"),
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


def test_what_listens_but_is_no_scheduler_is_given_up_in_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("datagen.runs.workers.SCHEDULER_PATIENCE", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        before = set(threading.enumerate())
        with pytest.raises(BadInput, match=r"no Dask scheduler answers there \(.+\); allowed: the"):
            results(Engine(backend="dask", scheduler=address), pow, [(1, 1)])
        # A loop left behind would collect other people's netCDF files.
        assert set(threading.enumerate()) <= before


def test_whatever_another_program_answers_is_told_as_no_scheduler(monkeypatch: pytest.MonkeyPatch) -> None:
    async def connect(*_: object, **__: object) -> None:
        raise MemoryError("a length read from another program's greeting")

    monkeypatch.setattr("distributed.comm.connect", connect)
    with pytest.raises(BadInput, match=r"answers there \(a length read from another program's greeting\)"):
        results(Engine(backend="dask", scheduler="tcp://127.0.0.1:1"), pow, [(1, 1)])


def test_a_running_scheduler_does_the_work() -> None:
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster:
        engine = Engine(backend="dask", scheduler=cluster.scheduler_address)
        assert sorted(results(engine, pow, [(k, 2) for k in range(3)])) == [0, 1, 4]
