"""Arrays that are freed leave their memory to the next ones."""

import os
import platform
import subprocess
import sys

import pytest

from datagen.freed_memory import CHOSEN_BY

PROGRAM = """
import resource
import numpy as np
from datagen.freed_memory import keep_freed_memory

print(int({call}))


def come_and_go(times):
    for _ in range(times):
        [np.ones(1 << 17) for _ in range(8)]


come_and_go(3)
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
come_and_go(20)
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


def run(call: str, **environment: str) -> list[int]:
    clean = {name: value for name, value in os.environ.items() if name not in CHOSEN_BY}
    command = [sys.executable, "-c", PROGRAM.format(call=call)]
    said = subprocess.run(command, env=clean | environment, capture_output=True, text=True, check=True)
    return [int(word) for word in said.stdout.split()]


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc is told to keep what is freed")
def test_pages_of_freed_arrays_are_not_fetched_again():
    kept, faults = run("keep_freed_memory()")
    assert kept == 1
    assert faults < 1000  # 160 arrays of 1 MB are 40 960 pages; larger ones numpy puts onto huge pages


def test_what_the_user_has_chosen_is_left_alone():
    assert run("keep_freed_memory()", MALLOC_MMAP_THRESHOLD_="65536")[0] == 0
