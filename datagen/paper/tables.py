"""Tables of the comparison as CSV and as the page that shows figures and tables together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from datagen.files.text_tables import csv_text, markdown_table
from datagen.paper.chapter import Chapter, Row

COLUMNS = ("quantity", "paper", "ours", "difference", "unit", "agrees", "comment", "where")
BOUNDS = {"at most": "≤ ", "at least": "≥ ", "equal": ""}
PLAIN_VERDICTS = {True: "true", False: "false", None: ""}
MARKED_VERDICTS = {True: "yes", False: "**no**", None: ""}
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


def chapter_csv(rows: Sequence[Row]) -> str:
    """The table of a chapter as CSV with a heading; empty where there is no number."""
    return csv_text(COLUMNS, (_cells(row, digits=6, verdicts=PLAIN_VERDICTS) for row in rows))


def _cells(row: Row, digits: int, verdicts: Mapping[bool | None, str]) -> tuple[str, ...]:
    """What the COLUMNS say of a row."""
    ours, verdict = f"{row.ours:.{digits}g}", verdicts[row.agrees]
    return (row.quantity, _said(row), ours, _difference(row), row.unit, verdict, row.comment, row.where)


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
    parts = [INTRODUCTION, markdown_table(("figure", "agree", "compared"), summary(chapters))]
    for chapter in chapters:
        parts.append(f"## {chapter.title}\n\n{chapter.text}\n\n![{chapter.title}]({chapter.name}.png)")
        rows = (_cells(row, digits=4, verdicts=MARKED_VERDICTS) for row in chapter.rows)
        parts.append(markdown_table(COLUMNS, rows))
    return "\n\n".join(parts) + "\n"
