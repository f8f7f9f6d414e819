"""How the programs of this package end: their exit codes, and the line that tells what went wrong."""

from __future__ import annotations

import sys

FAILED = 1  # a check failed, or records could not be made
BAD_INPUT = 2
INTERRUPTED = 130
# As shells report a program ended by SIGPIPE, 128 + 13; Python ignores that signal.
OUTPUT_CLOSED = 141
TERMINATED = 143


def print_error(problem: object) -> None:
    """Say on standard error, in one line, what went wrong."""
    print(f"error: {problem}", file=sys.stderr, flush=True)
