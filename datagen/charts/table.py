"""A chart as a table."""

from __future__ import annotations

from collections.abc import Iterator

from datagen.charts.measure import Chart
from datagen.files.text_tables import csv_text

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


def chart_table(chart: Chart) -> str:
    """CSV of all runs, one row each; empty where a number does not apply."""
    return csv_text(COLUMNS, _rows(chart))


def _rows(chart: Chart) -> Iterator[list[object]]:
    for run in chart.runs:
        score = run.score
        errors: list[object] = [""] * 7
        if score is not None:
            numbers = (score.acceleration, score.envelope_db, score.release_us, score.regain_us, score.worst_event_us)
            errors = [_short(number) for number in (*numbers, float(score.events_missed), score.stiffness)]
        timing = [_short(number) for number in (run.duration, run.seconds, run.real_time)]
        yield [run.group, run.name, run.setting, *timing, *errors, run.failure]


def _short(number: float) -> str:
    return f"{number:.6g}" if number == number else ""
