"""A manifest that was lost or damaged is written anew by the next run, from what lies beside the shards alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from command_line import run

from datagen.corpus_files.manifest import manifest_path, read_manifest
from datagen.corpus_files.shard import shard_path, sidecar_path
from datagen.errors import BadInput
from datagen.inspection.check import check_corpus
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine

ALONE = Engine(workers=1)


def cut_short(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:300])


def empty(path: Path) -> None:
    path.write_bytes(b"")


DAMAGES: dict[str, Callable[[Path], None]] = {"is lost": Path.unlink, "cut short": cut_short, "empty": empty}


@pytest.mark.parametrize("damage", DAMAGES)
def test_the_next_run_writes_it_as_it_was_and_makes_nothing_again(
    damage: str, copy: Path, tiny_recipe: Path, expected: dict[int, str], contents: Callable[[Path], dict[int, str]]
) -> None:
    before = json.loads(manifest_path(copy).read_text())
    times = {path: path.stat().st_mtime_ns for path in (copy / "shards").iterdir()}
    DAMAGES[damage](manifest_path(copy))
    code, out, message = run("generate", tiny_recipe, "--out", copy, "--workers", 1)
    assert code == 0
    assert "(0 new, " in out
    state = "is lost" if damage == "is lost" else "cannot be read"
    assert f"manifest.json {state}; it is written anew from 9 finished shards" in message
    assert json.loads(manifest_path(copy).read_text()) == before
    assert {path: path.stat().st_mtime_ns for path in (copy / "shards").iterdir()} == times
    assert check_corpus(copy, remake=0).sound
    assert contents(copy) == expected


def test_it_lists_as_asked_for_what_is_finished_and_what_this_run_asks_for(tiny: Recipe, tmp_path: Path) -> None:
    generate(tiny, tmp_path, records=[0, 1, 9, 12], engine=ALONE)
    shard = next(entry for entry in read_manifest(tmp_path).shards if entry.first == 12)
    for path in (tmp_path / shard.file, (tmp_path / shard.file).with_suffix(".json"), manifest_path(tmp_path)):
        path.unlink()
    generate(tiny, tmp_path, records=[4], engine=ALONE)
    assert read_manifest(tmp_path).asked == ((0, 2), (4, 5), (9, 10))
    assert check_corpus(tmp_path, remake=0).sound


@pytest.mark.usefixtures("record_3_fails")
def test_it_lists_as_asked_for_what_could_not_be_made(tiny: Recipe, tmp_path: Path) -> None:
    generate(tiny, tmp_path, records=[2, 3], engine=ALONE)
    manifest_path(tmp_path).unlink()
    generate(tiny, tmp_path, records=[0], engine=ALONE)
    found = read_manifest(tmp_path)
    assert found.asked == ((0, 1), (2, 4))
    assert [failure.record for failure in found.failed] == [3]


@pytest.mark.parametrize("damage", DAMAGES)
def test_another_recipe_is_refused_and_everything_left_as_it_is(damage: str, copy: Path, tiny_recipe: Path) -> None:
    other = tiny_recipe.with_name("other.toml")
    other.write_text(tiny_recipe.read_text().replace("seed = 7", "seed = 8"))
    DAMAGES[damage](manifest_path(copy))
    before = {path: path.read_bytes() for path in copy.rglob("*") if path.is_file()}
    with pytest.raises(BadInput, match="begun with another recipe or another version of this one; a"):
        generate(load_recipe(other), copy, engine=ALONE)
    assert {path: path.read_bytes() for path in copy.rglob("*") if path.is_file()} == before


def test_shards_of_two_versions_are_refused(tiny: Recipe, copy: Path) -> None:
    manifest_path(copy).unlink()
    sidecar = json.loads(sidecar_path(copy, 3).read_text())
    sidecar["identity"]["model_hash"] = "0" * 16
    sidecar_path(copy, 3).write_text(json.dumps(sidecar))
    with pytest.raises(BadInput, match="another version of the physics"):
        generate(tiny, copy, engine=ALONE)


def test_a_shard_that_is_cut_short_as_well_is_made_again(
    tiny: Recipe, copy: Path, expected: dict[int, str], contents: Callable[[Path], dict[int, str]]
) -> None:
    manifest_path(copy).unlink()
    cut_short(shard_path(copy, 2))
    assert generate(tiny, copy, engine=ALONE).new == 2
    assert contents(copy) == expected


def test_a_damaged_manifest_without_a_finished_shard_is_refused(tiny: Recipe, tmp_path: Path) -> None:
    manifest_path(tmp_path).write_text("{")
    with pytest.raises(BadInput, match=r"not a manifest of a corpus: not JSON from line 1, column 2 on$"):
        generate(tiny, tmp_path, engine=ALONE)
    assert manifest_path(tmp_path).read_text() == "{"


def test_a_manifest_that_cannot_be_opened_is_refused(tiny: Recipe, copy: Path) -> None:
    manifest_path(copy).unlink()
    manifest_path(copy).mkdir()
    with pytest.raises(BadInput, match="cannot be read"):
        generate(tiny, copy, engine=ALONE)
    assert manifest_path(copy).is_dir()


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("command", ["check", "info", "report", "preview"])
def test_commands_that_read_a_corpus_say_how_it_is_written_anew(damage: str, command: str, copy: Path) -> None:
    DAMAGES[damage](manifest_path(copy))
    more = ("--out", copy.with_name("out.png")) if command == "preview" else ()
    code, _, message = run(command, copy, *more)
    assert code == 2
    assert message.count("\n") == 1
    assert (
        f"`spallgen generate` with its recipe and --out {copy}, by the version that made it, writes it anew" in message
    )


def test_a_lost_index_is_told_likewise_and_written_anew(tiny: Recipe, copy: Path) -> None:
    before = (copy / "index.csv").read_text()
    (copy / "index.csv").unlink()
    assert (
        "the index.csv of this corpus is lost, or its run was killed or is not done yet; "
        f"`spallgen generate` with its recipe and --out {copy}" in run("info", copy)[2]
    )
    generate(tiny, copy, engine=ALONE)
    assert (copy / "index.csv").read_text() == before


def test_a_folder_in_the_place_of_the_index_is_told_by_its_name(copy: Path, tiny_recipe: Path) -> None:
    (copy / "index.csv").unlink()
    (copy / "index.csv").mkdir()
    code, _, message = run("generate", tiny_recipe, "--out", copy, "--workers", 1)
    assert code == 2
    assert message.endswith(f"error: {copy / 'index.csv'}: Is a directory\n")
