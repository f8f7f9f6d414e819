"""Writes the table of docs/features.md: python docs/make_features.py."""

from __future__ import annotations

from pathlib import Path

from marked_tables import write_marked

from labels.features.table import FEATURES

PAGE = Path(__file__).with_name("features.md")
HEAD = "| feature | unit | what it is | source |\n|---|---|---|---|\n"


def table() -> str:
    """The table of all features."""
    rows = [f"| `{row.name}` | {row.dimension} | {row.sentence} | {row.source} |" for row in FEATURES]
    return HEAD + "\n".join(rows)


if __name__ == "__main__":
    write_marked(PAGE, "features", __file__, table())
