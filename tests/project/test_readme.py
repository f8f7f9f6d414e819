"""What the README promises to people who copy its lines."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```sh\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)


def test_the_first_two_shell_blocks_are_one_line_each():
    assert len(BLOCKS) >= 2
    for block in BLOCKS[:2]:
        assert block.count("\n") == 1


def test_the_first_makes_the_quick_start_and_the_second_runs_the_tests():
    assert "spallgen generate datasets/quickstart --out " in BLOCKS[0]
    assert "pytest" in BLOCKS[1]


def test_every_picture_and_page_it_points_to_exists():
    for target in re.findall(r"\]\(([^)#]+)\)", TEXT):
        assert (ROOT / target).exists(), target
