"""Tables of the comparison as CSV and as the page that shows figures and tables together."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from datagen.paper.chapter import Chapter, Row

COLUMNS = ("quantity", "paper", "ours", "difference", "unit", "agrees", "comment", "where")
BOUNDS = {"at most": "≤ ", "at least": "≥ ", "equal": ""}
VERDICTS = {True: "yes", False: "**no**", None: ""}
INTRODUCTION = """# The paper's figures, simulated

Counterparts of Figures 5 to 11 of D. Petersen, C. Howard, N. Sawalhi, A. Moazen Ahmadi, S. Singh, "Analysis of bearing
stiffness variations, contact forces and vibrations in radially loaded double row rolling element bearings with raceway
defects", Mechanical Systems and Signal Processing, 2014, and three questions it leaves open. This page, its pictures
and its tables were written by

    spallgen paper --out DIR

Every number in the column "ours" is computed. Numbers of the paper are those it prints in text, tables and axes: its
curves themselves were not digitised, so where it prints none, the end of an axis (≤, ≥) or its words stand instead.
"agrees" compares with half a unit of the last digit printed, with the end of the axis, or judges the words.
"""


def csv_text(rows: Sequence[Row]) -> str:
    """The table as CSV with a heading; empty where there is no number."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        writer.writerow([row.quantity, _said(row), f"{row.ours:.6g}", _difference(row), *_rest(row)])
    return text.getvalue()


def _rest(row: Row) -> list[str]:
    verdict = "" if row.agrees is None else str(row.agrees).lower()
    return [row.unit, verdict, row.comment, row.where]


def _said(row: Row) -> str:
    """What the paper says: its number with the sense of a bound, or its words."""
    return row.claim if row.paper is None else f"{BOUNDS[row.sense]}{row.paper:.6g}"


def _difference(row: Row) -> str:
    return "" if row.difference is None else f"{row.difference:+.3g}"


def summary(chapters: Sequence[Chapter]) -> list[tuple[str, int, int]]:
    """Title, rows that agree and rows that were compared, for each chapter."""
    found = []
    for chapter in chapters:
        verdicts = [row.agrees for row in chapter.rows if row.agrees is not None]
        found.append((chapter.title, sum(verdicts), len(verdicts)))
    return found


def page(chapters: Sequence[Chapter]) -> str:
    """The page in Markdown: a summary, then every figure with its table."""
    parts = [INTRODUCTION, "| figure | agree | compared |\n|---|---|---|"]
    parts[-1] += "".join(f"\n| {title} | {agree} | {compared} |" for title, agree, compared in summary(chapters))
    for chapter in chapters:
        parts.append(f"## {chapter.title}\n\n{chapter.text}\n\n![{chapter.title}]({chapter.name}.png)")
        parts.append(_markdown(chapter.rows))
    return "\n\n".join(parts) + "\n"


def _markdown(rows: Sequence[Row]) -> str:
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    for row in rows:
        cells = (
            row.quantity,
            _said(row),
            f"{row.ours:.4g}",
            _difference(row),
            row.unit,
            VERDICTS[row.agrees],
            row.comment,
            row.where,
        )
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines)
