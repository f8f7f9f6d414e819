"""Writes the table of docs/features.md: python docs/make_features.py."""

from __future__ import annotations

from pathlib import Path

from marked_tables import write_marked

from datagen.files.text_tables import markdown_table
from labels.features.table import FEATURES

PAGE = Path(__file__).with_name("features.md")


def table() -> str:
    """The table of all features, and below it the sources that its last column numbers."""
    number = {source: place for place, source in enumerate(dict.fromkeys(row.source for row in FEATURES), start=1)}
    rows = [[f"`{row.name}`", row.dimension, row.sentence, number[row.source]] for row in FEATURES]
    sources = [f"{place}. {source}" for source, place in number.items()]
    table = markdown_table(["feature", "unit", "what it is", "source"], rows)
    return "\n".join([table, "", "Sources:", "", *sources])


if __name__ == "__main__":
    write_marked(PAGE, "features", __file__, table())
