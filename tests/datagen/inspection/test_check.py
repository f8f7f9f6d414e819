from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray
from command_line import run

from datagen.corpus import Corpus
from datagen.corpus_files.format import content_hash
from datagen.corpus_files.manifest import read_manifest
from datagen.corpus_files.shard import label_columns, shard_path, sidecar_path
from datagen.errors import BadInput
from datagen.files.atomic import write_atomically
from datagen.files.digest import file_hash
from datagen.files.lock import locked
from datagen.files.netcdf import netcdf_bytes
from datagen.inspection.check import check_corpus
from datagen.recipes.recipe import Recipe, load_recipe, parse_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from physics.outcome import Outcome, SimulationFailed

Change = Callable[[xarray.Dataset], xarray.Dataset]


def forge(folder: Path, shard: int, change: Change) -> None:
    """Rewrite a shard, its sidecar and the manifest so that all hashes agree with the changed contents."""
    path = shard_path(folder, shard)
    with xarray.open_dataset(path) as opened:
        dataset = change(opened.load())
    path.write_bytes(netcdf_bytes(dataset, "zlib"))
    sidecar = json.loads(sidecar_path(folder, shard).read_text())
    manifest = json.loads((folder / "manifest.json").read_text())
    entry = next(entry for entry in manifest["shards"] if entry["file"].endswith(path.name))
    new = {"bytes": path.stat().st_size, "sha256": file_hash(path), "content": content_hash(dataset)}
    sidecar_path(folder, shard).write_text(json.dumps(sidecar | new | {"labels": label_columns(dataset)}))
    entry.update(new)
    manifest["bytes"] = sum(entry["bytes"] for entry in manifest["shards"])
    (folder / "manifest.json").write_text(json.dumps(manifest))


def only_problem(folder: Path) -> str:
    problems = check_corpus(folder).problems
    assert len(problems) == 1, problems
    return problems[0]


def test_a_corpus_as_it_was_made_is_sound_and_its_scenarios_give_its_records_again(tiny_corpus: Path) -> None:
    verdict = check_corpus(tiny_corpus, remake=3)
    assert verdict.problems == ()
    assert verdict.records == 14
    assert verdict.remade == (0, 6, 13)
    assert verdict.largest_difference == 0.0


def test_no_more_records_are_made_again_than_there_are(tiny_corpus: Path) -> None:
    assert check_corpus(tiny_corpus, remake=10**30).remade == tuple(range(14))


def test_a_record_made_again_is_the_stored_one_where_forces_are_stored_too(tmp_path: Path) -> None:
    content = {
        "name": "forces",
        "seed": 5,
        "signal": {"rate_hz": 65536, "duration_s": 0.3},
        "store": {"contact_force": "all"},
        "part": [
            {
                "name": "a",
                "records": 2,
                "machine": {"rig": "gearbox"},
                "defect": {"condition": "line", "extent_deg": 4, "depth_um": 15},
            }
        ],
    }
    generate(parse_recipe(content, tmp_path / "recipe.toml"), tmp_path / "out", engine=Engine(workers=1))
    verdict = check_corpus(tmp_path / "out", remake=2)
    assert verdict.remade == (0, 1)
    assert verdict.largest_difference == 0.0  # 1e-5 where the forces are not kept


def test_a_check_that_is_interrupted_leaves_no_file_open(tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    closed: list[Path] = []
    monkeypatch.setattr("datagen.records.record.make_record", interrupted)
    monkeypatch.setattr(Corpus, "close", lambda corpus: closed.append(corpus.folder))
    with pytest.raises(KeyboardInterrupt):
        check_corpus(tiny_corpus, remake=1)
    assert closed == [tiny_corpus]


@pytest.mark.parametrize("share", [0.35, *(pytest.param(share, marks=pytest.mark.slow) for share in (0.1, 0.6, 0.85))])
def test_one_flipped_bit_anywhere_in_a_shard_is_found(copy: Path, share: float) -> None:
    path = shard_path(copy, 2)
    content = bytearray(path.read_bytes())
    content[int(share * len(content))] ^= 16
    path.write_bytes(content)
    problems = check_corpus(copy).problems
    assert any("shard_000002.nc: its bytes have changed" in sentence for sentence in problems)


def test_a_missing_shard_and_one_without_sidecar_are_found(copy: Path) -> None:
    shard_path(copy, 0).unlink()
    sidecar_path(copy, 1).unlink()
    problems = " / ".join(check_corpus(copy).problems)
    assert "shard_000000.nc: missing" in problems
    assert "shard_000001.nc: unfinished: the sidecar that vouches for it is missing" in problems
    assert "records asked for are missing" in problems


def test_a_shard_that_is_gone_with_its_sidecar_is_found_in_the_manifest(copy: Path) -> None:
    shard_path(copy, 3).unlink()
    sidecar_path(copy, 3).unlink()
    assert "shards/shard_000003.nc: missing, but listed in manifest.json" in check_corpus(copy).problems


def test_a_shard_too_many_is_swept_by_another_run(copy: Path) -> None:
    shutil.copyfile(shard_path(copy, 0), shard_path(copy, 99))
    verdict = check_corpus(copy)
    assert verdict.problems == ("shards/shard_000099.nc: unfinished: the sidecar that vouches for it is missing",)
    assert verdict.remedy.startswith("to mend it, run `spallgen generate` again")


def test_a_place_that_a_shard_does_not_have_is_found_in_the_index_and_written_anew(copy: Path) -> None:
    text = (copy / "index.csv").read_text()
    (copy / "index.csv").write_text(text.replace("shard_000000.nc,1\n", "shard_000000.nc,5\n"))
    verdict = check_corpus(copy)
    assert verdict.problems == ("shards/shard_000000.nc: index.csv disagrees about its records",)
    assert verdict.remedy.startswith("to mend it, run `spallgen generate` again")


def test_a_record_that_two_shards_hold_is_found(copy: Path) -> None:
    shard_path(copy, 99).write_bytes(shard_path(copy, 0).read_bytes())
    sidecar = json.loads(sidecar_path(copy, 0).read_text())
    sidecar_path(copy, 99).write_text(json.dumps(sidecar | {"shard": 99}))
    problem = f"shards/shard_000099.nc: record {min(sidecar['records'])} is in another shard too"
    assert problem in check_corpus(copy).problems


def test_a_copy_of_a_sidecar_under_another_name_is_found(copy: Path) -> None:
    content = (copy / "shards" / "shard_000000.json").read_bytes()
    (copy / "shards" / "shard_000000 (1).json").write_bytes(content)
    problem = "shards/shard_000000 (1).json: by what it says this is shard_000000.json under another name"
    assert only_problem(copy) == problem


def test_a_value_that_is_not_finite_is_found(copy: Path) -> None:
    def spoil(dataset: xarray.Dataset) -> xarray.Dataset:
        dataset["envelope"][0, 5] = np.nan
        return dataset

    forge(copy, 1, spoil)
    assert only_problem(copy) == "shards/shard_000001.nc: envelope has 1 values that are not finite"


def test_a_label_that_differs_from_the_index_is_found(copy: Path) -> None:
    def relabel(dataset: xarray.Dataset) -> xarray.Dataset:
        dataset["load_n"][0] = 1.0
        return dataset

    forge(copy, 1, relabel)
    assert only_problem(copy) == "shards/shard_000001.nc: index.csv disagrees about its records"


def test_a_label_that_differs_from_the_sidecar_is_found(copy: Path) -> None:
    def relabel(dataset: xarray.Dataset) -> xarray.Dataset:
        dataset["load_n"][0] = 1.0
        return dataset

    before = json.loads(sidecar_path(copy, 1).read_text())["labels"]
    forge(copy, 1, relabel)
    sidecar = json.loads(sidecar_path(copy, 1).read_text())
    sidecar_path(copy, 1).write_text(json.dumps(sidecar | {"labels": before}))
    assert only_problem(copy) == "shards/shard_000001.nc: its labels are not those of its sidecar"


def test_arrays_that_are_not_those_of_the_sidecar_are_found_though_the_bytes_are(copy: Path) -> None:
    content = json.loads(sidecar_path(copy, 1).read_text())["content"]
    for path in (sidecar_path(copy, 1), copy / "manifest.json"):
        path.write_text(path.read_text().replace(content, "0" * 64))
    assert only_problem(copy) == "shards/shard_000001.nc: its arrays are not those originally written"


def test_a_shard_that_other_physics_made_is_found(copy: Path) -> None:
    sidecar = json.loads(sidecar_path(copy, 1).read_text())
    sidecar["identity"]["model_hash"] = "0" * 16
    sidecar_path(copy, 1).write_text(json.dumps(sidecar))
    problem = "shards/shard_000001.nc: made from another recipe, physics or format than the manifest states"
    assert only_problem(copy) == problem


def with_another_load(dataset: xarray.Dataset) -> xarray.Dataset:
    """The shard with half a newton more in the scenario of its first record."""
    texts = dataset["scenario"].values.astype(object)
    texts[0] = texts[0].replace('"W":346.0', '"W":346.5')
    return dataset.assign(scenario=("record", texts.astype(np.str_), dataset["scenario"].attrs))


def test_an_index_with_a_lost_row_is_found(copy: Path) -> None:
    lines = (copy / "index.csv").read_text().splitlines()
    (copy / "index.csv").write_text("\n".join(lines[:-1]) + "\n")
    problems = " / ".join(check_corpus(copy).problems)
    assert "index.csv does not list every record of the shards exactly once" in problems


def test_a_manifest_with_a_changed_recipe_is_found(copy: Path) -> None:
    text = (copy / "manifest.json").read_text()
    write_atomically(copy / "manifest.json", text.replace('"seed": 7', '"seed": 8').encode())
    assert "its recipe does not have the hash that it states" in only_problem(copy)
    assert check_corpus(copy).remedy.startswith("to mend it, run `spallgen generate` again")


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("name", "other", "name or recipe_records disagree with its recipe"),
        ("recipe_records", 99, "name or recipe_records disagree with its recipe"),
        ("asked", [], "the corpus holds records that it does not list as asked for"),
        ("records", 5, "records disagrees with the sum over the shards' sidecars"),
        ("bytes", 5, "bytes disagrees with the sum over the shards' sidecars"),
        ("seconds", 1e9, "seconds disagrees with the sum over the shards' sidecars"),
        ("refused", {"machine: fill": {"count": 3, "example": "why"}}, "refused disagrees with the sum"),
        ("failed", [{"record": 3, "reason": "why"}], "failed disagrees with the sum"),
    ],
)
def test_a_manifest_that_says_other_things_than_the_shards_is_found(
    copy: Path, name: str, value: object, message: str
) -> None:
    manifest = json.loads((copy / "manifest.json").read_text()) | {name: value}
    (copy / "manifest.json").write_text(json.dumps(manifest))
    assert f"manifest.json: {message}" in " / ".join(check_corpus(copy).problems)


def test_a_folder_without_manifest_is_no_corpus(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"no manifest\.json"):
        check_corpus(tmp_path)


def test_a_bearing_in_two_splits_is_found(copy: Path) -> None:
    lines = [line.split(",") for line in (copy / "index.csv").read_text().splitlines()]
    bearing, split = lines[0].index("bearing_id"), lines[0].index("split")
    moved = next(row for row in lines[1:] if [other[bearing] for other in lines].count(row[bearing]) > 1)
    moved[split] = "test" if moved[split] == "train" else "train"
    (copy / "index.csv").write_text("".join(f"{','.join(row)}\n" for row in lines))
    assert f"the records of bearing {moved[bearing]} are in more than one split" in check_corpus(copy).problems


@pytest.mark.usefixtures("record_3_fails")
def test_a_record_that_could_not_be_made_is_told_once_and_is_not_missing(tiny: Recipe, tmp_path: Path) -> None:
    assert not generate(tiny, tmp_path / "out", limit=4, engine=Engine(workers=1)).complete
    assert only_problem(tmp_path / "out") == "1 record could not be made; failed.jsonl says why"


def stop_on_the_way(folder: Path) -> None:
    """Leave of a finished corpus what a run leaves that is killed before its last shards."""
    manifest = json.loads((folder / "manifest.json").read_text())
    begun = manifest | {"shards": [], "bytes": 0, "seconds": 0.0, "refused": {}, "failed": []}
    (folder / "manifest.json").write_text(json.dumps(begun))
    for path in (folder / "index.csv", sidecar_path(folder, 4), sidecar_path(folder, 5), shard_path(folder, 5)):
        path.unlink()


def test_a_corpus_whose_run_was_killed_is_not_complete_and_generating_again_finishes_it(
    copy: Path, tiny_recipe: Path
) -> None:
    shards = read_manifest(copy).shards
    stop_on_the_way(copy)
    code, _, message = run("check", copy)
    assert code == 1
    others = len(shards) - 3  # than the first, shards 4 and 5
    assert f"manifest.json: shards/shard_000000.nc and {others} more are not listed\n" in message
    lost, first = shards[4].records + shards[5].records, min(shards[4].first, shards[5].first)
    assert f"{lost} of 14 records asked for are missing, the first {first}\n" in message
    assert "disagree" not in message
    assert "delete" not in message
    again = f"run `spallgen generate` again with the same recipe and --out {copy}\n"
    assert message.endswith(f"it is not complete: to go on where its run stopped, {again}")
    assert run("generate", tiny_recipe, "--out", copy, "--workers", 1)[0] == 0
    assert check_corpus(copy).sound


def test_a_corpus_that_a_run_is_writing_is_to_be_checked_after_it(copy: Path) -> None:
    stop_on_the_way(copy)
    with locked(copy):
        verdict = check_corpus(copy)
    assert verdict.missing > 0
    assert verdict.remedy.startswith("a run is writing into this folder: it is not complete before that ends")


def test_a_run_that_was_stopped_in_good_order_says_how_to_go_on(tiny: Recipe, tmp_path: Path) -> None:
    generate(tiny, tmp_path / "out", limit=2, engine=Engine(workers=1))
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    (tmp_path / "out" / "manifest.json").write_text(json.dumps(manifest | {"asked": [[0, 4]]}))
    verdict = check_corpus(tmp_path / "out")
    assert verdict.problems == ("2 of 4 records asked for are missing, the first 2",)
    assert verdict.remedy.startswith("it is not complete: to go on where its run stopped, run `spallgen generate`")


def test_an_index_that_is_none_is_written_anew_by_another_run(copy: Path) -> None:
    (copy / "index.csv").write_text("hello\n")
    verdict = check_corpus(copy)
    assert len(verdict.problems) == 1
    assert "not the index of a corpus" in verdict.problems[0]
    assert verdict.remedy.startswith("to mend it, run `spallgen generate` again")


@pytest.mark.parametrize(
    ("count", "told"), [(1, "shards/shard_000000.nc is"), (2, "shards/shard_000000.nc and 1 more are")]
)
def test_finished_shards_that_the_manifest_does_not_list_are_told_and_listed_by_another_run(
    count: int, told: str, copy: Path
) -> None:
    manifest = json.loads((copy / "manifest.json").read_text())
    listed = sorted(manifest["shards"], key=lambda entry: entry["file"])[count:]
    (copy / "manifest.json").write_text(json.dumps(manifest | {"shards": listed}))
    verdict = check_corpus(copy)
    assert verdict.problems == (f"manifest.json: {told} not listed",)
    assert verdict.remedy.startswith("to mend it, run `spallgen generate` again")


def test_a_signal_that_the_recipe_stores_of_every_record_is_found_missing(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.runs.plan.signals_of_every_record", lambda recipe: ("acceleration", "background"))
    problem = "shards/shard_000000.nc: background is missing, but the recipe asks for it"
    assert problem in check_corpus(copy).problems


def test_a_scenario_that_the_recipe_does_not_give_is_found_unless_another_version_drew_it(copy: Path) -> None:
    forge(copy, 0, with_another_load)
    assert "the recipe gives record 0 another scenario" in only_problem(copy)
    for path in (copy / "manifest.json", *(copy / "shards").glob("*.json")):
        content = json.loads(path.read_text())
        content["identity"]["program_hash"] = "0" * 16
        path.write_text(json.dumps(content))
    assert check_corpus(copy).sound


@pytest.mark.parametrize(
    "problem", [BadInput("the recording is not at hand"), SimulationFailed(Outcome.NO_START, "no position carries it")]
)
def test_a_record_that_cannot_be_made_again_is_a_problem_and_not_the_end(
    problem: Exception, tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise problem

    monkeypatch.setattr("datagen.records.record.make_record", refused)
    verdict = check_corpus(tiny_corpus, remake=2)
    assert verdict.problems == tuple(
        f"record {record} cannot be simulated again from its scenario: {problem}" for record in (0, 13)
    )
    assert (verdict.remade, verdict.largest_difference) == ((), 0.0)


@pytest.mark.parametrize(("factor", "told"), [(1.0008, ()), (1.0015, ("differs by 0.0015 of its RMS",))])
def test_a_record_made_again_may_differ_by_a_thousandth_of_its_rms(
    factor: float, told: tuple[str, ...], copy: Path
) -> None:
    def amplify(dataset: xarray.Dataset) -> xarray.Dataset:
        attributes = dataset["acceleration"].attrs
        return dataset.assign(acceleration=(dataset["acceleration"] * np.float32(factor)).assign_attrs(attributes))

    forge(copy, 0, amplify)
    assert check_corpus(copy).sound
    problems = check_corpus(copy, remake=1).problems
    assert len(problems) == len(told)
    assert all(
        f"record 0 simulated again from its scenario {text}" in line for text, line in zip(told, problems, strict=True)
    )


def test_the_largest_difference_of_the_records_made_again_is_told(copy: Path) -> None:
    def amplify(dataset: xarray.Dataset) -> xarray.Dataset:
        attributes = dataset["acceleration"].attrs
        return dataset.assign(acceleration=(dataset["acceleration"] * np.float32(1.25)).assign_attrs(attributes))

    forge(copy, 0, amplify)
    code, shown, _ = run("check", copy, "--remake", 2)
    assert code == 1
    assert "simulated again from its scenario: record 0, 13; differs by 0.2 of its RMS" in shown  # 0.25 of 1.25


def test_records_of_other_physics_are_not_made_again_and_that_is_said(copy: Path) -> None:
    for path in (copy / "manifest.json", *(copy / "shards").glob("*.json")):
        content = json.loads(path.read_text())
        content["identity"]["model_hash"] = "0" * 16
        path.write_text(json.dumps(content))
    said = "not simulated again: this program's version of the physics differs from the corpus's\n"
    assert check_corpus(copy, remake=2).remade == ()
    assert [run("check", copy, "--remake", count)[1].endswith(said) for count in (1, 0)] == [True, False]


def test_records_of_unknown_bearings_may_be_in_any_split(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["bearing_id"], index["split"] = "unknown", ["train", "test"] * 7
    index.to_csv(copy / "index.csv", index=False)
    assert not [sentence for sentence in check_corpus(copy).problems if "more than one split" in sentence]


def test_a_path_that_this_locale_cannot_encode_is_told_with_what_to_do(
    copy: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unencodable(*_: object, **__: object) -> None:
        "ä".encode("ascii")

    monkeypatch.setattr("xarray.open_dataset", unencodable)
    with pytest.raises(BadInput, match="lacks letters of this path"):
        check_corpus(copy)


@pytest.mark.usefixtures("record_3_fails")
def test_a_shard_all_of_whose_records_failed_is_no_file_that_is_missing(tiny_recipe: Path, tmp_path: Path) -> None:
    alone = tmp_path / "alone.toml"
    alone.write_text(tiny_recipe.read_text().replace("records_per_shard = 2", "records_per_shard = 1"))
    assert not generate(load_recipe(alone), tmp_path / "out", limit=4, engine=Engine(workers=1)).complete
    assert len(list((tmp_path / "out" / "shards").glob("*.nc"))) == 3
    assert only_problem(tmp_path / "out") == "1 record could not be made; failed.jsonl says why"
