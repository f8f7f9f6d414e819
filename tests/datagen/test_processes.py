"""Worker processes: what they are given they may change, and they end with their parent."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
from joblib import Parallel, delayed

from datagen.processes import processes

WAITING = """
import os, time
from joblib import Parallel, delayed
from datagen.processes import processes

def wait():
    print(os.getpid(), flush=True)
    time.sleep(600.0)

with processes(2):
    Parallel()(delayed(wait)() for _ in range(2))
"""


def negated(values):
    values *= -1.0
    return os.getpid(), values.sum()


def test_tasks_may_change_what_they_are_given_in_every_process():
    long = np.ones(1_000_000)
    with processes(2):
        found = Parallel()(delayed(negated)(long) for _ in range(2))
    assert [total for _, total in found] == [-1e6, -1e6]
    assert os.getpid() not in [process for process, _ in found]
    assert long.sum() == 1e6


def runs(process):
    try:
        with open(f"/proc/{process}/stat", encoding="ascii") as file:
            return file.read().rpartition(")")[2].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_workers_end_when_their_parent_is_killed():
    parent = subprocess.Popen([sys.executable, "-c", WAITING], stdout=subprocess.PIPE, text=True)
    workers = [int(parent.stdout.readline()) for _ in range(2)]
    assert all(map(runs, workers))
    os.kill(parent.pid, signal.SIGKILL)
    parent.wait()
    parent.stdout.close()
    given_up = time.monotonic() + 30.0
    while any(map(runs, workers)) and time.monotonic() < given_up:
        time.sleep(0.05)
    assert not any(map(runs, workers))
