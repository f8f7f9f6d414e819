from __future__ import annotations

import csv
import hashlib
import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import pytest
import scipy.io
import xarray
from command_line import run

from datagen.cards import corpus_report
from datagen.cards.card import card_text
from datagen.cards.corpus_report import CARD, METADATA, VOCABULARY, Report, write_report
from datagen.cards.croissant import croissant_text, unstated
from datagen.cards.facts import Terms, corpus_facts, solved
from datagen.cards.origin_text import origin_text
from datagen.cards.toml_text import toml_text
from datagen.cards.vocabulary_table import vocabulary_table
from datagen.corpus import Corpus
from datagen.corpus_files.shard import LABEL_COLUMNS
from datagen.errors import BadInput
from datagen.recipes.recipe import Recipe, parse_recipe
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from datagen.runs.generate import generate
from datagen.runs.workers import Engine

SPEC = """
name = "two"
title = "Two recordings"
licence = "CC BY 4.0"
citation = '''
A. Nybody,
2020'''
url = "https://example.org/two"
[[recording]]
name = "all"
files = "*.mat"
unit = "g"
rate_hz = 4000
y = "sig"
table = "t.csv"
"""


@pytest.fixture(scope="session")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An imported corpus of two recordings, of which one has a known speed."""
    folder = tmp_path_factory.mktemp("measured")
    for seed, name in enumerate(("good", "bad")):
        scipy.io.savemat(folder / f"{name}.mat", {"sig": np.random.default_rng(seed).standard_normal((2000, 1))})
    (folder / "t.csv").write_text("file,location,speed_rpm,channel_name\ngood.mat,none,,a\nbad.mat,outer,1500,b\n")
    (folder / "spec.toml").write_text(SPEC)
    import_recordings(load_spec(folder / "spec.toml"), folder / "corpus")
    return folder / "corpus"


@pytest.fixture(scope="session")
def report(tiny_corpus: Path, tmp_path_factory: pytest.TempPathFactory) -> Report:
    """The report of the tiny simulated corpus."""
    return write_report(tiny_corpus, tmp_path_factory.mktemp("report") / "card")


@pytest.fixture(scope="session")
def measured_report(measured: Path) -> Report:
    """The report of the imported corpus, in its own folder."""
    return write_report(measured)


def test_the_facts_are_those_of_the_index(tiny_corpus: Path) -> None:
    facts, table = corpus_facts(tiny_corpus), Corpus(tiny_corpus).labels
    assert sum(kind.records for kind in facts.kinds) == len(table) == 14
    for kind in facts.kinds:
        rows = table[(table["condition"] == kind.condition) & (table["location"] == kind.location)]
        assert (kind.records, kind.first) == (len(rows), rows["record"].min())
        assert sum(kind.by_split.values()) == len(rows)
    assert facts.splits == table["split"].value_counts().to_dict()
    assert sum(one.records for one in facts.solved) == 14
    assert facts.solved[0].largest_error == table["error_estimate"].max()
    assert facts.durations_s == (1638 / 32768, 1638 / 32768)


def test_every_file_of_a_report_is_written_and_every_picture_of_the_card_is_there(report: Report) -> None:
    folder = Path(report.folder)
    assert sorted(path.name for path in folder.iterdir()) == sorted(report.files)
    text = (folder / CARD).read_text()
    pictures = [line.partition("](")[2].rstrip(")") for line in text.splitlines() if line.startswith("![")]
    assert len(pictures) == 1 + len(report.facts.kinds)
    for name in pictures:
        assert (folder / name).read_bytes().startswith(b"\x89PNG")
    assert text.startswith("# A few short records\n")
    assert "| all |  | 14 |" in text
    assert "not stated" in text


def test_the_card_tells_ranges_from_the_smallest_to_the_largest_and_steps_in_microseconds(
    tiny_corpus: Path, report: Report
) -> None:
    lines, table = (Path(report.folder) / CARD).read_text().splitlines(), Corpus(tiny_corpus).labels
    (row,) = (line for line in lines if line.startswith("| `speed_rpm` |") and " rpm " in line)
    cells = [cell.strip() for cell in row.split("|")[1:-1]]
    known = table["speed_rpm"]
    assert known.median() < known.max()
    assert [float(cell) for cell in cells[2:5]] == pytest.approx([known.min(), known.median(), known.max()], rel=1e-4)
    (row,) = (line for line in lines if line.startswith(f"| {table['model'][0]} |"))
    ends = [1e6 * table["step"].min(), 1e6 * table["step"].max()]
    assert row.split("|")[4].strip() == " to ".join(f"{end:.3g}" + " µs" for end in ends)


def test_the_recipe_in_the_card_makes_the_same_corpus(tiny_corpus: Path, tiny: Recipe) -> None:
    text = origin_text(Corpus(tiny_corpus).manifest)
    assert parse_recipe(tomllib.loads(text), Path("card")).hash == tiny.hash


def test_toml_text_is_read_back_as_the_same_data() -> None:
    data = {
        "name": 'quo"te\nline', "number": 0.1, "whole": 3, "truth": True, "list": [1.5, "a"], "odd key": 1,
        "😀": "\x7f",
        "small": {"choice": ["a", "b"]}, "deep": {"inner": {"x": {"uniform": [1.0, 2.0]}}},
        "part": [{"name": "one", "machine": {"rig": "fan"}, "defect": {"line": {"a": {"b": 1}}}}, {"name": "two"}],
    }  # fmt: skip
    assert tomllib.loads(toml_text(data | {"nothing": None, "empty": []})) == data


def test_a_table_of_defaults_alone_that_goes_before_a_wider_one_is_in_the_card(
    tiny_recipe: Path, tmp_path: Path
) -> None:
    content = tomllib.loads(tiny_recipe.read_text()) | {"background": {"white_rms_m_s2": 1.0}}
    content["part"] = [part | {"background": {"white_rms_m_s2": 0.0}} for part in content["part"]]
    recipe = parse_recipe(content, tmp_path / "recipe.toml")
    assert generate(recipe, tmp_path / "out", limit=1, engine=Engine(workers=1)).made == 1
    text = origin_text(Corpus(tmp_path / "out").manifest)
    assert parse_recipe(tomllib.loads(text), Path("card")).hash == recipe.hash


def test_toml_keeps_zeros_false_and_empty_texts() -> None:
    data = {"seed": 0, "store": {"clean": False, "a": 0.0, "b": "", "c": 1, "d": [0]}, "part": [{"records": 0}]}
    assert tomllib.loads(toml_text(data)) == data


def test_croissant_metadata_describe_the_index_column_by_column(tiny_corpus: Path, tiny: Recipe) -> None:
    document = json.loads(croissant_text(tiny_corpus, corpus_facts(tiny_corpus), tiny_corpus))
    assert document["@type"] == "sc:Dataset"
    index = next(entry for entry in document["distribution"] if entry["@type"] == "cr:FileObject")
    content = (tiny_corpus / index["contentUrl"]).read_bytes()
    assert index["sha256"] == hashlib.sha256(content).hexdigest()
    fields = [field["source"]["extract"]["column"] for field in document["recordSet"][0]["field"]]
    assert fields == content.decode().splitlines()[0].split(",")
    assert set(LABEL_COLUMNS) < set(fields)
    assert "license" not in document
    assert tiny.hash.startswith(document["version"])
    assert len(document["version"]) >= 16
    kinds = {field["name"]: field["dataType"] for field in document["recordSet"][0]["field"]}
    told = [kinds[name] for name in ("condition", "record", "speed_rpm", "shard", "position")]
    assert told == ["sc:Text", "sc:Integer", "sc:Float", "sc:Text", "sc:Integer"]


def files_of(folder: Path) -> tuple[Path, set[Path]]:
    """Index and shards that the metadata in `folder` point to."""
    index, shards = json.loads((folder / METADATA).read_text())["distribution"]
    return (folder / index["contentUrl"]).resolve(), {path.resolve() for path in folder.glob(shards["includes"])}


def test_metadata_point_to_the_files_of_the_corpus_from_wherever_they_lie(
    report: Report, measured_report: Report, measured: Path, tiny_corpus: Path
) -> None:
    for written, corpus in ((measured_report, measured), (report, tiny_corpus)):
        index, shards = files_of(Path(written.folder))
        assert index == (corpus / "index.csv").resolve()
        assert shards == {path.resolve() for path in (corpus / "shards").glob("*.nc")} != set()


@pytest.mark.slow
def test_what_nobody_stated_for_the_metadata_is_said(measured: Path, tiny_corpus: Path, tmp_path: Path) -> None:
    for corpus, missing in (
        (measured, "creator, datePublished"),
        (tiny_corpus, "license, url, creator, datePublished"),
    ):
        done = run("report", corpus, "--out", tmp_path / corpus.name)
        assert f"croissant.json lacks: {missing}; add them" in done.stdout


def test_of_licence_and_address_the_one_that_nobody_stated_is_lacking(tiny_corpus: Path) -> None:
    facts = corpus_facts(tiny_corpus)
    licensed, placed = (replace(facts, terms=Terms(*terms)) for terms in (("CC0", "", ""), ("", "", "https://a.org")))
    assert unstated(licensed) == ("url", "creator", "datePublished")
    assert unstated(placed) == ("license", "creator", "datePublished")


def test_labels_in_the_common_vocabulary_have_a_row_a_signal(tiny_corpus: Path) -> None:
    corpus = Corpus(tiny_corpus)
    rows = list(csv.DictReader(vocabulary_table(corpus).splitlines()))
    assert len(rows) == 2 * len(corpus)
    assert [row["signal_id"] for row in rows[:3]] == ["0_x", "0_y", "1_x"]
    assert [float(row["speed_rpm"]) for row in rows[1::2]] == corpus.labels["speed_rpm"].tolist()
    assert {row["fault_type"] for row in rows} == {
        {"none": "normal"}.get(place, place) for place in corpus.labels["location"]
    }


def test_labels_in_the_common_vocabulary_say_in_which_row_of_which_file_a_signal_lies(tiny_corpus: Path) -> None:
    with Corpus(tiny_corpus) as corpus:
        rows = list(csv.DictReader(vocabulary_table(corpus).splitlines()))
    found = []
    for row in rows:
        with xarray.open_dataset(tiny_corpus / row["signal_file"]) as shard:
            found.append(f"{int(shard['record'][int(row['signal_row'])])}_{row['axis']}")
    assert found == [row["signal_id"] for row in rows]


def test_an_imported_corpus_has_a_card_with_its_terms_and_sources(measured_report: Report, measured: Path) -> None:
    assert Path(measured_report.folder) == measured / "report"
    text = (measured / "report" / CARD).read_text()
    kinds = ("| healthy | none | 1 |", "| unknown | outer | 1 |")
    for sentence in (
        "recordings of real machines",
        "CC BY 4.0",
        "| citation | A. Nybody, 2020 |",  # the lines of a text are one in a table
        'files = "*.mat"',
        *kinds,
        "| records | 2 |",
    ):
        assert sentence in text
    assert "asked for" not in text
    document = json.loads((measured / "report" / METADATA).read_text())
    assert (document["license"], document["citeAs"]) == ("CC BY 4.0", "A. Nybody,\n2020")
    assert document["url"] == "https://example.org/two"
    rows = list(csv.DictReader((measured / "report" / VOCABULARY).read_text().splitlines()))
    assert [row["signal_id"] for row in rows] == ["bad b_y", "good a_y"]
    assert [row["fault_type"] for row in rows] == ["outer", "normal"]
    assert [row["fault_origin"] for row in rows] == ["unknown", "none"]
    assert [(row["fault_severity"], row["fault_severity_level"]) for row in rows] == [
        ("not graded", "1"),
        ("none", "0"),
    ]
    assert not {"speed_rpm", "load", "load_unit"} & set(rows[0])  # not known of both


def run_example(card: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> np.ndarray:
    """Do what a card says under "Load it" in the corpus's `folder`; gives the acceleration that it loads."""
    section = card.partition("## Load it")[2].partition("## Terms")[0]
    code = section.partition("```python")[2].partition("```")[0].replace("FOLDER", ".")
    monkeypatch.chdir(folder)
    names: dict[str, Any] = {}
    exec(code, names)
    call = section.partition("or, without spallgen, `")[2].partition("`")[0]
    with eval(call, {"xarray": xarray}) as shard:
        assert "acceleration" in shard
    assert len(names["labels"]) > 0
    names["corpus"].close()
    return np.asarray(names["acceleration"])


def test_the_example_of_a_card_can_be_run(tiny_corpus: Path, report: Report, monkeypatch: pytest.MonkeyPatch) -> None:
    card = (Path(report.folder) / CARD).read_text()
    assert run_example(card, tiny_corpus, monkeypatch).shape == (1638, 2)


def test_so_can_that_of_a_corpus_without_y_and_without_a_first_shard(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for seed, rate in enumerate((4000, 8000)):
        np.save(tmp_path / f"at_{rate}.npy", np.random.default_rng(seed).standard_normal(2000))
    entry = (
        '[[recording]]\nname = "{0}"\nfiles = "at_{0}.npy"\nunit = "g"\nrate_hz = {0}\nx = "data"\nlocation = "{1}"\n'
    )
    # Conditions come in alphabetical order, so the healthy records, which the second shard holds, are the first kind.
    text = 'name = "x"\n' + entry.format(4000, "outer") + entry.format(8000, "none")
    (tmp_path / "spec.toml").write_text(text)
    import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    written = write_report(tmp_path / "corpus")
    assert "shard_000001.nc" in (Path(written.folder) / CARD).read_text()
    card = (Path(written.folder) / CARD).read_text()
    assert run_example(card, tmp_path / "corpus", monkeypatch).shape == (2000, 1)


def test_a_report_is_written_over_an_earlier_one_but_over_nothing_else(measured: Path, tmp_path: Path) -> None:
    write_report(measured, tmp_path / "card")
    (tmp_path / "card" / "record_000999.png").write_bytes(b"of another corpus")
    written = write_report(measured, tmp_path / "card")
    assert {path.name for path in (tmp_path / "card").iterdir()} == set(written.files)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "letter.txt").write_text("keep")
    with pytest.raises(BadInput, match=r"this folder holds things other than a report, such as letter\.txt"):
        write_report(measured, tmp_path / "other")
    assert [path.name for path in (tmp_path / "other").iterdir()] == ["letter.txt"]
    (tmp_path / "other" / "card.md").write_text("of somebody else")
    with pytest.raises(BadInput, match=r"this folder holds things other than a report, such as letter\.txt"):
        write_report(measured, tmp_path / "other")
    (tmp_path / "card" / "record_holiday.png").write_bytes(b"a picture")
    write_report(measured, tmp_path / "card")
    assert (tmp_path / "card" / "record_holiday.png").exists()


def test_a_report_that_was_interrupted_is_written_again(measured: Path, tmp_path: Path) -> None:
    folder = tmp_path / "card"
    folder.mkdir()
    (folder / "card.md").write_text("the first of its files")
    for left in (f".{7:032x}.part", "record_999999.png"):
        (folder / left).write_bytes(b"not finished")
    report = write_report(measured, folder)
    assert sorted(path.name for path in folder.iterdir()) == sorted(report.files)
    assert (folder / "card.md").read_text() != "the first of its files"


def test_pictures_of_previews_without_a_card_are_no_report(measured: Path, tmp_path: Path) -> None:
    (tmp_path / "record_000005.png").write_bytes(b"a preview")
    with pytest.raises(BadInput, match=r"this folder holds things other than a report, such as record_000005\.png"):
        write_report(measured, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["record_000005.png"]


def test_what_another_report_is_just_writing_is_left(
    measured: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writing, drawn = tmp_path / f".{7:032x}.part", corpus_report._contents

    def contents(*arguments: Any) -> dict[str, bytes]:
        writing.write_bytes(b"not finished")
        return drawn(*arguments)

    monkeypatch.setattr(corpus_report, "_contents", contents)
    write_report(measured, tmp_path)
    assert writing.exists()


def test_the_command_writes_the_facts_as_json_and_refuses_a_folder_without_a_corpus(
    measured: Path, tmp_path: Path
) -> None:
    results = tmp_path / "facts.json"
    arguments = ["report", str(measured), "--out", str(tmp_path / "card"), "--json", str(results)]
    assert run(*arguments).exit_code == 0
    assert json.loads(results.read_text())["facts"]["info"]["records"] == 2
    done = run("report", tmp_path, "--out", tmp_path / "none")
    assert done.exit_code == 2
    assert "no manifest.json" in done.stderr
    assert not (tmp_path / "none").exists()
    done = run("report", results)  # without --out
    assert done.stderr == f"error: {results}: this is not a folder; allowed: the folder of a corpus\n"


def test_the_spread_of_errors_is_told_by_quantiles_and_what_is_unknown_is_counted() -> None:
    errors = np.concatenate([np.arange(101.0), [np.nan] * 3])
    table = pandas.DataFrame({"model": "m", "method": "n", "step": 1e-5, "error_estimate": errors})
    (found,) = solved(table)
    # Quantiles of 0, 1, … 100.
    assert (found.median_error, found.error_95_percent, found.largest_error) == pytest.approx((50.0, 95.0, 100.0))
    assert (found.records, found.errors_unknown) == (104, 3)


def test_a_kind_has_the_shard_that_holds_its_first_record(tiny_corpus: Path) -> None:
    shards = Corpus(tiny_corpus).labels.set_index("record")["shard"]
    kinds = corpus_facts(tiny_corpus).kinds
    assert [kind.shard for kind in kinds] == [shards[kind.first] for kind in kinds]


def test_lengths_of_records_are_told_from_the_shortest_to_the_longest(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index.loc[[0, 5], "duration_s"] = [0.02, 3.0]
    index.to_csv(copy / "index.csv", index=False)
    facts = corpus_facts(copy)
    assert facts.durations_s == (0.02, 3.0)
    assert "; 0.02 to 3 s a record |" in card_text(facts, "", {})


def test_the_card_counts_the_records_of_a_kind_below_the_name_of_each_split(copy: Path) -> None:
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["split"] = ["test"] * 3 + ["validation"] * 5 + ["train"] * 6
    index.to_csv(copy / "index.csv", index=False)
    lines = card_text(corpus_facts(copy), "", {}).splitlines()
    assert "| condition | location | records | train | validation | test |" in lines
    for (condition, location), rows in index.groupby(["condition", "location"]):
        counts = " | ".join(str((rows["split"] == split).sum()) for split in ("train", "validation", "test"))
        assert f"| {condition} | {location} | {len(rows)} | {counts} |" in lines
    assert "| all |  | 14 | 6 | 5 | 3 |" in lines


def test_the_card_counts_the_records_that_could_not_be_made(tiny_corpus: Path) -> None:
    facts = corpus_facts(tiny_corpus)
    lacking = replace(facts, info=replace(facts.info, records=12, failed=2))
    assert "| records | 12 of 14 asked for, 2 could not be made; the recipe has 14 |" in card_text(lacking, "", {})


def test_examples_are_of_the_most_frequent_kinds(
    tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kinds = corpus_facts(tiny_corpus).kinds
    most = max(kinds, key=lambda kind: kind.records)
    assert most.records > kinds[0].records
    monkeypatch.setattr("datagen.cards.corpus_report.MOST_EXAMPLES", 1)
    files = write_report(tiny_corpus, tmp_path / "card").files
    assert [name for name in files if name.startswith("record_")] == [f"record_{most.first:06d}.png"]


def test_croissant_finds_the_files_from_a_folder_behind_a_link(tiny_corpus: Path, tmp_path: Path) -> None:
    (tmp_path / "deep" / "card").mkdir(parents=True)
    out = tmp_path / "card"
    out.symlink_to(tmp_path / "deep" / "card")
    document = json.loads(croissant_text(tiny_corpus, corpus_facts(tiny_corpus), out))
    assert (out / document["distribution"][0]["contentUrl"]).samefile(tiny_corpus / "index.csv")


def test_a_recipe_of_another_version_is_shown_as_it_is_stored(tiny_corpus: Path) -> None:
    manifest = Corpus(tiny_corpus).manifest
    newer = manifest.recipe | {"unheard_of": 7}
    assert tomllib.loads(origin_text(replace(manifest, recipe=newer)))["unheard_of"] == 7
