"""The log of scoring runs on recordings: one line a run, appended in that corpus's own folder, never rewritten."""

from __future__ import annotations

import json
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from datagen.benchmark.model_scores import Scores
from datagen.errors import BadInput
from datagen.records.versions import program_versions

NAME = "scored_runs.jsonl"


def log_path(folder: Path) -> Path:
    """Where the runs that scored the corpus `folder` are listed."""
    return folder / NAME


def log_run(folder: Path, training: Path, recipe: str, options: dict[str, Any], models: dict[str, Scores]) -> None:
    """Append one line: when, trained on which corpus and which `recipe` (its hash), with which options, and the scores
    of each of the models.

    Raises BadInput if the folder cannot be written: a run that leaves no trace is not made.
    """
    line = {
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "train": str(training),
        "recipe": recipe,
        "options": options,
        "versions": program_versions(),
        "scores": {
            name: {
                "faults_balanced_accuracy": asdict(scores.faults_balanced_accuracy),
                "false_alarms": scores.false_alarms,
                "healthy": scores.healthy,
                "rejected": scores.rejected,
            }
            for name, scores in models.items()
        },
    }
    write_line(folder, line)


def write_line(folder: Path, line: dict[str, Any]) -> None:
    """Append one line to the log of a corpus; raises BadInput if that is impossible."""
    try:
        with log_path(folder).open("a", encoding="utf-8") as file:
            file.write(json.dumps(line, default=str) + "\n")
    except OSError as problem:
        raise BadInput(f"runs on recordings are logged here, and it cannot be written: {problem.strerror}",
                       str(log_path(folder))) from None  # fmt: skip
