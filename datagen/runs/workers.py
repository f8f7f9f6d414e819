"""Running tasks on several processes or machines so that nothing outlives its parent and a dead worker is noticed."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

from datagen.errors import BadInput
from datagen.processes import MOST_WORKERS, processes

BACKENDS = ("loky", "dask")
SCHEDULER_PATIENCE = 5.0  # s


@dataclass(frozen=True)
class Engine:
    """Who does the work: how many `workers`, on which `backend`, and the address of a running Dask `scheduler`.

    What is None follows the caller's `joblib.parallel_config`, or else is loky with a worker per processor. Raises
    BadInput for values that are not allowed, or a scheduler without the Dask backend.
    """

    workers: int | None = None
    backend: str | None = None
    scheduler: str | None = None

    def __post_init__(self) -> None:
        if self.workers is not None and not 1 <= self.workers <= MOST_WORKERS:
            raise BadInput(field="--workers", value=self.workers, allowed=f"1 to {MOST_WORKERS}")
        if self.backend is not None and self.backend not in BACKENDS:
            raise BadInput(field="--backend", value=self.backend, allowed=", ".join(BACKENDS))
        if self.scheduler is not None and self.backend != "dask":
            raise BadInput("a scheduler needs --backend dask", field="--scheduler", value=self.scheduler)

    def for_tasks(self, count: int) -> Engine:
        """The same with no more workers than there are tasks; this process does a single task itself, without waiting
        for another to start."""
        return replace(self, workers=min(self.workers or _workers_unless_told(), max(count, 1)))


class WorkerLost(RuntimeError):
    """A worker process died, or a task ran out of time; what had been finished is on the disk."""


def _workers_unless_told() -> int:
    """As many as the caller's `joblib.parallel_config` asks for, or one per processor."""
    from joblib import cpu_count, effective_n_jobs
    from joblib.parallel import get_active_backend

    _, asked = get_active_backend()
    return cpu_count() if asked is None else effective_n_jobs(asked)


@contextmanager
def engaged(engine: Engine) -> Iterator[None]:
    """joblib works with `engine` in this context; raises BadInput if Dask is not there."""
    from joblib import parallel_config
    from joblib.parallel import get_active_backend
    from threadpoolctl import threadpool_limits

    callers, _ = get_active_backend()
    if engine.backend == "dask":
        with _dask_client(engine) as client, parallel_config(backend="dask", client=client, n_jobs=-1):
            yield
    elif engine.backend is None and type(callers).__name__ != "LokyBackend":
        yield
    else:
        # A single worker is this process, whose threads would cost more by waiting for each other than they gain.
        with threadpool_limits(limits=1), processes(engine.workers or _workers_unless_told()):
            yield


def run_tasks(function: Callable[..., Any], tasks: Iterable[tuple[Any, ...]], time_limit: float) -> Generator[Any]:
    """Results of `function(*task)` as they come; raises WorkerLost, and whatever `function` raises.

    Close the generator if you leave it early: if the garbage collector does, it may end the workers of a later run.
    `time_limit` (s) bounds one task on Dask, where a task that keeps killing its worker would otherwise never end.
    """
    from multiprocessing import TimeoutError as TaskTimeout

    from joblib import Parallel, delayed
    from joblib.externals.loky.process_executor import BrokenProcessPool
    from joblib.parallel import get_active_backend

    on_dask = type(get_active_backend()[0]).__name__ == "DaskDistributedBackend"
    parallel = Parallel(
        return_as="generator_unordered",
        batch_size=1,
        pre_dispatch="2*n_jobs",
        timeout=time_limit if on_dask else None,
    )
    try:
        yield from parallel(delayed(function)(*task) for task in tasks)
    except (BrokenProcessPool, TaskTimeout) as problem:
        raise WorkerLost(_cause(problem)) from problem
    except Exception as problem:
        if type(problem).__name__ == "KilledWorker":
            raise WorkerLost(_cause(problem)) from problem
        raise


def _cause(problem: BaseException) -> str:
    text = str(problem).strip()
    return text.splitlines()[0].split(". ")[0] if text else type(problem).__name__


def _dask_client(engine: Engine) -> Any:
    try:
        from distributed import Client
    except ImportError as problem:
        raise BadInput(
            'Dask is not installed; install it in a checkout with: pip install -e ".[dask]"',
            field="--backend",
            value="dask",
        ) from problem
    # A default client would outlive its closing in Dask's configuration, and xarray would ask for it when writing.
    if engine.scheduler is None:
        return Client(
            n_workers=engine.workers or _workers_unless_told(),
            threads_per_worker=1,
            dashboard_address=":0",
            set_as_default=False,
        )
    _require_scheduler(engine.scheduler)
    return Client(engine.scheduler, timeout=SCHEDULER_PATIENCE, set_as_default=False)


def _require_scheduler(address: str) -> None:
    """Raise BadInput unless a Dask scheduler answers at `address`: a client would wait for ever for an answer.

    The handshake runs in a thread of its own, which always ends, as the caller may be inside an event loop (Jupyter).
    """
    from distributed.comm import connect

    problems: list[BaseException] = []

    async def greet() -> None:
        greeting = connect(address, timeout=SCHEDULER_PATIENCE)
        await (await asyncio.wait_for(greeting, SCHEDULER_PATIENCE + 1.0)).close()

    def attempt() -> None:
        try:
            asyncio.run(greet())
        except Exception as problem:  # whatever another program's answer leads to
            problems.append(problem)

    thread = threading.Thread(target=attempt, daemon=True)
    thread.start()
    thread.join()
    if problems:
        raise BadInput(
            f"no Dask scheduler answers there ({_cause(problems[0])})", field="--scheduler", value=address,
            allowed="the address of a running one, such as tcp://host:8786",
        )  # fmt: skip
