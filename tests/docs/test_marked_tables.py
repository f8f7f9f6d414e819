"""Tables that scripts write into the project's pages."""

import re
from pathlib import Path

import pytest
from marked_tables import ROOT, write_marked

SCRIPT = str(ROOT / "docs" / "make_accuracy.py")
BEGIN, END = "<!-- speeds: begin (written by docs/make_accuracy.py) -->", "<!-- speeds: end -->"


def test_what_stands_between_the_marks_is_replaced_and_nothing_else(tmp_path):
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BEGIN}\nold\n{END}\nµ after\n", encoding="utf-8")
    write_marked(page, "speeds", SCRIPT, "| new |\n|---|")
    assert page.read_text(encoding="utf-8") == f"before\n{BEGIN}\n| new |\n|---|\n{END}\nµ after\n"


@pytest.mark.parametrize("text", ["", f"{BEGIN}\n", f"{END}\n{BEGIN}\n", f"{BEGIN}\n{END}\n{BEGIN}\n{END}\n"])
def test_a_page_without_the_marks_or_with_them_twice_is_refused_and_left_alone(text, tmp_path):
    page = tmp_path / "page.md"
    page.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match="each once"):
        write_marked(page, "speeds", SCRIPT, "new")
    assert page.read_text(encoding="utf-8") == text


def test_every_mark_of_the_pages_names_a_script_that_writes_it():
    marks = [
        found
        for page in (ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *(ROOT / "datasets").rglob("*.md"))
        for found in re.findall(r"<!-- ([^:]+): begin \(written by (\S+)\) -->", page.read_text(encoding="utf-8"))
    ]
    assert len(marks) >= 10
    for name, script in marks:
        assert f'"{name}"' in Path(ROOT / script).read_text(encoding="utf-8"), (name, script)
