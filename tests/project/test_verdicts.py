"""The verdicts at the top of the pages of scores quote the tables below them, which scripts write."""

import re
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.mark.parametrize("page", ["size.md", "transfer.md"])
def test_every_decimal_of_the_verdict_stands_in_a_table_of_the_page(page):
    text = (DOCS / page).read_text(encoding="utf-8")
    verdict = text.split("## Should I trust it, and for what?\n")[1].split("\n## ")[0]
    tables = "".join(re.findall(r"<!-- [^>]*: begin .*?: end -->", text, re.DOTALL))
    figures = re.findall(r"\d+\.\d+", verdict)
    assert len(figures) > 8
    assert [figure for figure in figures if figure not in re.findall(r"\d+\.\d+", tables)] == []
