from __future__ import annotations

import csv
import errno
import itertools
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import joblib
import numba
import pytest
import xarray

import datagen.corpus_files.index
import datagen.corpus_files.manifest
import datagen.corpus_files.shard
import datagen.runs.run
import datagen.runs.task
from datagen.commands.progress_display import Lines
from datagen.corpus_files.index import index_path, read_index
from datagen.corpus_files.manifest import read_manifest
from datagen.corpus_files.shard import finished_shards, shard_path, sidecar_path
from datagen.errors import BadInput
from datagen.files.atomic import write_atomically
from datagen.progress import Listener
from datagen.recipes.recipe import Recipe
from datagen.runs.generate import generate
from datagen.runs.plan import plan_shards
from datagen.runs.task import ShardRow, load_kernels, make_shard
from datagen.runs.workers import Engine, engaged

ALONE = Engine(workers=1)
Contents = Callable[[Path], dict[int, str]]


def test_a_corpus_holds_every_record_once_with_manifest_and_index(tiny_corpus: Path, tiny: Recipe) -> None:
    manifest = read_manifest(tiny_corpus)
    assert manifest.records == manifest.asked_records == tiny.count == 14
    assert list(read_index(tiny_corpus)["record"]) == list(range(14))
    assert sorted(record for sidecar in finished_shards(tiny_corpus) for record in sidecar.records) == list(range(14))
    assert not (tiny_corpus / "failed.jsonl").exists()


def test_a_shard_alone_says_under_which_terms_it_is_and_how_to_cite_it(tiny: Recipe, tmp_path: Path) -> None:
    stated = tiny.model_copy(update={"licence": "CC BY 4.0", "citation": "A. Nybody, 2020"})
    for recipe, name in ((tiny, "silent"), (stated, "stated")):
        generate(recipe, tmp_path / name, limit=1, engine=ALONE)
    with xarray.open_dataset(shard_path(tmp_path / "silent", 0)) as shard:
        assert "license" not in shard.attrs
        model = shard.attrs["references"]
    with xarray.open_dataset(shard_path(tmp_path / "stated", 0)) as shard:
        assert (shard.attrs["license"], shard.attrs["references"]) == ("CC BY 4.0", f"{model}; A. Nybody, 2020")


@pytest.mark.slow
def test_two_workers_give_the_arrays_that_one_gives(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, contents: Contents
) -> None:
    assert generate(tiny, tmp_path / "two", engine=Engine(workers=2)).complete
    assert contents(tmp_path / "two") == expected


@pytest.mark.slow
def test_the_dask_backend_gives_the_arrays_that_one_worker_gives(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, contents: Contents
) -> None:
    assert generate(tiny, tmp_path / "dask", engine=Engine(workers=2, backend="dask")).complete
    assert contents(tmp_path / "dask") == expected


def test_whoever_makes_records_keeps_freed_memory(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[bool] = []
    monkeypatch.setattr("datagen.runs.task.keep_freed_memory", lambda: asked.append(True))
    assert generate(tiny, tmp_path / "one", limit=1, engine=ALONE).made == 1
    assert asked


def test_a_backend_set_by_the_caller_is_used(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, contents: Contents
) -> None:
    threads: set[str] = set()

    def noted(*arguments: Any) -> ShardRow:
        threads.add(threading.current_thread().name)
        return make_shard(*arguments)

    monkeypatch.setattr(datagen.runs.run, "make_shard", noted)
    with joblib.parallel_config(backend="threading", n_jobs=2):
        assert generate(tiny, tmp_path / "threads").complete
    assert contents(tmp_path / "threads") == expected
    assert threads
    assert threading.main_thread().name not in threads


def test_a_smaller_limit_later_keeps_the_records_that_were_asked_for_before(tiny: Recipe, tmp_path: Path) -> None:
    last = plan_shards(tiny, tiny.count)[0].records[-1]  # goes into one shard with record 0
    generate(tiny, tmp_path / "some", records=(last,), engine=ALONE)
    run = generate(tiny, tmp_path / "some", limit=1, engine=ALONE)
    assert (run.asked, run.made, run.new) == (1, 1, 1)
    assert sorted(read_index(tmp_path / "some")["record"]) == [0, last]


def test_a_limit_makes_the_first_records_and_a_later_run_completes_the_rest(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, contents: Contents
) -> None:
    run = generate(tiny, tmp_path / "some", limit=5, engine=ALONE)
    assert (run.asked, run.made, run.new) == (5, 5, 5)
    assert list(read_index(tmp_path / "some")["record"]) == list(range(5))
    run = generate(tiny, tmp_path / "some", engine=ALONE)
    assert (run.asked, run.made, run.new) == (14, 14, 9)
    assert contents(tmp_path / "some") == expected


def test_listed_records_are_made_alone_and_equal_those_of_the_whole_corpus(
    tiny: Recipe, tiny_corpus: Path, tmp_path: Path
) -> None:
    from datagen.corpus import Corpus

    run = generate(tiny, tmp_path / "some", records=[9, 3], engine=ALONE)
    assert (run.asked, run.made) == (2, 2)
    some, whole = Corpus(tmp_path / "some"), Corpus(tiny_corpus)
    assert list(some.labels["record"]) == [3, 9]
    for record in (3, 9):
        assert some.dataset(record).identical(whole.dataset(record))


def test_records_asked_for_later_are_added_to_those_there(tiny: Recipe, tmp_path: Path) -> None:
    generate(tiny, tmp_path / "some", records=[9], engine=ALONE)
    run = generate(tiny, tmp_path / "some", limit=2, engine=ALONE)
    assert (run.asked, run.made, run.new) == (2, 2, 2)
    assert list(read_index(tmp_path / "some")["record"]) == [0, 1, 9]
    assert read_manifest(tmp_path / "some").asked == ((0, 2), (9, 10))


def test_a_record_of_a_shard_stays_when_another_of_the_same_shard_is_added(tiny: Recipe, tmp_path: Path) -> None:
    first, second = next(shard.records for shard in plan_shards(tiny, 14) if len(shard.records) == 2)
    generate(tiny, tmp_path / "some", records=[first], engine=ALONE)
    generate(tiny, tmp_path / "some", records=[second], engine=ALONE)
    assert [sidecar.records for sidecar in finished_shards(tmp_path / "some")] == [(first, second)]
    assert list(read_index(tmp_path / "some")["record"]) == [first, second]


def test_records_of_a_shard_stay_where_a_run_was_killed_between_its_file_and_its_sidecar(
    tiny: Recipe, tmp_path: Path
) -> None:
    first, second = next(shard.records for shard in plan_shards(tiny, 14) if len(shard.records) == 2)
    generate(tiny, tmp_path / "some", records=[first], engine=ALONE)
    (file,) = (tmp_path / "some").glob("shards/*.nc")
    file.write_bytes(file.read_bytes() + b"of another file")
    generate(tiny, tmp_path / "some", records=[second], engine=ALONE)
    assert list(read_index(tmp_path / "some")["record"]) == [first, second]


def test_records_picked_out_of_shards_that_interleave_are_listed_in_their_order(tiny: Recipe, tmp_path: Path) -> None:
    recipe = Recipe.model_validate(tiny.model_dump(mode="json") | {"order": "interleaved"})
    shards = [shard.records for shard in plan_shards(recipe, 14)]
    # The second is read before the third is seen, which is the first of all: the order of the shards will not do.
    picked = next(
        (one[-1], two[-1], three[0])
        for one, two, three in itertools.combinations(shards, 3)
        if three[0] < one[-1] < two[-1]
    )
    generate(recipe, tmp_path / "some", records=picked, engine=ALONE)
    with index_path(tmp_path / "some").open(newline="") as file:
        assert [int(row["record"]) for row in csv.DictReader(file)] == sorted(picked)


def test_a_finished_corpus_is_left_alone(tiny: Recipe, copy: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in (copy / "shards").iterdir()}
    assert generate(tiny, copy, engine=ALONE).new == 0
    assert {path: path.stat().st_mtime_ns for path in (copy / "shards").iterdir()} == before


@pytest.mark.parametrize("damage", ["cut file", "no file", "no sidecar", "cut sidecar"])
def test_a_damaged_shard_is_made_again(
    tiny: Recipe, expected: dict[int, str], copy: Path, damage: str, contents: Contents
) -> None:
    victim = sidecar_path(copy, 1) if "sidecar" in damage else shard_path(copy, 1)
    content = victim.read_bytes()
    victim.unlink()
    if damage.startswith("cut"):
        victim.write_bytes(content[: len(content) // 2])
    run = generate(tiny, copy, engine=ALONE)
    assert (run.made, run.new) == (14, 2)
    assert contents(copy) == expected


def test_a_shard_that_another_version_made_is_made_again(tiny: Recipe, copy: Path) -> None:
    before = sidecar_path(copy, 1).read_text()
    other = json.loads(before)
    other["identity"]["model_hash"] = "0" * 16
    sidecar_path(copy, 1).write_text(json.dumps(other))
    run = generate(tiny, copy, engine=ALONE)
    assert (run.made, run.new) == (14, 2)
    assert json.loads(sidecar_path(copy, 1).read_text())["identity"] == json.loads(before)["identity"]


def test_leftovers_of_killed_writers_are_swept(tiny: Recipe, copy: Path) -> None:
    leftover = copy / "shards" / ".shard_000000.nc.elsewhere.1.part"
    leftover.write_bytes(b"half")
    generate(tiny, copy, engine=ALONE)
    assert not leftover.exists()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"seed": 8}, r"another recipe or another version of this one \(then seed = 7\); a corpus never mixes them"),
        ({"title": "Another title"}, r"another recipe or another version of this one \(then title = .*\);"),
    ],
)
def test_a_corpus_of_another_recipe_is_refused_and_left_alone(
    tiny: Recipe, copy: Path, change: dict[str, Any], sentence: str
) -> None:
    before = (copy / "manifest.json").read_bytes()
    with pytest.raises(BadInput, match=sentence):
        generate(Recipe.model_validate(tiny.model_dump(mode="json") | change), copy, engine=ALONE)
    assert (copy / "manifest.json").read_bytes() == before


def test_the_refusal_says_what_the_folder_holds(tiny: Recipe, copy: Path) -> None:
    with pytest.raises(BadInput, match="the corpus tiny in this folder was begun"):
        generate(Recipe.model_validate(tiny.model_dump(mode="json") | {"name": "other"}), copy, engine=ALONE)
    content = json.loads((copy / "manifest.json").read_text())
    (copy / "manifest.json").write_text(json.dumps(content | {"origin": "imported", "recipe": {"spec": {}}}))
    with pytest.raises(BadInput, match="this folder holds imported recordings"):
        generate(tiny, copy, engine=ALONE)


def test_the_folder_may_be_a_text(tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    assert generate(tiny, "~/out", limit=1, engine=ALONE).made == 1
    assert (tmp_path / "out" / "manifest.json").is_file()


def test_a_corpus_that_another_run_began_meanwhile_is_refused_and_left_alone(
    tiny: Recipe, tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"

    def slowly(*arguments: Any) -> Any:
        shutil.copytree(tiny_corpus, out)
        return plan_shards(*arguments)

    monkeypatch.setattr("datagen.runs.generate.plan_shards", slowly)
    with pytest.raises(BadInput, match="another recipe or another version of this one"):
        generate(Recipe.model_validate(tiny.model_dump(mode="json") | {"seed": 8}), out, engine=ALONE)
    assert {path.name: path.read_bytes() for path in (out / "shards").iterdir()} == {
        path.name: path.read_bytes() for path in (tiny_corpus / "shards").iterdir()
    }
    assert (out / "manifest.json").read_bytes() == (tiny_corpus / "manifest.json").read_bytes()


def test_what_another_run_has_made_meanwhile_stays(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = next(shard.records for shard in plan_shards(tiny, 14) if len(shard.records) == 2)
    other, out = tmp_path / "other", tmp_path / "out"
    generate(tiny, other, records=[second], engine=ALONE)

    def slowly(*arguments: Any) -> Any:
        if not out.exists():
            shutil.copytree(other, out)
        return plan_shards(*arguments)

    monkeypatch.setattr("datagen.runs.generate.plan_shards", slowly)
    generate(tiny, out, records=[first], engine=ALONE)  # of which nothing is planned beyond this one at first
    assert list(read_index(out)["record"]) == [first, second]


@pytest.mark.parametrize(
    ("name", "thing"),
    [("model_hash", "the physics"), ("program_hash", "the program"), ("format_hash", "the file format")],
)
def test_a_corpus_of_another_version_is_refused(tiny: Recipe, copy: Path, name: str, thing: str) -> None:
    content = json.loads((copy / "manifest.json").read_text())
    content["identity"][name] = "0" * 16
    (copy / "manifest.json").write_text(json.dumps(content))
    with pytest.raises(BadInput, match=f"begun with another version of {thing}"):
        generate(tiny, copy, engine=ALONE)


def test_a_folder_with_other_things_is_refused(tiny: Recipe, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("x")
    with pytest.raises(BadInput, match=r"other things \(thesis.tex\)"):
        generate(tiny, tmp_path, engine=ALONE)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_what_no_writer_of_shards_left_is_other_things(tiny: Recipe, tmp_path: Path) -> None:
    (tmp_path / "thesis.part").write_text("x")
    (tmp_path / ".corpus.host.1.part").mkdir()  # of an import that was killed
    with pytest.raises(BadInput, match=r"other things \(\.corpus\.host\.1\.part, thesis\.part\)"):
        generate(tiny, tmp_path, engine=ALONE)
    assert sorted(path.name for path in tmp_path.iterdir()) == [".corpus.host.1.part", "thesis.part"]


def test_a_corpus_goes_on_beside_what_an_import_left(tiny: Recipe, copy: Path) -> None:
    (copy / ".corpus.host.1.part").mkdir()
    assert generate(tiny, copy, engine=ALONE).complete
    assert (copy / ".corpus.host.1.part").is_dir()


def test_a_file_in_the_place_of_the_folder_is_refused(tiny: Recipe, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("x")
    with pytest.raises(BadInput, match="in the way"):
        generate(tiny, tmp_path / "out", engine=ALONE)


@pytest.mark.parametrize(
    ("request_", "sentence"),
    [
        ({"limit": 0}, "--limit = 0; allowed: 1 or more"),
        ({"limit": -3}, "--limit = -3; allowed: 1 or more"),
        ({"records": [14]}, "--records = 14; allowed: 0 to 13"),
        ({"records": [-1]}, "--records = -1; allowed: 0 to 13"),
        ({"records": [1], "limit": 2}, "give only one of them"),
    ],
)
def test_impossible_requests_are_refused_and_nothing_is_written(
    tiny: Recipe, tmp_path: Path, request_: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(BadInput, match=sentence):
        generate(tiny, tmp_path / "out", engine=ALONE, **request_)
    assert not (tmp_path / "out").exists()


def test_a_full_disk_stops_the_run_names_what_is_missing_and_keeps_what_is_finished(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, contents: Contents
) -> None:
    def filling(path: Path, data: bytes | memoryview) -> None:
        if path.suffix == ".nc" and path >= shard_path(tmp_path / "out", 3):
            raise OSError(errno.ENOSPC, "no space left on device")
        write_atomically(path, data)

    monkeypatch.setattr(datagen.corpus_files.shard, "write_atomically", filling)
    run = generate(tiny, tmp_path / "out", engine=ALONE)
    assert not run.complete
    assert run.problem.startswith(f"the disk is full: {14 - run.made} records have not been made")
    assert list(read_index(tmp_path / "out")["record"]) == sorted(
        record for sidecar in finished_shards(tmp_path / "out") for record in sidecar.records
    )
    assert 0 < run.made < 14
    monkeypatch.undo()
    assert generate(tiny, tmp_path / "out", engine=ALONE).complete
    assert contents(tmp_path / "out") == expected


@pytest.mark.parametrize(
    ("number", "message"),
    [
        (
            errno.EFBIG,
            "files may not be as large as a shard here (ulimit -f): 14 records have not been made",
        ),
        (errno.EDQUOT, "the quota of this disk is used up: 14 records have not been made, and about"),
    ],
)
def test_a_limit_of_files_or_a_quota_is_not_called_a_full_disk(
    number: int, message: str, tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def limited(path: Path, data: bytes | memoryview) -> None:
        raise OSError(number, "limited")

    monkeypatch.setattr(datagen.corpus_files.shard, "write_atomically", limited)
    run = generate(tiny, tmp_path / "out", engine=ALONE)
    assert run.problem.startswith(message)
    assert " 0.0 MB" not in run.problem


def test_a_run_has_no_more_workers_than_shards_to_make(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engines: list[Engine] = []

    def noted(engine: Engine) -> AbstractContextManager[None]:
        engines.append(engine)
        return engaged(replace(engine, workers=1))

    monkeypatch.setattr("datagen.runs.generate.engaged", noted)
    generate(tiny, tmp_path / "one", limit=1, engine=Engine(workers=1000))
    generate(tiny, tmp_path / "three", limit=3, engine=Engine(workers=1000))
    assert [engine.workers for engine in engines] == [1, 2]  # three records in shards of two


def test_a_disk_without_room_for_a_manifest_is_told_without_a_traceback(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, data: bytes | memoryview = b"") -> None:
        raise OSError(errno.ENOSPC, "no space left on device")

    for module in (datagen.corpus_files.shard, datagen.corpus_files.manifest):
        monkeypatch.setattr(module, "write_atomically", full)
    monkeypatch.setattr(datagen.corpus_files.index, "opened_atomically", full)
    run = generate(tiny, tmp_path / "out", engine=ALONE)
    assert (run.made, run.asked) == (0, 14)
    assert "the disk is full" in run.problem


def test_a_full_disk_does_not_tell_of_missing_records_where_all_are_made(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    generate(tiny, tmp_path / "out", engine=ALONE)

    def full(path: Path, data: bytes | memoryview = b"") -> None:
        raise OSError(errno.ENOSPC, "no space left on device")

    monkeypatch.setattr(datagen.corpus_files.manifest, "write_atomically", full)
    run = generate(tiny, tmp_path / "out", limit=10, engine=ALONE)
    assert (run.made, run.asked) == (10, 10)
    assert run.problem == "the disk is full: no room for the index; the same command continues from there"


@pytest.mark.usefixtures("record_3_fails")
def test_a_record_that_cannot_be_simulated_is_named_and_the_others_are_made(tiny: Recipe, tmp_path: Path) -> None:
    for _ in range(2):  # the second run has nothing to do and says the same
        run = generate(tiny, tmp_path / "out", engine=ALONE)
        assert (run.asked, run.made) == (14, 13)
        assert [failure.record for failure in run.failed] == [3]
        assert "stopped being finite" in run.failed[0].reason
    rows = [json.loads(line) for line in (tmp_path / "out" / "failed.jsonl").read_text().splitlines()]
    assert [row["record"] for row in rows] == [3]


def test_an_unforeseen_error_costs_its_shard_only_and_is_tried_again(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, contents: Contents
) -> None:
    import datagen.runs.task
    from datagen.records.record import make_record

    def failing(scenario: Any, stored: tuple[str, ...]) -> Any:
        if scenario.record == 3:
            raise ZeroDivisionError("by chance")
        return make_record(scenario, stored)

    monkeypatch.setattr(datagen.runs.task, "make_record", failing)
    run = generate(tiny, tmp_path / "out", engine=ALONE)
    lost = [failure.record for failure in run.failed]
    assert 3 in lost
    assert len(lost) == 14 - run.made <= 2
    assert "ZeroDivisionError: by chance" in run.failed[0].reason
    monkeypatch.undo()
    assert generate(tiny, tmp_path / "out", engine=ALONE).failed == ()
    assert contents(tmp_path / "out") == expected
    assert not (tmp_path / "out" / "failed.jsonl").exists()


def test_a_run_stops_in_one_sentence_where_there_is_no_room_for_temporary_files(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tries: list[int] = []
    make_record = datagen.runs.task.make_record
    monkeypatch.setattr(datagen.runs.task, "make_record", lambda *given: tries.append(1) or make_record(*given))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "none"))
    run = generate(tiny, tmp_path / "out", engine=ALONE)
    assert (run.made, run.failed, run.complete) == (0, (), False)
    assert run.problem.startswith("TMPDIR: a file cannot be laid out in this folder of temporary files")
    assert run.problem.endswith(
        "; 14 records have not been made; finished shards are kept; the same command continues from there"
    )
    assert "; 1 record has not been made; " in generate(tiny, tmp_path / "one", limit=1, engine=ALONE).problem
    # The shard that met it is the only one whose records were made in vain.
    assert len(tries) <= 1 + max(len(shard.records) for shard in plan_shards(tiny, 14))
    monkeypatch.undo()
    assert generate(tiny, tmp_path / "out", engine=ALONE).complete


def test_records_of_an_earlier_file_are_not_called_lost_when_making_the_shard_again_goes_wrong(
    tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = next(shard.records for shard in plan_shards(tiny, 14) if len(shard.records) == 2)
    generate(tiny, tmp_path / "out", records=[first], engine=ALONE)

    def failing(*_: Any) -> Any:
        raise ZeroDivisionError("by chance")

    monkeypatch.setattr("datagen.runs.task.make_record", failing)
    run = generate(tiny, tmp_path / "out", records=[first, second], engine=ALONE)
    assert [failure.record for failure in run.failed] == [second]
    assert (run.asked, run.made) == (2, 1)


def test_a_shard_that_kills_its_worker_every_time_is_given_up_and_the_others_are_made(
    tiny: Recipe, expected: dict[int, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, contents: Contents
) -> None:
    def deadly(*arguments: Any) -> ShardRow:
        if arguments[2].number == 2:
            os.kill(os.getpid(), signal.SIGKILL)
        return make_shard(*arguments)

    monkeypatch.setattr(datagen.runs.run, "make_shard", deadly)
    run = generate(tiny, tmp_path / "out", engine=Engine(workers=2))
    assert not run.complete
    assert contents(tmp_path / "out") == {shard: content for shard, content in expected.items() if shard != 2}
    assert "its worker was lost every time" in run.failed[0].reason
    assert (tmp_path / "out" / "failed.jsonl").exists()


def test_progress_lines_tell_rate_and_remaining_time(capsys: pytest.CaptureFixture[str]) -> None:
    lines = Lines(clock=iter([0.0, 4.0, 5.0, 10.0]).__next__)
    for done in (0, 2, 3, 12):
        lines.advance(done, 12)
    assert capsys.readouterr().err.splitlines() == [
        "0 of 12 records",
        "2 of 12 records, 0.50 records/s, 20 s left",
        "12 of 12 records, 1.20 records/s, 0 s left",
    ]


@pytest.mark.parametrize("warm", [True, False])
def test_kernels_are_there_before_anything_is_drawn_and_where_they_have_to_be_compiled_the_run_says_so(
    warm: bool, tiny: Recipe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    steps: list[str] = []

    def tasks(*_: object) -> Iterator[ShardRow]:
        steps.append("tasks")
        yield from ()

    load_kernels.cache_clear()
    monkeypatch.setattr("physics.warming.is_warm", lambda: warm)
    monkeypatch.setattr("physics.warming.warm_up", lambda: steps.append("kernels"))
    monkeypatch.setattr("datagen.runs.generate.require_possible_rates", lambda *_: steps.append("draws"))
    monkeypatch.setattr("datagen.runs.run.run_tasks", tasks)
    generate(tiny, tmp_path / "out", limit=1, engine=Engine(workers=2), listener=Listener(say=said.append))
    assert any("compiling the physics" in sentence for sentence in said) is not warm
    assert steps == ["kernels", "draws", "tasks"]


@pytest.mark.slow
def test_a_cache_that_a_crash_cut_short_is_made_again_by_the_next_run(tmp_path: Path) -> None:
    from physics.warming import warm_up

    warm_up()
    folder = Path(numba.config.CACHE_DIR)
    shutil.copytree(folder, tmp_path / "spallgen" / folder.name)
    for file in tmp_path.rglob("*.nbc"):
        file.write_bytes(file.read_bytes()[:300])
    done = subprocess.run(
        [sys.executable, "-m", "datagen", "generate", "quickstart", "--limit", "1", "--out", tmp_path / "out"],
        capture_output=True, text=True, env={**os.environ, "SPALLGEN_CACHE": str(tmp_path)},
    )  # fmt: skip
    assert (done.returncode, "Traceback" in done.stderr) == (0, False), done.stderr


@pytest.mark.parametrize("name", ["quickstart", pytest.param("corpus", marks=pytest.mark.slow)])
def test_a_run_loads_no_package_that_is_slow_to_load_and_that_it_does_not_need(name: str, tmp_path: Path) -> None:
    script = (
        "import sys\n"
        "from datagen.recipes.recipe_files import find_recipe\n"
        "from datagen.recipes.recipe import load_recipe\n"
        "from datagen.runs.generate import generate\n"
        f"assert generate(load_recipe(find_recipe({name!r})), {str(tmp_path / name)!r}, limit=1).complete\n"
        "print([name for name in ('scipy.signal', 'matplotlib', 'sklearn') if name in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize(("free", "warned"), [(1e6, False), (1e5, True)])
def test_a_run_says_beforehand_what_disk_it_needs(
    free: float,
    warned: bool,
    tiny: Recipe,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("datagen.runs.run.shutil.disk_usage", lambda _: SimpleNamespace(free=free))
    generate(tiny, tmp_path / "out", limit=1, engine=ALONE, listener=Listener(say=Lines().say))
    said = capsys.readouterr().err
    assert "1 record in 1 shard to make; they will need about" in said
    assert ("the disk will be full before the end" in said) == warned


def test_a_dask_scheduler_that_does_not_answer_is_refused_before_anything_is_written(
    tiny: Recipe, tmp_path: Path
) -> None:
    with pytest.raises(BadInput, match="no Dask scheduler answers there"):
        generate(tiny, tmp_path / "out", engine=Engine(backend="dask", scheduler="nonsense://localhost:1"))
    assert not (tmp_path / "out").exists()


def test_lz4_is_refused_before_anything_is_written(tiny: Recipe, tmp_path: Path) -> None:
    recipe = tiny.model_copy(update={"store": tiny.store.model_copy(update={"compression": "lz4"})})
    with pytest.raises(BadInput, match="lz4"):
        generate(recipe, tmp_path / "out", engine=ALONE)
    assert not (tmp_path / "out").exists()


@pytest.mark.usefixtures("record_3_fails")
def test_a_record_that_failed_earlier_is_no_failure_of_a_run_that_does_not_ask_for_it(
    tiny: Recipe, tmp_path: Path
) -> None:
    assert [failure.record for failure in generate(tiny, tmp_path / "out", limit=4, engine=ALONE).failed] == [3]
    later = generate(tiny, tmp_path / "out", records=[1], engine=ALONE)
    assert later.complete
    assert later.failed == ()


def test_the_rate_of_a_run_that_goes_on_counts_only_its_own_records(capsys: pytest.CaptureFixture[str]) -> None:
    lines = Lines(clock=iter([0.0, 4.0]).__next__)
    for done in (10, 12):
        lines.advance(done, 20)
    assert capsys.readouterr().err.splitlines()[-1] == "12 of 20 records, 0.50 records/s, 16 s left"
