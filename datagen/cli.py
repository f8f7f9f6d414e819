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

COMMANDS = (generate, import_recordings, check, info, preview, report, paper, chart, classify, size, catalog, schema)


def main() -> None:
    """Run the command line; ends the process with 0, 1 (a check failed), 2 (bad input), 130 (Ctrl-C), 143 (SIGTERM)."""
    if sys.stdout is None:  # closed by whoever started the program
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # of an encoding that may lack ≤ and its like
            stream.reconfigure(errors="replace")
    app()
