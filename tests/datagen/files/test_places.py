"""Places for results that cannot be: refused in one message before any work."""

from __future__ import annotations

import errno
import os
import tempfile
from pathlib import Path
from typing import Any

import pytest
from command_line import run

from datagen.errors import BadInput
from datagen.files.places import require_file, require_folder

FOLDERS = {
    "generate": ("generate", "RECIPE", "--out", "PLACE"),
    "report": ("report", "CORPUS", "--out", "PLACE"),
    "size": ("size", "CORPUS", "--out", "PLACE"),
    "paper": ("paper", "--out", "PLACE"),
    "chart": ("chart", "G1", "--out", "PLACE"),
    "classify": ("classify", "--train", "CORPUS", "--test", "CORPUS", "--out", "PLACE"),
}
WORK = (
    "datagen.runs.run.Run.make",
    "datagen.cards.corpus_report.corpus_facts",
    "datagen.sizing.corpus_run.score_sizes",
    "datagen.paper.book.import_module",
    "datagen.charts.measure.measure",
    "datagen.benchmark.classify.run",
    "datagen.records.record.make_record",
)


@pytest.fixture
def lock(monkeypatch):
    """Function (word) after which no folder with that word in its path takes files, whatever its permissions say."""

    def make(word: str) -> None:
        def in_open_folders(**given: Any) -> Any:
            if word in str(given["dir"]):
                raise OSError(errno.EROFS, "Read-only file system")
            return temporary_file(**given)

        temporary_file = tempfile.TemporaryFile
        monkeypatch.setattr(tempfile, "TemporaryFile", in_open_folders)

    return make


@pytest.fixture
def refused(tiny_recipe, tiny_corpus, monkeypatch):
    """Function (arguments, place) → the message of a command that must end with 2 before any work."""

    def worked(*_: object, **__: object) -> None:
        raise AssertionError("this was to be refused before any work")

    for name in WORK:
        monkeypatch.setattr(name, worked)

    def refused(arguments: tuple[str, ...], place: Path) -> str:
        words = {"RECIPE": tiny_recipe, "CORPUS": tiny_corpus, "PLACE": place}
        done = run(*(words.get(part, part) for part in arguments))
        assert done.exit_code == 2
        assert done.stderr.count("\n") == 1
        return done.stderr

    return refused


@pytest.mark.parametrize("name", ["manifest.json", "index.csv", "failed.jsonl", "scored_runs.jsonl", "shards/x.json"])
@pytest.mark.parametrize(
    "command",
    [("check", "CORPUS", "--json", "PLACE"), ("catalog", "--json", "PLACE"), ("schema", "--out", "PLACE")],
    ids=lambda command: command[0],
)
def test_a_file_of_a_corpus_is_not_written_over(command, name, refused, copy, tmp_path):
    before = {path: path.read_bytes() for path in copy.rglob("*") if path.is_file()}
    link = tmp_path / "link"
    link.symlink_to(copy)
    for folder in (copy, link):
        assert f'{folder / name}": a corpus has a file of its own there, which would be lost' in refused(
            command, folder / name
        )
    assert {path: path.read_bytes() for path in copy.rglob("*") if path.is_file()} == before


def test_results_are_not_written_to_where_the_corpus_they_tell_of_will_have_a_file(refused, tmp_path):
    (tmp_path / "new").mkdir()
    command = ("generate", "RECIPE", "--out", tmp_path / "new", "--json", "PLACE")
    assert "--json" in refused(command, tmp_path / "new" / "manifest.json")
    assert list((tmp_path / "new").iterdir()) == []


def test_results_may_be_put_beside_the_files_of_a_corpus(copy):
    assert run("info", copy, "--json", copy / "info.json").exit_code == 0
    assert (copy / "info.json").is_file()


@pytest.mark.parametrize("command", ["size", "paper", "chart", "classify"])
def test_results_are_not_put_among_the_files_of_a_corpus(command, refused, copy):
    before = sorted(copy.rglob("*"))
    for place in (copy, copy / "shards"):
        message = refused(FOLDERS[command], place)
        assert f'--out = "{place}": this is the folder of a corpus' in message
        assert message.endswith("allowed: a folder of its own\n")
    assert sorted(copy.rglob("*")) == before


@pytest.mark.parametrize("command", FOLDERS)
def test_a_file_is_no_folder(command, refused, tmp_path):
    (tmp_path / "file").write_text("mine")
    for place in (tmp_path / "file", tmp_path / "file" / "below"):
        assert f'--out = "{place}": {tmp_path / "file"} is in the way: it is not a folder' in refused(
            FOLDERS[command], place
        )
    assert (tmp_path / "file").read_text() == "mine"


@pytest.mark.parametrize("command", FOLDERS)
def test_a_folder_that_may_not_be_written_into_is_refused(command, refused, tmp_path, lock):
    lock(tmp_path.name)
    assert f"cannot write into {tmp_path}" in refused(FOLDERS[command], tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("place", ["a folder", "nowhere/results.json", "locked/results.json"])
@pytest.mark.parametrize(
    "arguments",
    [("preview", "RECIPE", "--out", "PLACE"), ("catalog", "--json", "PLACE"), ("schema", "--out", "PLACE")],
    ids=lambda arguments: arguments[0],
)
def test_a_place_for_a_file_is_looked_at_first(arguments, place, refused, tmp_path, lock):
    for folder in ("a folder", "a folder.png", "locked"):
        (tmp_path / folder).mkdir()
    lock("locked")
    if arguments[0] == "preview":
        place = place.removesuffix(".json") + ".png"
    words = {"a": "this is a folder", "nowhere": "no such folder", "locked": "cannot write into"}
    message = refused(arguments, tmp_path / place)
    assert words[place.replace("/", " ").split(" ")[0]] in message
    assert "allowed: a file in an existing folder that you may write into" in message


def test_a_name_too_long_for_a_file_is_refused(tmp_path):
    for require in (require_folder, require_file):
        with pytest.raises(BadInput, match="File name too long"):
            require(tmp_path / ("x" * 300))


def test_a_file_that_is_there_is_a_place_and_stays_as_it_is_until_it_is_written_over(tmp_path):
    old = tmp_path / "old.json"
    old.write_text("mine")
    require_file(old)
    assert [(path, path.read_text()) for path in tmp_path.iterdir()] == [(old, "mine")]


def test_results_may_go_to_a_terminal_or_to_nowhere():
    done = run("catalog", "--json", os.devnull)
    assert done.exit_code == 0
    assert "rig gearbox" in done.stdout


def test_whether_a_folder_takes_files_is_found_by_trying_and_nothing_is_left(tmp_path, lock):
    require_folder(tmp_path / "new")
    require_file(tmp_path / "new.json")
    assert list(tmp_path.iterdir()) == []
    lock(tmp_path.name)
    with pytest.raises(BadInput, match="cannot write into"):
        require_folder(tmp_path / "new")


def test_a_place_that_may_not_even_be_looked_at_ends_with_2(tmp_path, monkeypatch):
    def forbidden(path):
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr("datagen.recipes.recipe.find_recipe", forbidden)
    command = ["generate", str(tmp_path / "r.toml"), "--out", str(tmp_path / "out")]
    done = run(*command)
    assert done.exit_code == 2
    assert (
        done.stderr == f"error: {tmp_path / 'r.toml'}: Permission denied; allowed: a path that you may read and write\n"
    )
