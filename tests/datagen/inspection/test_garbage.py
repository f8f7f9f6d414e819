"""Manifests and indices that are none: what is wrong in words, never a Python exception's text."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from command_line import run

from datagen.corpus_files.index import index_path, read_index
from datagen.corpus_files.manifest import manifest_path
from datagen.corpus_files.shard import LABEL_COLUMNS, sidecar_path
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus

PYTHON = re.compile(r"Error|Traceback|\(\)|object|None|NoneType|\['")
MANIFESTS = {
    "": "not JSON from line 1, column 1 on",
    "{\n": "not JSON from line 2, column 1 on",
    "hello": "not JSON from line 1, column 1 on",
    "[]": "its entries are not those of this version of the format",
    "{}": 'it lacks "name"',
    '{"name": "a", "identity": {}}': "its entries are not those of this version of the format",
    "null": "its entries are not those of this version of the format",
    "\x00\xff": "no text",
}


def told_by(command: str, folder: Path) -> str:
    done = run(command, folder)
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert not PYTHON.search(done.stderr), done.stderr
    return done.stderr


@pytest.mark.parametrize("text", MANIFESTS)
def test_a_manifest_that_is_none_is_told_in_words(text: str, tmp_path: Path) -> None:
    manifest_path(tmp_path).write_bytes(text.encode("latin-1"))
    for command in ("info", "check", "report"):
        message = told_by(command, tmp_path)
        assert f"{manifest_path(tmp_path)}: not a manifest of a corpus: {MANIFESTS[text]}" in message


@pytest.mark.parametrize("key", ["recipe", "shards", "asked", "refused", "bytes", "format"])
def test_a_manifest_that_lacks_a_key_or_holds_nonsense_says_so(key: str, copy: Path) -> None:
    content = json.loads(manifest_path(copy).read_text())
    for strange in ("x", [7], None):
        manifest_path(copy).write_text(json.dumps(content | {key: strange}))
        assert "its entries are not those of this version of the format" in told_by("info", copy)
    del content[key]
    manifest_path(copy).write_text(json.dumps(content))
    assert f'it lacks "{key}"' in told_by("info", copy)


@pytest.mark.parametrize(
    ("key", "strange"),
    [
        ("bytes", float("inf")),
        ("recipe_records", float("inf")),
        ("asked", [[0, float("inf")]]),
        ("name", 1),
        ("identity", {"recipe_hash": 1, "model_hash": "", "format_hash": "", "program_hash": ""}),
        ("made_with", {"numpy": 2}),
        ("seconds", "long"),
        ("origin", "invented"),
    ],
)
def test_numbers_and_texts_of_a_manifest_are_such(key: str, strange: object, copy: Path) -> None:
    content = json.loads(manifest_path(copy).read_text())
    manifest_path(copy).write_text(json.dumps(content | {key: strange}))
    for command in ("info", "check", "report"):
        assert f"{manifest_path(copy)}: not a manifest of a corpus" in told_by(command, copy)


def test_a_recipe_has_a_seed(copy: Path) -> None:
    content = json.loads(manifest_path(copy).read_text())
    del content["recipe"]["seed"]
    manifest_path(copy).write_text(json.dumps(content))
    for command in ("info", "check", "size"):
        assert f'{manifest_path(copy)}: not a manifest of a corpus: it lacks "seed"' in told_by(command, copy)


def test_a_manifest_of_recordings_has_their_spec(copy: Path) -> None:
    content = json.loads(manifest_path(copy).read_text())
    manifest_path(copy).write_text(json.dumps(content | {"origin": "imported"}))
    for command in ("info", "check", "report"):
        assert f'{manifest_path(copy)}: not a manifest of a corpus: it lacks "spec"' in told_by(command, copy)


def test_a_folder_in_the_place_of_the_manifest_cannot_be_read(copy: Path) -> None:
    manifest_path(copy).unlink()
    manifest_path(copy).mkdir()
    told = f"{manifest_path(copy)}: not a manifest of a corpus: cannot be read (Is a directory)\n"
    assert told_by("check", copy).endswith(told)  # which writing it anew would not mend


def test_a_manifest_nested_without_end_is_told(copy: Path) -> None:
    manifest_path(copy).write_text("[" * 100_000)
    assert "it is nested too deeply" in told_by("check", copy)


@pytest.mark.parametrize(
    "change",
    [
        {"shard": float("inf")},
        {"shard": 1e308},
        {"records": [[]]},
        {"bytes": True},
        {"seconds": -1.0},
        {"sha256": None},
        {"labels": {}},
        {"labels": {"record": [0]}},
        {"labels": {column: [] for column in LABEL_COLUMNS}},
    ],
)
def test_a_sidecar_that_is_none_is_damage(change: dict[str, object], copy: Path) -> None:
    path = sidecar_path(copy, 0)
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    assert "shards/shard_000000.json" in check_corpus(copy).damaged


INDICES = {
    "an empty file": (lambda text: "", f'it lacks the column "record" and {len(LABEL_COLUMNS) + 1} more;'),
    "no table": (lambda text: "hello\nworld\n", f'it lacks the column "record" and {len(LABEL_COLUMNS) + 1} more;'),
    "a lost column": (lambda text: text.replace("bridged", "bridge", 1), 'it lacks the column "bridged";'),
    "a short row": (lambda text: text + "1,2\n", "index.csv, line 16: not the index of a corpus: 2 cells, but"),
    "a word for a number": (lambda text: text.replace("420.0", "fast", 1), 'speed_rpm = "fast" is not a number'),
    "a word for a truth": (
        lambda text: text.replace("False", "no", 1),
        'bridged = "no" is not a truth value, True or False',
    ),
    "a word for a count": (
        lambda text: text.replace("\n4,", "\nfour,", 1),
        'line 6: not the index of a corpus: record = "four" is not a whole number',
    ),
    "a record twice": (
        lambda text: text + text.splitlines()[1] + "\n",
        "line 16: not the index of a corpus: record = 0 occurs twice",
    ),
    "a shard elsewhere": (
        lambda text: text.replace("shards/shard_000000.nc", "../x.nc"),
        "shard = ../x.nc is not a place",
    ),
    "a place before the first": (lambda text: text.replace(".nc,0", ".nc,-1", 1), "position = -1 is not a place"),
    "no place": (lambda text: text.replace(".nc,0", ".nc,NaN", 1), "position = nan is not a place"),
    "no record": (lambda text: text.replace("\n4,", "\nNaN,", 1), "line 6: not the index of a corpus: record = nan is"),
    "an infinite number": (lambda text: text.replace("420.0", "inf", 1), 'speed_rpm = "inf" is not a number'),
    "no rate": (
        lambda text: text.replace(",32768.0,", ",0.0,", 1),
        "line 2: not the index of a corpus: rate_hz = 0.0 is",
    ),
    "no length": (lambda text: text.replace(",0.04998", ",-0.04998", 1), "duration_s = -0.04998"),
    "another word": (lambda text: text.replace(",healthy,", ",well,", 1), "condition = well is none of its values"),
    "bytes": (lambda text: text.replace("gearbox", "\xff", 1), "not a table of text"),
}


@pytest.mark.parametrize("case", INDICES)
def test_an_index_that_is_none_is_told_in_words_with_what_to_do(case: str, copy: Path) -> None:
    change, expected = INDICES[case]
    text = index_path(copy).read_text()
    assert change(text) != text
    index_path(copy).write_bytes(change(text).encode("latin-1"))
    message = told_by("info", copy)
    assert expected in message
    assert "delete it and generate again into the same folder" in message
    with pytest.raises(BadInput):
        read_index(copy)


def test_a_place_beyond_its_shard_is_told_of_the_index_and_not_of_the_shard(copy: Path, tmp_path: Path) -> None:
    text = index_path(copy).read_text()
    index_path(copy).write_text(text.replace(".nc,1", ".nc,99", 1))
    done = run("preview", copy, "--record", "1", "--out", tmp_path / "a.png")
    assert done.exit_code == 2
    assert "index.csv places a record beyond the end of this shard" in done.stderr


@pytest.mark.parametrize("span", [(0, 10**15), (0, 15), (-1, 3), (5, 3)])
def test_records_asked_for_beyond_the_recipe_are_no_manifest(span: tuple[int, int], copy: Path) -> None:
    content = json.loads(manifest_path(copy).read_text())
    manifest_path(copy).write_text(json.dumps(content | {"asked": [[0, 14], span]}))
    assert "its entries are not those of this version of the format" in told_by("check", copy)


@pytest.mark.parametrize("command", ["info", "report", "size"])
def test_what_is_no_corpus_is_told_apart(command: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "folder").mkdir()
    assert "no such folder" in told_by(command, tmp_path / "nowhere")
    if command != "report":  # whose own folder would lie in it, which is said first
        assert "this is not a folder" in told_by(command, tmp_path / "file")
    assert "so it is not a corpus, or its making was interrupted" in told_by(command, tmp_path / "folder")


def test_what_is_neither_a_corpus_nor_a_recipe_is_told_apart(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "folder").mkdir()
    assert "no such file or folder, and no dataset of that name" in told_by("check", tmp_path / "nowhere")
    assert "name: this setting is missing" in told_by("check", tmp_path / "file")
    assert "so it is not a corpus, or its making was interrupted" in told_by("check", tmp_path / "folder")


def test_a_preview_of_neither_corpus_nor_recipe_says_so(tmp_path: Path) -> None:
    done = run("preview", tmp_path, "--out", tmp_path / "a.png")
    assert done.exit_code == 2
    assert "neither a corpus (manifest.json) nor a recipe (recipe.toml) is in this folder" in done.stderr


def test_a_record_that_is_not_there_is_told_with_those_that_are(tiny_corpus: Path, tmp_path: Path) -> None:
    command = ["preview", str(tiny_corpus), "--record", "99", "--out", str(tmp_path / "a.png")]
    assert "record = 99: not in this corpus; allowed: 0 to 13" in run(*command).stderr
