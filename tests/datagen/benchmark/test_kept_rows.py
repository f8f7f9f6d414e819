"""The rows that come with the program: those of the corpus transfer, read as classify reads it, and learned from."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from command_line import run

from datagen.benchmark import kept_rows
from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.kept_rows import KeptRows, keep, main
from datagen.benchmark.machines import learned_machines
from datagen.benchmark.options import TRANSFER_ROWS, Learning, Options
from datagen.benchmark.plan import Benchmark, training_reading_of
from datagen.benchmark.training import labelled
from datagen.benchmark.training_source import CorpusRecords, passed_over
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.progress import SILENT
from datagen.recipes.recipe import load_recipe
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from labels.features.table import FEATURE_NAMES

RECORDS, MACHINES, TO_SCORE = 1540, 480, 95  # of transfer: learned from; in all, and of the split test
# What another processor, or physics as exact as asked for, may make of a feature.
ALIKE = 0.02


@pytest.fixture(scope="module")
def beginning(tmp_path_factory):
    """The records of the first machine of transfer, made anew."""
    folder = tmp_path_factory.mktemp("transfer") / "corpus"
    assert generate(load_recipe("transfer"), folder, limit=4, engine=Engine(workers=1)).complete
    return folder


@pytest.fixture
def kept_tiny(tiny_corpus, tmp_path, short_records_are_judged):
    """What is learned from the tiny corpus, and the same as kept rows."""
    source = CorpusRecords(Benchmark(tiny_corpus, (tiny_corpus,)))
    keep(tiny_corpus, tmp_path / "rows.npz")
    return source, KeptRows(file=tmp_path / "rows.npz")


def test_they_are_those_of_the_records_of_transfer(beginning):
    labels = Corpus(beginning).labels
    made = labelled(read_rows(beginning, np.arange(4), training_reading_of(Learning()), 1).rows, labels)
    kept = KeptRows().features(SILENT)
    kept = kept.subset(np.isin(kept.rows.record, np.arange(4)))
    assert np.allclose(kept.rows.table, made.rows.table, rtol=ALIKE, atol=ALIKE)
    for name in ("record", "axis", "noisy"):
        assert np.array_equal(getattr(kept.rows, name), getattr(made.rows, name))
    assert kept.classes.tolist() == made.classes.tolist()
    assert kept.bearings.tolist() == made.bearings.tolist()
    assert KeptRows().recipe == load_recipe("transfer").short_hash


@pytest.mark.slow
def test_they_are_what_the_features_make_of_many_records_now(tmp_path):
    """A change of features that few records show would go unseen in the first of them."""
    folder = tmp_path / "corpus"
    assert generate(load_recipe("transfer"), folder, limit=160, engine=Engine(workers=2)).complete
    kept = KeptRows().features(SILENT).rows
    kept = kept[kept.record < 160]
    made = read_rows(folder, np.unique(kept.record), training_reading_of(Learning()), 2).rows
    assert np.array_equal(made.record, kept.record)
    # Where two candidates are as good, the last digit of a label decides: 12 of 40 000 values when this was written.
    assert np.isclose(kept.table, made.table, rtol=ALIKE, atol=ALIKE).mean() > 0.999


def test_those_of_the_split_test_are_left_to_score():
    kept = KeptRows()
    assert np.unique(kept.features(SILENT).rows.record).size == RECORDS
    assert np.unique(kept.machines.known).size == MACHINES
    assert np.unique(kept.machines.seen).size == MACHINES - TO_SCORE


def test_kept_and_taken_up_again_they_are_what_the_corpus_gives(tiny_corpus, kept_tiny):
    source, kept = kept_tiny
    ours, theirs = kept.features(SILENT), source.features(SILENT)
    assert np.array_equal(ours.rows.table, theirs.rows.table.astype(np.float32))
    assert np.array_equal(ours.rows.record, theirs.rows.record)
    assert ours.classes.tolist() == theirs.classes.tolist()
    assert ours.bearings.tolist() == theirs.bearings.tolist()
    records = Corpus(tiny_corpus).labels.query("split != 'test'")["record"].to_numpy()
    machines = learned_machines(Corpus(tiny_corpus), records)
    assert set(kept.machines.seen) == set(machines.seen)
    assert set(kept.machines.known) == set(machines.known)
    assert kept.recipe == source.recipe


def test_records_of_the_split_test_are_not_kept(divided, tmp_path, short_records_are_judged):
    labels = Corpus(divided).labels.set_index("record")
    assert "test" in set(labels["split"])
    kept_of = keep(divided, tmp_path / "rows.npz")
    with np.load(tmp_path / "rows.npz") as kept:
        records = np.unique(kept["record"])
    assert set(labels.loc[records, "split"]) == {"train", "validation"}
    assert kept_of == np.count_nonzero(labels["split"] != "test")


def test_the_first_records_alone_are_learned_from():
    kept = KeptRows(first=40)
    records = KeptRows().features(SILENT).rows.record
    assert np.unique(kept.features(SILENT).rows.record).tolist() == np.unique(records)[:40].tolist()
    assert np.unique(kept.machines.seen).size == np.unique(kept.features(SILENT).bearings).size
    with pytest.raises(BadInput, match="too few virtual bearings"):
        KeptRows(first=3)


@pytest.mark.parametrize("others_first", [True, False])
def test_the_split_test_is_left_out_where_any_corpus_to_score_has_the_same_machines(
    others_first, divided, other_corpus
):
    tests = (other_corpus, divided) if others_first else (divided, other_corpus)
    labels = Corpus(divided).labels
    left = set(labels.loc[labels["split"] != "test", "bearing_id"])
    machines = CorpusRecords(Benchmark(divided, tests)).machines
    assert {name.replace("7-", "tiny-") for name in machines.seen} == left
    assert len(np.unique(machines.known)) == labels["bearing_id"].nunique() > len(left)
    alone = CorpusRecords(Benchmark(divided, (other_corpus,))).machines
    assert set(alone.seen) == set(alone.known)


def test_of_the_first_records_alone_the_machines_are_learned_from(divided, other_corpus):
    few = Benchmark(divided, (other_corpus,), Options(Learning(first=8)))
    bearings = Corpus(divided).labels.iloc[:8]["bearing_id"]
    assert len(np.unique(CorpusRecords(few).machines.seen)) == bearings.nunique()


def test_classify_learns_from_them_where_nothing_else_is_named(other_corpus, tmp_path):
    saved = tmp_path / "saved"
    done = run("classify", "--learner", "logistic", "--first", "40", "--test", other_corpus, "--save", saved)
    assert done.exit_code == 0, done.output
    assert "learning from transfer-rows: 40 records of 10 virtual bearings" in done.output
    assert run("classify", "--train", saved, "--test", other_corpus).exit_code == 0


def test_a_folder_of_their_name_is_said_to_be_passed_over(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in (TRANSFER_ROWS, "impulse-trains"):
        assert passed_over(Path(name)) == ""
        Path(name).mkdir()
        assert passed_over(Path(name)).endswith(f'the folder of that name is --train "{tmp_path / name}"')
        assert passed_over(tmp_path / name) == ""
    assert passed_over(tmp_path) == ""


def test_classify_says_that_it_does_not_learn_from_a_folder_of_their_name(other_corpus, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path(TRANSFER_ROWS).mkdir()
    done = run("classify", "--learner", "logistic", "--first", "40", "--test", other_corpus)
    assert done.exit_code == 0, done.output
    assert '"transfer-rows" is what comes with the program' in " ".join(done.output.split())


@pytest.fixture
def spinning(tmp_path):
    """A corpus of one recording of noise, of a small bearing at 3000 rpm."""
    np.save(tmp_path / "a.npy", np.random.default_rng(1).standard_normal(20_000))
    (tmp_path / "spec.toml").write_text(
        'name = "spinning"\n[[recording]]\nname = "all"\nfiles = "a.npy"\nunit = "g"\nrate_hz = 20000\ny = "data"\n'
        'speed_rpm = 3000\nbearing = "skf_6205"\n'
    )
    import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "spinning")
    return tmp_path / "spinning"


def test_records_may_be_looked_at_up_to_any_frequency(spinning, tmp_path):
    bands = {}
    for bandwidth in ("2000", "8000"):
        report = tmp_path / f"{bandwidth}.json"
        options = ("--first", "40", "--learner", "logistic", "--bandwidth", bandwidth, "--json", report)
        done = run("classify", "--test", spinning, *options)
        assert done.exit_code == 0, done.output
        (test,) = json.loads(report.read_text())["tests"]
        bands[bandwidth] = test["predictions"][0]["bands"]
        assert test["few_bands"] == (bandwidth == "2000")
        assert ("impacts ring into each other" in " ".join(done.output.split())) == (bandwidth == "2000")
    # A band holds three and a half times BPFI, 948 Hz here: one of 2 kHz, and of 8 kHz the halves and quarters too.
    assert bands == {"2000": 3, "8000": 15}


def test_no_record_is_scored_of_a_machine_that_they_hold(beginning):
    done = run("classify", "--learner", "logistic", "--test", beginning)
    assert done.exit_code == 2
    assert "all its virtual bearings, or all outside its split test, were learned from" in " ".join(done.output.split())


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--speed-error", "0.01"), "--speed-error: transfer-rows have been read already"),
        (("--estimator", "own_estimators:Guesser", "--input", "windows"), "of transfer-rows there are features only"),
        (("--first", "3"), "--first = 3: too few virtual bearings"),
    ],
)
def test_what_does_not_go_with_them_is_refused(other_corpus, classify, options, told):
    done = run("classify", "--test", other_corpus, *options)
    assert done.exit_code == 2
    assert told in done.output


def test_rows_of_other_features_are_refused(monkeypatch):
    monkeypatch.setattr(kept_rows, "FEATURE_NAMES", FEATURE_NAMES[::-1])
    with pytest.raises(BadInput, match="features have changed"):
        KeptRows()


def test_a_corpus_of_another_recipe_or_a_part_of_transfer_leaves_the_file_as_it_is(tiny_corpus, beginning, capsys):
    before = kept_rows.KEPT_FILE.read_bytes()
    assert main([str(tiny_corpus)]) == 2
    assert capsys.readouterr().err == f"error: {tiny_corpus}: this is no corpus of the recipe transfer as it is now\n"
    assert main([str(beginning)]) == 2
    assert "4 of 1920 records" in capsys.readouterr().err
    assert kept_rows.KEPT_FILE.read_bytes() == before


def test_a_folder_without_a_corpus_leaves_the_file_as_it_is(tmp_path, capsys):
    before = kept_rows.KEPT_FILE.read_bytes()
    assert main([str(tmp_path)]) == 2
    assert str(tmp_path) in capsys.readouterr().err
    assert kept_rows.KEPT_FILE.read_bytes() == before
