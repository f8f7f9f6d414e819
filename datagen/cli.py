"""The command `spallgen`: every command of `datagen.commands`; help lists them by name."""

from __future__ import annotations

import io
import os
import sys

from datagen.commands import (
    catalog,
    chart,
    check,
    classify,
    features,
    generate,
    import_recordings,
    info,
    paper,
    preview,
    report,
    schema,
    size,
)
from datagen.commands.program import app
from datagen.exits import OUTPUT_CLOSED
from datagen.freed_memory import keep_freed_memory
from datagen.garbage import collect_seldom

# Each is a command of the app by being imported.
COMMANDS = (
    generate,
    import_recordings,
    check,
    info,
    preview,
    report,
    paper,
    chart,
    features,
    classify,
    size,
    catalog,
    schema,
)


def main() -> None:
    """Run the command line and end the process with 0, 1 (a check failed, or records could not be made), 2 (bad input),
    130 (Ctrl-C), 141 (nobody reads the output any more) or 143 (SIGTERM).

    The process keeps the memory of freed arrays (datagen.freed_memory) and collects garbage rarely.
    """
    collect_seldom()
    keep_freed_memory()
    _open_what_was_closed()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # of an encoding that may lack ≤ and its like
            stream.reconfigure(errors="replace")
    try:
        app()
    finally:
        _write_out()


def _open_what_was_closed() -> None:
    """Let the standard streams that whoever started the program has closed lead nowhere.

    Their numbers are taken, lest a file get one of them, and inherited: a worker without standard error ends at once.
    """
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115


def _write_out() -> None:
    """Flush standard output and error; ends the process if nobody reads them.

    What cannot be written is dropped: Python would try again as it exits, and complain.
    """
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError as problem:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
            if isinstance(problem, BrokenPipeError):
                sys.exit(OUTPUT_CLOSED)
