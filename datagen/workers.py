"""Running tasks on several processes or machines so that nothing outlives its parent and a dead worker is noticed."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

from datagen.errors import BadInput

BACKENDS = ("loky", "dask")
PARENT_POLL = 0.25


@dataclass(frozen=True)
class Engine:
    """Who does the work: `workers` None takes every processor; `backend` None takes loky, or what the caller has set
    through `joblib.parallel_config`; `scheduler` is the address of a running Dask scheduler.

    `timeout` (s) bounds one task on Dask, where a task that keeps killing its worker would otherwise never end.
    """

    workers: int | None = None
    backend: str | None = None
    scheduler: str | None = None
    timeout: float = 3600.0

    def __post_init__(self) -> None:
        if self.workers is not None and self.workers < 1:
            raise BadInput(field="--workers", value=self.workers, allowed="1 or more")
        if self.backend is not None and self.backend not in BACKENDS:
            raise BadInput(field="--backend", value=self.backend, allowed=", ".join(BACKENDS))
        if self.scheduler is not None and self.backend != "dask":
            raise BadInput("a scheduler needs --backend dask", field="--scheduler", value=self.scheduler)


class WorkerLost(RuntimeError):
    """A worker process died, or a task ran out of time; what had been finished is on the disk."""


def watch_parent(parent: int) -> None:
    """Start a thread that ends this process within a second of the death of its `parent`; Ctrl-C is the parent's."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_exit_with, args=(parent,), daemon=True).start()


def _exit_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(PARENT_POLL)
    os._exit(1)


def run_tasks(function: Callable[..., Any], tasks: Iterable[tuple[Any, ...]], engine: Engine) -> Iterator[Any]:
    """Results of `function(*task)` as they come; raises WorkerLost, and whatever `function` raises."""
    from multiprocessing import TimeoutError as TaskTimeout

    from joblib import Parallel, delayed
    from joblib.externals.loky.process_executor import BrokenProcessPool

    with ExitStack() as stack:
        timeout = _configure(engine, stack)
        parallel = Parallel(return_as="generator_unordered", batch_size=1, pre_dispatch="2*n_jobs", timeout=timeout)
        try:
            yield from parallel(delayed(function)(*task) for task in tasks)
        except (BrokenProcessPool, TaskTimeout) as problem:
            raise WorkerLost(str(problem) or type(problem).__name__) from problem
        except Exception as problem:
            if type(problem).__name__ == "KilledWorker":
                raise WorkerLost(str(problem)) from problem
            raise


def _configure(engine: Engine, stack: ExitStack) -> float | None:
    """Set joblib's backend for the life of `stack`; returns the time limit of one task (s) or None."""
    from joblib import cpu_count, parallel_config
    from joblib.parallel import get_active_backend

    active, _ = get_active_backend()
    if engine.backend == "dask":
        stack.enter_context(_dask_client(engine))
        stack.enter_context(parallel_config(backend="dask", n_jobs=-1))
        return engine.timeout
    if engine.backend is None and type(active).__name__ != "LokyBackend":
        return None
    stack.enter_context(
        parallel_config(
            backend="loky",
            n_jobs=engine.workers or cpu_count(),
            inner_max_num_threads=1,
            max_nbytes=None,
            initializer=watch_parent,
            initargs=(os.getpid(),),
        )
    )
    return None


def _dask_client(engine: Engine) -> Any:
    from joblib import cpu_count

    try:
        from distributed import Client
    except ImportError as problem:
        raise BadInput(
            "Dask is not installed; install it with: pip install 'spallgen[dask]'", field="--backend", value="dask"
        ) from problem
    if engine.scheduler is None:
        return Client(n_workers=engine.workers or cpu_count(), threads_per_worker=1, dashboard_address=":0")
    try:
        return Client(engine.scheduler, timeout=10)
    except (OSError, ValueError) as problem:
        raise BadInput(
            f"no Dask scheduler answers there ({problem})", field="--scheduler", value=engine.scheduler
        ) from problem
