"""Writes docs/features.md, the feature table: python docs/make_features.py."""

from __future__ import annotations

from pathlib import Path

from labels.features.table import FEATURES

PAGE = Path(__file__).with_name("features.md")
HEAD = """# The feature table

Written by `docs/make_features.py` from `labels/features/table.py`. All are free of scale and counted in orders of the
shaft; "ln nat" is ln(1 + evidence), evidence being a log likelihood ratio in nats (`labels/features/families.py`).

| feature | unit | what it is | source |
|---|---|---|---|
"""


def page() -> str:
    """The page's text."""
    rows = [f"| `{row.name}` | {row.dimension} | {row.sentence} | {row.source} |" for row in FEATURES]
    return HEAD + "\n".join(rows) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
