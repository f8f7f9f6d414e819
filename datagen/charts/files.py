"""A chart as files: picture, table and JSON of one name."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from datagen.charts.measure import Chart
from datagen.corpora.atomic import write_results
from datagen.places import require_results_folder
from datagen.plain import plain_json

COLUMNS = (
    "group",
    "name",
    "setting",
    "duration_s",
    "seconds",
    "times_real_time",
    "acceleration_error",
    "envelope_error_db",
    "release_error_us",
    "regain_error_us",
    "worst_event_error_us",
    "events_missed",
    "stiffness_error",
    "failure",
)


def chart_folder(folder: Path) -> Path:
    """The folder to write into, made if need be; raises BadInput if that cannot be."""
    require_results_folder(folder)
    write_results(folder, {})
    return folder


def write_files(
    folder: Path, name: str, pictures: bytes | Sequence[bytes], facts: object, table: str | None = None
) -> list[Path]:
    """Write NAME.png, of several pictures also NAME_2.png and so on, NAME.json and, if there is a table, NAME.csv.

    Gives their paths; raises BadInput where they cannot be written, as on a full disk.
    """
    sheets = [pictures] if isinstance(pictures, bytes) else pictures
    contents = {f"{name}.png" if k == 1 else f"{name}_{k}.png": sheet for k, sheet in enumerate(sheets, 1)}
    contents[f"{name}.json"] = plain_json(facts).encode()
    if table is not None:
        contents[f"{name}.csv"] = table.encode()
    write_results(folder, contents)
    return [folder / file for file in contents]


def chart_table(chart: Chart) -> str:
    """CSV of all runs, one row each; empty where a number does not apply."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for run in chart.runs:
        score = run.score
        errors: list[object] = [""] * 7
        if score is not None:
            numbers = (score.acceleration, score.envelope_db, score.release_us, score.regain_us, score.worst_event_us)
            errors = [_short(number) for number in (*numbers, float(score.events_missed), score.stiffness)]
        timing = [_short(number) for number in (run.duration, run.seconds, run.real_time)]
        writer.writerow([run.group, run.name, run.setting, *timing, *errors, run.failure])
    return text.getvalue()


def _short(number: float) -> str:
    return f"{number:.6g}" if number == number else ""
