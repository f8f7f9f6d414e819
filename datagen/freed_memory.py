"""Memory that is freed is kept for the next arrays instead of being given back to the system.

The arrays of a record are megabytes that come and go with it. The C library fetches each of these from the system anew,
which clears it page by page on first touch: a fifth of the time of a simulation. It is for whoever owns the process to
ask for: the command line and the makers of records do, the physics cannot.
"""

from __future__ import annotations

import ctypes
import os
from functools import cache

# Names of glibc's mallopt(3).
TRIM_THRESHOLD, MMAP_THRESHOLD = -1, -3
# The largest threshold that glibc takes; below it arrays come from memory that stays.
LARGEST_THRESHOLD = 32 << 20
KEPT = 1 << 30
# Whoever has set one of these has chosen already.
CHOSEN_BY = ("MALLOC_MMAP_THRESHOLD_", "MALLOC_TRIM_THRESHOLD_", "GLIBC_TUNABLES")


@cache
def keep_freed_memory() -> bool:
    """Let this process keep up to a gigabyte of freed memory, all of it and to its end; False if the C library is
    another, or asked already."""
    if any(os.environ.get(name) for name in CHOSEN_BY):
        return False
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError, TypeError):  # not glibc
        return False
    return bool(mallopt(MMAP_THRESHOLD, LARGEST_THRESHOLD) and mallopt(TRIM_THRESHOLD, KEPT))
