"""What the log of scoring runs says of a run of classifiers."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from datagen.benchmark.model_scores import Scores
from datagen.judging.scored_runs import write_line


def log_run(folder: Path, training: Path, recipe: str, options: dict[str, Any], models: dict[str, Scores]) -> None:
    """Append one line: trained on which corpus and which `recipe` (its hash), with which options, and the scores of
    each of the models; raises BadInput."""
    line = {
        "train": str(training),
        "recipe": recipe,
        "options": options,
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
