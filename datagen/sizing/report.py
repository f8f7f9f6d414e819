"""The report of a scored corpus: every row, every figure, and pictures of where the errors lie."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING, Any

from datagen.plain import plain_json
from datagen.sizing.score import SizeScores

if TYPE_CHECKING:
    from rich.table import Table


def write_report(scores: SizeScores, folder: Path) -> None:
    """Write `size_report.json`, `estimates.csv` and, where the truth is known, `size_report.png` into `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "size_report.json").write_text(plain_json({"summary": scores.summary, "split": scores.split,
                                                         "estimator": scores.estimator}))  # fmt: skip
    _write_rows(scores, folder / "estimates.csv")
    if scores.summary is not None:
        from datagen.drawing.size_report import draw_size_report

        draw_size_report(scores, folder / "size_report.png")


def _write_rows(scores: SizeScores, path: Path) -> None:
    rows = [one.to_dict() for one in scores.records]
    for row in rows:
        row["candidates"] = " ".join(format(value, ".6g") for value in row["candidates"])
        for kind in ("events_in_time", "events_in_arc"):
            events = row.pop(kind)
            row |= {f"{kind}_matched": events.matched, f"{kind}_found": events.found, f"{kind}_true": events.true}
    with path.open("w", newline="", encoding="utf-8") as file:
        if rows:
            writer = csv.DictWriter(file, list(rows[0]))
            writer.writeheader()
            writer.writerows(rows)


def summary_table(summary: dict[str, Any]) -> Table:
    """Every figure with its interval, its number of records and its target."""
    from rich.table import Table

    table = Table(title=f"{summary['records']} records with known truth, {summary['scorable']} to be told a size")
    for name in ("figure", "value", "90 % interval", "records", "target", "met"):
        table.add_column(name, justify="left" if name == "figure" else "right")
    for figure in summary["figures"]:
        if figure.count:
            met = "" if figure.met is None else "yes" if figure.met else "NO"
            interval = f"{figure.low:.3f} to {figure.high:.3f}"
            table.add_row(figure.name, f"{figure.value:.3f}", interval, str(figure.count), figure.target, met)
    for name, events in summary["events"].items():
        table.add_row(f"events {name.replace('_', ' ')}: F1", f"{events['f1']:.3f}", "", str(events["true"]), "", "")
    return table
