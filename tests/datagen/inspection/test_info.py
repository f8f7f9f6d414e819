"""What `info` says of a corpus: balance, splits by bearing, cost, and what was refused on the way."""

from __future__ import annotations

import io
import json
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest
from command_line import run
from rich.console import Console

from datagen.cards.card import card_text
from datagen.cards.facts import corpus_facts
from datagen.commands.tables import info_tables
from datagen.corpus_files.manifest import read_manifest, write_manifest
from datagen.inspection.info import Info, Range, corpus_info
from datagen.recipes.recipe import Recipe, load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from datagen.scenarios.refused import Redraw, Refused, add_refused, count_refused
from datagen.scenarios.sampling import draw_scenario
from labels.schema import LABEL, LABELS

RECIPE = """
name = "refusing"
seed = 3
[signal]
rate_hz = 32768
duration_s = 0.02
[store]
records_per_shard = 3
[[part]]
name = "p"
records = 12
records_per_machine = 2
machine.rig = "gearbox"
machine.ball_diameter_mm = {uniform = [8, 12]}
[part.defect]
condition = {balanced = ["healthy", "line"]}
extent_deg = {uniform = [20, 40]}
depth_um = 10
"""


def shown_text(info: Info, width: int = 300) -> str:
    """What `spallgen info` prints."""
    console = Console(width=width, record=True, file=io.StringIO())
    for table in info_tables(info):
        console.print(table)
    return console.export_text()


@pytest.fixture(scope="module")
def recipe(tmp_path_factory: pytest.TempPathFactory) -> Recipe:
    """A recipe of which about half of all machines and spalls cannot be."""
    path = tmp_path_factory.mktemp("recipe") / "refusing.toml"
    path.write_text(RECIPE)
    return load_recipe(path)


@pytest.fixture(scope="module")
def folder(recipe: Recipe, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Its corpus."""
    out = tmp_path_factory.mktemp("corpus") / "refusing"
    assert generate(recipe, out, engine=Engine(workers=1)).complete
    return out


@pytest.fixture(scope="module")
def info(folder: Path) -> Info:
    return corpus_info(folder)


def test_every_refused_draw_counts_once_by_its_parameter(recipe: Recipe, info: Info) -> None:
    scenarios = [draw_scenario(recipe, record) for record in range(recipe.count)]
    seen = {
        (redraw.scope, scenario.seeds.machine if redraw.scope == "machine" else scenario.record, redraw.attempt): redraw
        for scenario in scenarios
        for redraw in scenario.redraws
    }
    expected = Counter(f"{redraw.scope}: {redraw.field}" for redraw in seen.values())
    assert {what: refused.count for what, refused in info.refused.items()} == expected
    assert set(expected) == {"machine: ball_diameter", "record: extent"}
    assert "do not fit" in info.refused["machine: ball_diameter"].example


def test_the_manifest_keeps_the_refused_draws(folder: Path, info: Info) -> None:
    assert read_manifest(folder).refused == info.refused
    written = json.loads((folder / "manifest.json").read_text())["refused"]
    assert written["record: extent"]["count"] == info.refused["record: extent"].count


def test_records_are_counted_by_condition_location_and_split(info: Info) -> None:
    assert info.crossed["condition x location"] == {"healthy": {"none": 6}, "line": {"outer": 6}}
    by_split = info.crossed["condition x split"]
    assert {condition: sum(counts.values()) for condition, counts in by_split.items()} == {"healthy": 6, "line": 6}
    assert by_split["healthy"] == by_split["line"]  # the split is by machine, and each machine has one of both
    assert sum(info.bearings_in_split.values()) == info.bearings == 6


def test_cost_and_size_are_given_a_record(info: Info) -> None:
    assert info.record_seconds == info.worker_seconds / 12
    assert info.record_bytes == info.bytes / 12
    assert info.record_bytes > 0
    assert info.signal_seconds == pytest.approx(12 * 655 / 32768)  # 0.02 s in whole samples
    assert info.made_per_second * info.worker_seconds == pytest.approx(info.signal_seconds)


def test_every_numeric_label_has_its_range(info: Info) -> None:
    columns = {column for label in LABELS if label.dtype in ("float64", "int64") for column in label.columns}
    absent = {"snr_db", "snr_band_db", "mounting_cutoff_hz", "recorder_step"}
    assert columns - set(info.ranges) == absent  # these records have no background, no mounting and no recorder
    assert 20 < info.ranges["extent"].largest * 57.29577951308232 < 40


def test_the_middle_of_a_range_is_that_of_the_records_in_order(recipe: Recipe, info: Info) -> None:
    # Half of the records are healthy, so the middle of their extents lies between 0 and the smallest spall.
    spalls = [draw_scenario(recipe, record).scene.spalls for record in range(recipe.count)]
    smallest = min(spall.extent for own in spalls for spall in own)
    assert info.ranges["extent"].smallest == 0.0
    assert info.ranges["extent"].median == pytest.approx(smallest / 2.0, rel=1e-9)


def test_a_range_is_of_the_records_that_have_the_value_and_counts_the_others(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["tension_share"] = ["NaN"] * 3 + ["0.5"] * 3 + ["0.25"] * 7 + ["0.125"]
    index["snr_db"] = "NaN"
    index.to_csv(copy / "index.csv", index=False)
    ranges = corpus_info(copy).ranges
    assert ranges["tension_share"] == Range(LABEL["tension_share"].unit, 0.125, 0.25, 0.5, 3)
    assert "snr_db" not in ranges


def test_the_tables_show_what_was_refused_and_how_it_is_balanced(info: Info) -> None:
    text = shown_text(info, 160)
    for words in ("impossible draws", "machine: ball_diameter", "records by condition and location", "50.0%", "train"):
        assert words in text


def test_large_numbers_have_no_powers_of_ten_in_the_table_and_on_the_card(folder: Path, info: Info) -> None:
    fast = replace(info, ranges={"rate_hz": Range("Hz", 12000.0, 51200.0, 102400.0, 0)})
    console = Console(width=160, record=True, file=io.StringIO())
    console.print(info_tables(fast)[-1])
    assert "102400" in console.export_text()
    card = card_text(replace(corpus_facts(folder), info=fast), "", {})
    assert "| `rate_hz` | Hz | 12000 | 51200 | 102400 |  |" in card


def test_sizes_are_told_in_megabytes_and_refusals_a_record_that_was_made(info: Info) -> None:
    shown = shown_text(replace(info, asked=24, record_bytes=2.5e6, refused={"machine: fill": Refused(3, "too full")}))
    assert "2.50 MB a record" in shown
    assert "3 │      0.250 │ too full" in shown  # of 12 records


def test_counts_of_shards_add_up_and_keep_the_first_reason() -> None:
    one = count_refused([Redraw("record", 0, "extent", "too long"), Redraw("record", 1, "extent", "longer")])
    other = count_refused([Redraw("machine", 0, "", "no idea"), Redraw("record", 0, "extent", "far too long")])
    assert add_refused([one, other]) == {
        "record: extent": Refused(3, "too long"),
        "machine: other": Refused(1, "no idea"),
    }
    assert list(add_refused([other, one])) == ["record: extent", "machine: other"]  # the most frequent first


DAMAGES: dict[str, Callable[[Path], object]] = {
    "cut off": lambda path: path.write_bytes(path.read_bytes()[:-7]),
    "zeros": lambda path: path.write_bytes(bytes(path.stat().st_size)),
    "gone": Path.unlink,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_info_names_shards_that_cannot_be_read_and_advises_check(damage: str, copy: Path, tmp_path: Path) -> None:
    assert run("info", copy)[::2] == (0, "")
    shards = read_manifest(copy).shards
    DAMAGES[damage](copy / shards[1].file)
    code, shown, message = run("info", copy, "--json", tmp_path / "info.json")
    assert (code, message) == (0, f"1 of {len(shards)} shards cannot be read: run `spallgen check {copy}`\n")
    assert "12 of 14 asked for" in shown
    assert f"{shards[1].file}, with 2 records" in " ".join(shown.replace("│", " ").split())
    field = "missing_files" if damage == "gone" else "damaged_files"
    assert json.loads((tmp_path / "info.json").read_text())[field] == {shards[1].file: 2}
    assert run("check", copy)[0] == 1
    for shard in shards:
        if (copy / shard.file).exists():
            DAMAGES[damage](copy / shard.file)
    code, _, message = run("info", copy)
    assert code == 1
    assert message.startswith(f"{len(shards)} of {len(shards)} shards cannot be read: ")


def test_a_shard_that_is_gone_is_named_and_its_records_are_not_counted_as_there(copy: Path) -> None:
    assert corpus_info(copy).missing_files == {}
    entry = read_manifest(copy).shards[1]
    (copy / entry.file).unlink()
    found = corpus_info(copy)
    assert found.missing_files == {entry.file: entry.records}
    shown = shown_text(found)
    assert f"{14 - entry.records} of 14 asked for" in shown
    assert f"{entry.file}, with {entry.records} records, which all other numbers here still count: generate" in shown


def test_words_of_simulations_are_not_said_of_recordings(tmp_path: Path) -> None:
    for name, size in (("a", 400), ("b", 500)):
        np.save(tmp_path / f"{name}.npy", np.random.default_rng(size).standard_normal(size))
    settings = 'files = "*.npy"\nunit = "g"\nrate_hz = 1000\ny = "data"\nspeed_rpm = 1800\n'
    (tmp_path / "spec.toml").write_text(f'name = "mine"\n[[recording]]\nname = "all"\n{settings}')
    out = tmp_path / "out"
    assert run("import", tmp_path / "spec.toml", "--out", out)[0] == 0
    shown = " ".join(run("info", out)[1].replace("│", " ").split())
    assert "records 2 recordings bearings, by split unknown shards 2," in shown
    for words in ("asked for", "recipe", "real time", "virtual", "model", "not applicable", "could not be made"):
        assert words not in shown
    everything = "condition, location, rig, bearing, profile, contact_law, split"
    assert f"part all 2 unknown of all {everything}" in shown
    assert "records by condition and" not in shown
    assert "physics" not in run("check", out)[1]  # of which recordings have none
    Path(out / read_manifest(out).shards[0].file).unlink()
    assert "1 of 2 recordings" in " ".join(run("info", out)[1].replace("│", " ").split())


def test_records_to_be_read_with_care_are_counted_by_reason_whatever_the_numbers(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["validity"] = ""
    index.loc[:2, "validity"] = [
        "a ball carries 3.2e+04 N",
        "0.12 of the samples are cut off; a ball carries -7 N",
        "a ball carries 12.5 N; a ball carries 1e-3 N",
    ]
    index.to_csv(copy / "index.csv", index=False)
    info = corpus_info(copy)
    assert info.outside_validity == 3
    assert info.validity == {"a ball carries … N": 3, "… of the samples are cut off": 1}
    shown = "".join(shown_text(info).split())
    assert "3│aballcarries…N" in shown
    assert "1│…ofthesamplesarecutoff" in shown


def test_no_table_of_reasons_is_shown_where_there_are_none(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["validity"] = ""
    index.to_csv(copy / "index.csv", index=False)
    assert corpus_info(copy).validity == {}
    assert "because" not in shown_text(corpus_info(copy))


def test_the_cost_of_a_record_is_divided_among_those_that_were_made(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index[:-4].to_csv(copy / "index.csv", index=False)  # as where four of those asked for could not be made
    info = corpus_info(copy)
    assert info.record_seconds == info.worker_seconds / (info.asked - 4)


def test_a_corpus_that_took_no_time_has_no_speed(copy: Path) -> None:
    write_manifest(copy, replace(read_manifest(copy), seconds=0.0))  # thousandths of a second are kept
    assert corpus_info(copy).made_per_second == 0.0


def test_a_shard_that_cannot_be_opened_is_damaged(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    entry, opened = read_manifest(copy).shards[1], Path.open

    def refusing(path: Path, *how: Any, **more: Any) -> Any:
        if path == copy / entry.file:
            raise PermissionError(13, "Permission denied")
        return opened(path, *how, **more)

    monkeypatch.setattr(Path, "open", refusing)
    assert corpus_info(copy).damaged_files == {entry.file: entry.records}
