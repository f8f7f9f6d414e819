"""The report of a scored corpus: every row, every figure, and pictures of where the errors lie."""

from __future__ import annotations

from pathlib import Path

from datagen.files.atomic import write_results
from datagen.files.plain import plain_json
from datagen.files.text_tables import csv_text
from datagen.sizing.flat_rows import flat_row, flat_scores
from datagen.sizing.size_scores import SizeScores

PICTURE = "size_report.png"
LISTS = ("candidates", "candidates_deg", "candidates_mm")


def write_report(scores: SizeScores, folder: Path, picture: bytes | None) -> list[str]:
    """Write `size_report.json`, `estimates.csv` and, if there is a `picture`, `size_report.png` into `folder`.

    Without one, that of an earlier report there is deleted: it would show other sizes. Gives the names of what was
    written; BadInput if it cannot be.
    """
    files = {
        "size_report.json": plain_json(flat_scores(scores)).encode(),
        "estimates.csv": estimates_csv(scores).encode(),
    }
    if picture is not None:
        files[PICTURE] = picture
    write_results(folder, files, gone=() if picture is not None else (PICTURE,))
    return list(files)


def estimates_csv(scores: SizeScores) -> str:
    """The table of all records as CSV; `passes_heard` counts the passes whose event times the JSON has."""
    rows = [flat_row(record) for record in scores.records]
    for row in rows:
        row |= {name: " ".join(format(value, ".6g") for value in row[name]) for name in LISTS}
        row["passes_heard"] = len(row.pop("event_times"))
        for kind in ("events_in_time", "events_in_arc"):
            events = row.pop(kind)
            row |= {f"{kind}_matched": events.matched, f"{kind}_found": events.found, f"{kind}_true": events.true}
    columns = list(rows[0])
    return csv_text(columns, ([row[name] for name in columns] for row in rows))
