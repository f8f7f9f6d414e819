"""The largest resident sizes of processes that run a command of spallgen; Linux alone tells them."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RUNNING = """
import sys
from datagen.cli import main
sys.argv = ["spallgen", *sys.argv[1:]]
try:
    main()
except SystemExit as end:
    assert not end.code
# What getrusage tells of a process that has been started begins with the size of the one that started it.
print(next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""


def largest_resident(*arguments: str) -> float:
    """Size (MB, as the package counts them: 1e6 bytes) of the process itself, when the command line has these
    arguments."""
    command = [sys.executable, "-c", RUNNING, *arguments]
    done = subprocess.run(command, check=True, cwd=ROOT, capture_output=True, text=True)
    return float(done.stdout.split()[-1]) * 1024.0 / 1e6  # told in units of 1024 bytes


def largest_on_the_way(done: Callable[[], int], marks: tuple[int, ...], *arguments: str) -> dict[str, dict[str, float]]:
    """Largest sizes (MB) so far of the `parent`, which runs the command line with these arguments, and of the largest
    `worker` that it started, when the work had got to each of the `marks`; the last one is the end of the work."""
    parent = subprocess.Popen([sys.executable, "-m", "datagen", *arguments], cwd=ROOT, stdout=subprocess.DEVNULL)
    sizes, found = {parent.pid: 0.0}, dict[str, dict[str, float]]()
    while parent.poll() is None:
        sizes |= {process: size for process, size in _sizes().items() if process in _with_children(parent.pid)}
        reached = done()
        workers = [size for process, size in sizes.items() if process != parent.pid]
        now = {"parent": sizes[parent.pid], "worker": max(workers, default=0.0)}
        found |= {str(mark): now for mark in marks[:-1] if reached >= mark and str(mark) not in found}
        found[str(marks[-1])] = now
        time.sleep(0.25)
    if parent.returncode or done() != marks[-1]:
        raise RuntimeError(f"the run ended with code {parent.returncode} at {done()} of {marks[-1]}")
    return {str(mark): found[str(mark)] for mark in marks}


def _status(key: str) -> dict[int, int]:
    """That line's number for every process that has one."""
    found = {}
    for path in Path("/proc").glob("[0-9]*/status"):
        with suppress(OSError, StopIteration):  # the process has ended
            lines = path.read_text(encoding="utf-8").splitlines()
            found[int(path.parent.name)] = int(next(line.split()[1] for line in lines if line.startswith(f"{key}:")))
    return found


def _sizes() -> dict[int, float]:
    return {process: size * 1024.0 / 1e6 for process, size in _status("VmHWM").items()}


def _with_children(process: int) -> set[int]:
    return {process} | {child for child, parent in _status("PPid").items() if parent == process}


def by_number(sizes: dict[str, float]) -> str:
    """Sizes by number of records, as a page says them."""
    return ", ".join(f"{size:.0f} MB ({records})" for records, size in sizes.items())
