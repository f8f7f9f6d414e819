"""The log of scoring runs on recordings: a line before and one after each run, appended in that corpus's own folder,
never rewritten."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from datagen.errors import BadInput

NAME = "scored_runs.jsonl"


def log_path(folder: Path) -> Path:
    """Where the runs that scored the corpus `folder` are listed."""
    return folder / NAME


def write_line(folder: Path, line: dict[str, Any]) -> None:
    """Append one line to the log of a corpus; raises BadInput if that is impossible."""
    try:
        with log_path(folder).open("a", encoding="utf-8") as file:
            file.write(json.dumps(line, default=str) + "\n")
    except OSError as problem:
        raise BadInput(f"runs on recordings are logged here, and it cannot be written: {problem.strerror}",
                       str(log_path(folder))) from None  # fmt: skip
