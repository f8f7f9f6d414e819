"""What the README promises to people who copy its lines, and what the pages point to."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted(page for folder in ("datasets", "docs") for page in (ROOT / folder).rglob("*.md"))]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```sh\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)


def test_the_first_two_shell_blocks_are_one_line_each():
    assert len(BLOCKS) >= 2
    for block in BLOCKS[:2]:
        assert block.count("\n") == 1


def test_the_first_makes_the_quick_start_and_the_second_runs_the_tests():
    assert "spallgen generate datasets/quickstart --out " in BLOCKS[0]
    assert "pytest" in BLOCKS[1]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_module_picture_page_and_heading_that_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"`((?:physics|labels|datagen|tests|docs)/[\w/]+\.py)`", text):
        assert (ROOT / name).exists(), name
    for target in re.findall(r"\]\(([^)#:]+)\)", text):
        assert (page.parent / target).exists(), target
    for target, anchor in re.findall(r"\]\(([^)#:]*)#([^)]+)\)", text):
        aimed_at = page.parent / target if target else page
        prose = re.sub(r"^```.*?^```$", "", aimed_at.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        headings = re.findall(r"^#+ (.*)$", prose, re.MULTILINE)
        assert anchor in [re.sub(r"[^\w -]", "", one.lower()).replace(" ", "-") for one in headings], anchor
