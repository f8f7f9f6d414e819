"""The feature table for people: the rows of classify, beside labels, with those that it does not judge."""

import io
import json

import numpy as np
import pandas
import pytest
from command_line import run

from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.feature_table import COLUMNS, LABELS_SHOWN, feature_table, rejections
from datagen.benchmark.fitness import TOO_SHORT
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.training_source import CorpusRecords
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.judging.known import UNKNOWN_SPEED
from datagen.progress import SILENT
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from labels.classifier.liveness import DEAD, STOPPED
from labels.features.kinematics import bearing_kinematics
from labels.features.signal_features import signal_features
from labels.features.table import FEATURE_NAMES

NAMES = list(FEATURE_NAMES)
RATE, RPM = 12_000.0, 1800.0
GEOMETRY = "bearing = {balls = 9, ball_diameter_mm = 7.94, pitch_diameter_mm = 39.04, contact_angle_deg = 0}"


@pytest.fixture(scope="module")
def recordings(tmp_path_factory):
    """A corpus of five recordings: of 2.5 s, of 12 s, too short, of unknown speed, and of a sensor that was dead."""
    folder = tmp_path_factory.mktemp("recordings")
    generator = np.random.default_rng(5)
    for name, seconds in (("a", 2.5), ("b", 12.0), ("c", 0.05), ("d", 2.0), ("e", 2.0)):
        size = int(seconds * RATE)
        np.save(folder / f"{name}.npy", generator.standard_normal(size) if name != "e" else np.zeros(size))
    known = f'unit = "m/s2"\nrate_hz = {RATE}\ny = "data"\n{GEOMETRY}\n'
    settings = {name: known if name == "d" else f"{known}speed_rpm = {RPM}\n" for name in "abcde"}
    tables = [f'[[recording]]\nname = "{name}"\nfiles = "{name}.npy"\n{text}' for name, text in settings.items()]
    (folder / "spec.toml").write_text('name = "mine"\n' + "".join(tables))
    import_recordings(load_spec(folder / "spec.toml"), folder / "imported")
    return folder / "imported"


def of_recording(table, name):
    return table[table["recording"] == name]


@pytest.mark.usefixtures("short_records_are_judged")
def test_it_holds_the_very_rows_that_classify_learns_from(tiny_corpus):
    benchmark = Benchmark(tiny_corpus, ())
    learned = CorpusRecords(benchmark).features(SILENT)
    table = feature_table([tiny_corpus], as_learned=True)
    assert np.array_equal(table[NAMES].to_numpy(), learned.rows.table)
    assert table["record"].tolist() == learned.rows.record.tolist()
    assert table["noisy"].tolist() == learned.rows.noisy.tolist()
    assert [["x", "y"][axis] for axis in learned.rows.axis] == table["axis"].tolist()
    assert table["class"].tolist() == learned.classes.tolist()
    assert table["bearing_id"].tolist() == learned.bearings.tolist()


def test_it_holds_the_very_rows_that_classify_judges(recordings):
    records = Corpus(recordings).labels["record"].to_numpy()
    judged = read_rows(recordings, records, Benchmark(recordings, ()).reading(), workers=1)
    table = feature_table([recordings])
    rows = table[table["reason"] == ""]
    assert np.array_equal(rows[NAMES].to_numpy(), judged.rows.table)
    assert rows["record"].tolist() == judged.rows.record.tolist()
    assert dict(zip(table["record"], table["reason"], strict=False)) == {r: judged.facts[r].reason for r in records}


@pytest.mark.usefixtures("short_records_are_judged")
def test_a_row_is_what_the_array_alone_gives_and_stands_beside_its_labels(tiny_corpus, monkeypatch):
    monkeypatch.setattr("labels.features.signal_features.FEWEST_TURNS", 0.0)
    corpus, table = Corpus(tiny_corpus), feature_table([tiny_corpus])
    judged = table[table["reason"] == ""]
    assert len(judged)
    for _, row in judged.iterrows():
        label = corpus.labels.set_index("record").loc[row["record"]]
        bearing = bearing_kinematics(
            label.balls, label.pitch_diameter, label.ball_diameter, label.contact_angle, label.speed_rpm / 60.0
        )
        alone = signal_features(corpus.signal(row["record"], row["axis"]), label.rate_hz, bearing)
        assert row[NAMES].tolist() == list(alone.values())
        for name in set(LABELS_SHOWN) - {"record", "snr_db"}:
            assert row[name] == label[name], name
    assert table["class"].isin(["healthy", "line outer", "line inner", "extended outer"]).all()


def test_records_that_cannot_be_judged_are_listed_with_their_reason_and_without_features(tiny_corpus):
    table = feature_table([tiny_corpus])
    assert table["record"].tolist() == list(range(14))
    assert set(table["reason"]) == {TOO_SHORT}
    assert table[NAMES].isna().all(axis=None)
    assert set(table["axis"]) == {""}
    assert rejections(table) == {TOO_SHORT: 14}


def test_a_long_recording_has_a_row_for_each_window(recordings):
    table = feature_table([recordings])
    assert tuple(table.columns) == COLUMNS
    assert of_recording(table, "a")["window"].tolist() == [0]
    assert of_recording(table, "b")["window"].tolist() == [0, 1]  # two pieces of 6 s: a window lasts 10.5 s at most
    assert of_recording(table, "b")[NAMES].notna().all(axis=None)
    assert of_recording(table, "a")["axis"].tolist() == ["y"]
    # White noise has the kurtosis 3, to sqrt(24 / 30 000) of it.
    assert of_recording(table, "a")["kurtosis"].iloc[0] == pytest.approx(np.log(3.0), abs=0.1)
    assert of_recording(table, "a")["found_speed_rpm"].iloc[0] == pytest.approx(RPM, rel=0.022)


def test_each_reason_is_that_of_its_recording(recordings):
    table = feature_table([recordings])
    for name, reason in (("a", ""), ("c", TOO_SHORT), ("d", UNKNOWN_SPEED), ("e", DEAD)):
        assert of_recording(table, name)["reason"].tolist() == [reason]
    assert rejections(table) == {TOO_SHORT: 1, UNKNOWN_SPEED: 1, DEAD: 1}


def test_a_stopped_machine_has_no_features_unless_it_is_learned_from(recordings, monkeypatch):
    class Still:
        reason = STOPPED

    monkeypatch.setattr("datagen.benchmark.record_rows.liveness", lambda *_: Still())
    shown = of_recording(feature_table([recordings]), "b")
    assert shown["reason"].tolist() == [STOPPED]
    assert shown[NAMES].isna().all(axis=None)
    learned = of_recording(feature_table([recordings], as_learned=True), "b")
    assert set(learned["reason"]) == {STOPPED}
    assert learned[NAMES].notna().all(axis=None)


def test_several_corpora_go_into_one_table_and_are_told_apart(tiny_corpus, recordings):
    table = feature_table([tiny_corpus, recordings])
    assert table["corpus"].value_counts().to_dict() == {str(tiny_corpus): 14, str(recordings): 6}
    assert not table.duplicated(["corpus", "record", "axis", "window"]).any()


@pytest.mark.parametrize("workers", [1, 2])
def test_the_command_writes_the_table_and_counts(workers, recordings, tmp_path):
    out, facts = tmp_path / "f.csv", tmp_path / "facts.json"
    done = run("features", recordings, "--out", out, "--workers", workers, "--json", facts)
    assert done.exit_code == 0, done.output
    assert f"6 rows of 5 records are in {out}\n" in done.stdout
    assert f"rejected 1: {TOO_SHORT}\n" in done.stdout
    told = json.loads(facts.read_text())
    assert (told["rows"], told["records"], told["columns"]) == (6, 5, list(COLUMNS))
    assert told["rejected"] == {TOO_SHORT: 1, UNKNOWN_SPEED: 1, DEAD: 1}
    written = pandas.read_csv(io.StringIO(out.read_text()), keep_default_na=True)
    expected = feature_table([recordings])
    assert np.array_equal(written[NAMES].to_numpy(), expected[NAMES].to_numpy(), equal_nan=True)  # to the last bit


def test_a_split_is_taken_alone(copy, tmp_path):
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    index["split"] = np.where(index["record"] < 4, "test", "train")
    index.to_csv(copy / "index.csv", index=False)
    assert run("features", copy, "--out", tmp_path / "f.csv", "--split", "test").exit_code == 0
    assert pandas.read_csv(tmp_path / "f.csv")["record"].tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("nowhere",), "nowhere: no such folder; allowed: the folder of a corpus"),
        (("CORPUS", "--split", "tset"), '--split = "tset": no records of this split; allowed: all, '),
        (("CORPUS", "--bandwidth", "10"), "--bandwidth = 10.0; allowed: 1000 Hz or more"),
        (("CORPUS", "--bandwidth", "nan"), "--bandwidth = nan; allowed: 1000 Hz or more"),
        (("CORPUS", "CORPUS"), "this corpus is given twice; allowed: each corpus once"),
        (("CORPUS", "--workers", "0"), '--workers = "0"; allowed: a whole number from 1'),
        ((), "DIR: it must be given; allowed: DIR: Folders of corpora"),
    ],
)
def test_what_cannot_be_is_told_in_one_line_and_nothing_is_written(
    arguments, message, tiny_corpus, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    done = run("features", *(tiny_corpus if part == "CORPUS" else part for part in arguments), "--out", "f.csv")
    assert done.exit_code == 2
    assert message in done.stderr
    assert (done.stdout, done.stderr.count("\n")) == ("", 1)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("out", ["no/such/folder.csv", "copy", "copy/index.csv"])
def test_a_table_is_not_written_where_it_cannot_be_or_among_the_files_of_a_corpus(out, copy, monkeypatch):
    monkeypatch.chdir(copy.parent)
    before = (copy / "index.csv").read_bytes()
    done = run("features", copy, "--out", out)
    assert done.exit_code == 2
    assert f'--out = "{out}"' in done.stderr
    assert (copy / "index.csv").read_bytes() == before


def test_a_corpus_without_records_is_refused(copy):
    head = (copy / "index.csv").read_text().splitlines()[0]
    (copy / "index.csv").write_text(head + "\n")
    with pytest.raises(BadInput, match="this corpus has no records"):
        feature_table([copy])
