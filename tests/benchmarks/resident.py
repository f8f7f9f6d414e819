"""The largest resident size of a process that runs a command of spallgen."""

from __future__ import annotations

import subprocess
import sys
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
    arguments; Linux alone tells it."""
    command = [sys.executable, "-c", RUNNING, *arguments]
    done = subprocess.run(command, check=True, cwd=ROOT, capture_output=True, text=True)
    return float(done.stdout.split()[-1]) * 1024.0 / 1e6  # told in units of 1024 bytes


def by_number(sizes: dict[str, float]) -> str:
    """Sizes by number of records, as a page says them."""
    return ", ".join(f"{size:.0f} MB ({records})" for records, size in sizes.items())
