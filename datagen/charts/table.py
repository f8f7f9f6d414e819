"""A chart as a table."""

from __future__ import annotations

import csv
import io

from datagen.charts.measure import Chart

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
