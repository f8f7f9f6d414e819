"""The log of scoring runs on recordings: a line before and one after each run, appended in that corpus's own folder,
never rewritten."""

from __future__ import annotations

import errno
import json
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from datagen.errors import BadInput
from datagen.files.places import SCORED_RUNS, is_writable
from datagen.files.plain import plain
from datagen.versions import program_versions


def log_path(folder: Path) -> Path:
    """Where the runs that scored the corpus `folder` are listed."""
    return folder / SCORED_RUNS


def write_line(folder: Path, said: dict[str, Any]) -> None:
    """Append a line of JSON to the log of a corpus: what is `said` (null for NaN), when, and by which versions.

    Raises BadInput if it cannot be written: no run may score recordings without leaving a trace.
    """
    line = {"time": datetime.now(UTC).isoformat(timespec="seconds"), **said, "versions": program_versions()}
    try:
        with log_path(folder).open("a", encoding="utf-8") as file:
            file.write(json.dumps(plain(line), default=str, allow_nan=False) + "\n")
    except OSError as problem:
        raise _no_log(folder, problem.strerror) from None


def require_log(folder: Path) -> None:
    """Raise BadInput unless a line can be appended to the log of a corpus, which is left as it is."""
    path = log_path(folder)
    if not path.exists():
        if not is_writable(folder):
            raise _no_log(folder, os.strerror(errno.EACCES))
        return
    try:
        path.open("a").close()
    except OSError as problem:
        raise _no_log(folder, problem.strerror) from None


def _no_log(folder: Path, reason: str | None) -> BadInput:
    problem = f"runs on recordings are logged here, and it cannot be written: {reason}"
    return BadInput(
        problem, file=str(log_path(folder)), allowed="a corpus that can be written to, such as a copy of it"
    )
