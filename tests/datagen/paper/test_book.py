import csv
import errno
import json
import tempfile
from pathlib import Path

import pytest
from command_line import run

from datagen.errors import BadInput
from datagen.paper.book import CHAPTERS, chosen, write_book
from datagen.paper.chapter import Chapter, Row
from datagen.paper.tables import page, summary

DOCS = Path(__file__).parents[3] / "docs" / "paper"


def test_the_command_writes_pictures_tables_page_and_results(tmp_path):
    out, results = tmp_path / "a" / "paper", tmp_path / "results.json"
    code, shown, message = run("paper", "--out", out, "--figures", "7,6", "--json", results)
    assert code == 0, message
    assert {path.name for path in out.iterdir()} == {
        "figure6.png", "figure6.csv", "figure7.png", "figure7.csv", "paper.json", "README.md",
    }  # fmt: skip
    assert (out / "figure6.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads(results.read_text()) == json.loads((out / "paper.json").read_text())
    assert "Figure 6" in shown
    text = (out / "README.md").read_text(encoding="utf-8")
    assert text.index("![Figure 6") < text.index("![Figure 7")
    assert "spallgen paper --out DIR" in text


def test_the_table_has_the_paper_s_number_ours_difference_and_comment(tmp_path):
    write_book(tmp_path, ["6"])
    rows = list(csv.DictReader((tmp_path / "figure6.csv").read_text(encoding="utf-8").splitlines()))
    first = rows[0]
    assert (first["quantity"], first["paper"], first["ours"]) == ("period of kxx of one row, healthy", "30", "30")
    assert (first["difference"], first["agrees"], first["where"]) == ("+0", "true", "section 5.4")
    assert any(row["paper"] == "≤ 100" for row in rows)


@pytest.mark.parametrize("figures", ["4", "5,,6", "5;6", "q4", ""])
def test_an_unknown_figure_is_bad_input_and_nothing_is_written(figures, tmp_path):
    code, _, message = run("paper", "--out", tmp_path / "out", "--figures", figures)
    assert code == 2
    assert "--figures" in message
    assert "q3" in message
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_made_is_bad_input(tmp_path):
    (tmp_path / "file").write_text("")
    for out in (tmp_path / "file", tmp_path / "file" / "below"):
        code, _, message = run("paper", "--out", out, "--figures", "6")
        assert code == 2
        assert "--out" in message
        assert "Traceback" not in message


def test_a_folder_that_cannot_be_written_into_is_bad_input(tmp_path, monkeypatch):
    def full(**_: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(tempfile, "TemporaryFile", full)
    with pytest.raises(BadInput, match="cannot write into"):
        write_book(tmp_path, ["6"])
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_fills_up_is_bad_input_that_names_the_folder(tmp_path, monkeypatch):
    def full(path, data):
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr("datagen.files.atomic.write_atomically", full)
    code, _, message = run("paper", "--out", tmp_path, "--figures", "6")
    assert code == 2
    assert "No space left on device" in message
    assert str(tmp_path) in message


def test_chapters_come_in_the_order_of_the_paper():
    assert chosen(None) == list(CHAPTERS)
    assert chosen("Q1, 10,5") == ["5", "10", "q1"]


def test_the_page_counts_what_agrees_and_escapes_bars():
    rows = (
        Row("a|b", 1.0, "N", paper=1.0, agrees=True, where="x"),
        Row("c", 2.0, "N", claim="words", agrees=False, where="y"),
        Row("d", 3.0, "N"),
    )
    one = Chapter("figure0", "Title", "Text.", rows, lambda: None)
    assert summary([one]) == [("Title", 1, 2)]
    text = page([one])
    assert "| Title | 1 | 2 |" in text
    assert "a\\|b" in text
    assert "| c | words | 2 |  | N | **no** |  | y |" in text


def test_the_pages_in_the_documentation_hold_every_chapter_and_are_small():
    held = json.loads((DOCS / "paper.json").read_text(encoding="utf-8"))
    assert len(held) == len(CHAPTERS)
    assert all((DOCS / one["picture"]).is_file() for one in held.values())
    assert sum(path.stat().st_size for path in DOCS.iterdir()) < 2.5e6


@pytest.mark.parametrize("key", ["5", "6", "7"])
def test_the_numbers_in_the_documentation_are_those_computed_now(key, chapter):
    one = chapter(key)
    held = json.loads((DOCS / "paper.json").read_text(encoding="utf-8"))[one.name]["rows"]
    assert [row["quantity"] for row in held] == [row.quantity for row in one.rows]
    for now, then in zip(one.rows, held, strict=True):
        assert now.agrees == then["agrees"]
        assert now.ours == pytest.approx(then["ours"], rel=1e-3, abs=1e-6)  # other machines round otherwise


@pytest.mark.slow
def test_the_whole_command_writes_every_chapter_and_agrees_with_the_documentation(tmp_path):
    code, _, message = run("paper", "--out", tmp_path / "out")
    assert code == 0, message
    now = json.loads((tmp_path / "out" / "paper.json").read_text(encoding="utf-8"))
    then = json.loads((DOCS / "paper.json").read_text(encoding="utf-8"))
    assert list(now) == list(then)
    for name, chapter in now.items():
        assert [row["agrees"] for row in chapter["rows"]] == [row["agrees"] for row in then[name]["rows"]], name
