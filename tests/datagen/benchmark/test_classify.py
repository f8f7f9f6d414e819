"""The benchmark on a tiny corpus: splits by bearing, own estimators, logs, reports."""

import json
import re
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas
import pytest
from command_line import run

from datagen.benchmark.corpus_rows import read_rows
from datagen.benchmark.impulse_signal import Ingredients
from datagen.benchmark.impulse_training import impulse_training
from datagen.benchmark.machines import learned_machines, machines, share_machines, unseen_records
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.record_rows import RecordFacts, RecordRows, equal_pieces, record_rows
from datagen.benchmark.rows import Rows
from datagen.benchmark.summary import summarise
from datagen.benchmark.training import (
    TrainingSet,
    train_rule,
    training_records,
)
from datagen.benchmark.verdicts import Tested as Judged
from datagen.benchmark.verdicts import Verdicts
from datagen.benchmark.windows import WINDOW_SAMPLES, cut, read_windows, resampled
from datagen.corpus import Corpus
from datagen.judging.known import UNKNOWN_SPEED
from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from labels.classifier.votes import averaged, joined
from labels.features.table import FEATURE_NAMES

pytestmark = pytest.mark.usefixtures("short_records_are_judged")


@pytest.fixture(scope="session")
def other_corpus(tiny_recipe, tmp_path_factory):
    """The whole corpus of the tiny recipe with another seed, that is of other machines."""
    place = tmp_path_factory.mktemp("other")
    (place / "recipe.toml").write_text(tiny_recipe.read_text().replace("seed = 7", "seed = 8"))
    assert generate(load_recipe(place / "recipe.toml"), place / "corpus", engine=Engine(workers=1)).complete
    return place / "corpus"


@pytest.fixture
def classify(tiny_corpus, other_corpus, tmp_path, monkeypatch):
    """Function (*options) → results of `spallgen classify` learned from the tiny corpus and scored on another."""
    (tmp_path / "own_estimators.py").write_text(
        f"import sys\nsys.path.insert(0, {str(tmp_path)!r})\n"
        "import numpy as np\n"
        "class Guesser:\n"
        "    def fit(self, X, y):\n"
        "        self.classes_, counts = np.unique(y, return_counts=True)\n"
        "        self.shares = counts / counts.sum()\n"
        "        return self\n"
        "    def predict_proba(self, X):\n"
        "        return np.tile(self.shares, (len(X), 1))\n"
        "def always_outer(table):\n"
        "    return np.full(len(table), 'line outer')\n"
        "def of_two(table, rate):\n"
        "    return None\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    for module in ("own_estimators", "own_curves"):
        monkeypatch.delitem(sys.modules, module, raising=False)

    def classified(*options):
        file = tmp_path / "results.json"
        command = [
            "classify",
            "--train",
            tiny_corpus,
            "--test",
            other_corpus,
            "--workers",
            "1",
            "--json",
            file,
            *options,
        ]
        done = run(*command)
        return done, json.loads(file.read_text()) if done.exit_code == 0 else None

    return classified


@pytest.fixture
def divided(tiny_corpus, tmp_path):
    """A copy of the tiny corpus in which every fourth bearing is of the split test and every second of validation."""
    copy = tmp_path / "divided"
    shutil.copytree(tiny_corpus, copy)
    index = pandas.read_csv(copy / "index.csv", keep_default_na=False)
    bearings = sorted(index["bearing_id"].unique())
    index["split"] = np.where(index["bearing_id"].isin(bearings[1::2]), "validation", "train")
    index.loc[index["bearing_id"].isin(bearings[::4]), "split"] = "test"
    index.to_csv(copy / "index.csv", index=False)
    return copy


def renamed(folder, name):
    """A copy of a corpus whose virtual bearings have another name."""
    copy = folder.with_name(name)
    shutil.copytree(folder, copy)
    text = (copy / "index.csv").read_text()
    (copy / "index.csv").write_text(text.replace("tiny-0", f"{name}-0"))
    return copy


def test_a_corpus_learned_from_and_tested_on_is_divided_by_virtual_bearing(divided):
    train = training_records(divided, also_tested=True)
    test = unseen_records(Corpus(divided), learned_machines(Corpus(divided), train["record"].to_numpy()))
    assert set(test["split"]) == {"test"}
    assert not set(train["bearing_id"]) & set(test["bearing_id"])
    every = training_records(divided, also_tested=False)
    assert len(every) == len(train) + len(test) == 14
    # Records that were left out of what is learned from, but are not of the split test, are not scored either.
    few = training_records(divided, also_tested=True, first=8)
    assert len(unseen_records(Corpus(divided), learned_machines(Corpus(divided), few["record"].to_numpy()))) == len(
        test
    )


def test_a_copy_under_any_name_is_divided_like_the_corpus_itself(divided):
    copy = renamed(divided, "other")
    assert share_machines(Corpus(divided), Corpus(copy))
    train = training_records(divided, also_tested=True)
    test = unseen_records(Corpus(copy), learned_machines(Corpus(divided), train["record"].to_numpy()))
    numbers = [{name.rpartition("-")[2] for name in labels["bearing_id"]} for labels in (train, test)]
    assert numbers[1]
    assert not numbers[0] & numbers[1]


def test_a_copy_without_a_split_test_is_refused_before_anything_is_read(tiny_corpus, tmp_path, monkeypatch):
    monkeypatch.setattr("datagen.benchmark.training.read_rows", None)
    copy = tmp_path / "copy"
    shutil.copytree(tiny_corpus, copy)
    for folder in (copy, tiny_corpus):
        index = pandas.read_csv(folder / "index.csv", keep_default_na=False)
        assert "test" not in set(index["split"])
    command = ["classify", "--train", str(tiny_corpus), "--test", str(copy), "--workers", "1", "--learner", "logistic"]
    done = run(*command)
    assert done.exit_code == 2
    assert "another seed" in done.output


def test_machines_of_another_seed_or_recorded_are_others(tiny_corpus, other_corpus, tmp_path):
    one, other = Corpus(tiny_corpus), Corpus(other_corpus)
    assert not share_machines(one, other)
    assert set(one.labels["bearing_id"]) == set(other.labels["bearing_id"])
    assert len(unseen_records(other, learned_machines(one, one.labels["record"].to_numpy()))) == len(other.labels)
    assert machines(one)[0] == "7-00000"


def test_only_the_first_records_are_learned_from_if_asked(tiny_corpus):
    every = training_records(tiny_corpus, also_tested=False)
    assert training_records(tiny_corpus, False, 10)["record"].tolist() == every["record"].tolist()[:10]


def test_noisy_copies_are_whole_and_a_stretch_from_anywhere(tiny_corpus):
    labels, signal = Corpus(tiny_corpus).labels.iloc[0].copy(), np.random.default_rng(1).standard_normal((40_000, 1))
    labels["rate_hz"] = 20_000.0
    rows = record_rows(signal, labels, Reading(copies_db=(-18.0, 12.0))).rows
    turns = np.exp([row.values[FEATURE_NAMES.index("turns")] for row in rows])
    assert [row.noisy for row in rows] == [False, True, True]
    assert turns[1] == pytest.approx(turns[0], rel=0.03)  # the speed is refined by up to 2.2 %
    assert 0.14 * turns[0] < turns[2] < 1.03 * turns[0]  # 0.3 s of 2 s is the least


def test_the_rule_is_set_on_healthy_records_as_they_are():
    column, size = FEATURE_NAMES.index("outer_strength"), 80
    table = np.zeros((2 * size, len(FEATURE_NAMES)))
    table[:size, column] = np.repeat(np.linspace(0.0, 1.0, size // 2), 2)  # two axes a record
    table[size:, column] = 5.0
    noisy = np.arange(2 * size) >= size
    records = np.tile(np.repeat(np.arange(size // 2), 2), 2)
    rows = Rows(table, records, np.zeros(2 * size, dtype=np.int64), noisy)
    training = TrainingSet(rows, np.full(2 * size, "healthy"), np.full(2 * size, "a"))
    # The 95 % quantile of records evenly spread from 0 to 1, in logarithms as the table has it.
    assert np.log(train_rule(training).threshold) == pytest.approx(0.95, abs=0.005)


def test_plain_impulse_trains_are_as_many_as_asked():
    counts = []
    made = impulse_training(Ingredients(), Reading(), 1, 12, lambda done, total: counts.append((done, total)))
    assert counts == [(3, 12), (6, 12), (9, 12), (12, 12)]
    assert sorted(set(made.classes)) == ["healthy", "line inner", "line outer"]
    assert len(made.classes) == 12


def test_an_estimator_of_ones_own_is_fitted_and_scored(classify, tmp_path):
    done, results = classify("--estimator", "own_estimators:Guesser", "--out", tmp_path / "report")
    assert done.exit_code == 0
    scores = results["tests"][0]["models"]["Guesser"]
    assert set(scores["confusion"]["columns"]) == {"none", "outer", "inner", "rejected"}
    assert set(results["importances"]["Guesser"]) == set(FEATURE_NAMES)
    assert (tmp_path / "report" / "report.png").read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in (tmp_path / "report").iterdir()) == [
        "report.csv",
        "report.json",
        "report.png",
    ]
    assert json.loads((tmp_path / "report" / "report.json").read_text())["training_records"] == 14


@pytest.mark.parametrize(("inputs", "columns"), [("features", len(FEATURE_NAMES)), ("windows", WINDOW_SAMPLES)])
def test_the_learning_curve_is_that_of_ones_own_estimator(classify, tmp_path, inputs, columns):
    # It names what it saw most of, remembers what it was fitted to, and must be given fresh copies.
    (tmp_path / "own_curves.py").write_text(
        "import numpy as np\n"
        "FITTED = []\n"
        "class Common:\n"
        "    def __init__(self):\n"
        "        self.times = 0\n"
        "    def fit(self, X, y):\n"
        "        self.times += 1\n"
        "        FITTED.append((self.times, X.shape[1], len(X)))\n"
        "        names, counts = np.unique(y, return_counts=True)\n"
        "        self.name = names[counts.argmax()]\n"
        "    def predict(self, X):\n"
        "        return np.full(len(X), self.name)\n"
    )
    done, results = classify("--estimator", "own_curves:Common", "--learning-curve", "--input", inputs)
    assert done.exit_code == 0
    ((name, points),) = results["learning_curve"].items()
    assert name == "Common"
    assert [point["bearings"] for point in points] == [8]  # of ten, two are held out
    assert "learning curve: Common 0." in done.stdout
    assert "] from 8 virtual bearings" in done.stdout
    fitted = sys.modules["own_curves"].FITTED
    assert [(times, width) for times, width, _ in fitted] == [(1, columns)] * 2
    assert fitted[0][2] < fitted[1][2]


@pytest.mark.parametrize("inputs", ["features", "windows"])
def test_how_far_it_has_got_is_told_on_standard_error(classify, other_corpus, inputs, monkeypatch):
    monkeypatch.setattr("datagen.commands.progress_display.SECONDS_BETWEEN_LINES", 0.0)
    done, _ = classify("--estimator", "own_estimators:Guesser", "--input", inputs)
    records = len(Corpus(other_corpus).labels)
    steps = done.stderr.splitlines()
    assert steps[0] == "features of tiny: 0 of 14 records"
    assert {f"features of corpus: {count} of {records} records" for count in (0, records)} < set(steps)
    assert "learning: own_estimators:Guesser" in steps
    assert (f"windows of corpus: {records - 1} of {records} records" in steps) == (inputs == "windows")
    assert "learning from" not in done.stderr


@pytest.mark.parametrize("workers", [1, 2])
def test_how_many_records_are_read_is_told(workers, tiny_corpus, monkeypatch):
    monkeypatch.setattr("datagen.benchmark.corpus_rows.RECORDS_A_TASK", 5)
    counts = []
    found = read_rows(tiny_corpus, np.arange(14), Reading(), workers, lambda *pair: counts.append(pair))
    assert sorted(found.facts) == list(range(14))
    assert found.rows.axis.tolist() == [0, 1] * (len(found.rows) // 2)
    assert counts == [(0, 14), (5, 14), (10, 14), (14, 14)]


def test_that_no_noise_is_added_to_simulated_records_is_said(classify):
    done, results = classify("--estimator", "own_estimators:always_outer", "--noise-db=-10")
    assert done.exit_code == 0
    assert results["tests"][0]["noise"] == []
    assert done.output.count("no noise is added to") == 1


@pytest.mark.parametrize("inputs", ["features", "windows"])
def test_a_function_that_names_classes_is_scored_too(classify, inputs):
    done, results = classify("--estimator", "own_estimators:always_outer", "--input", inputs)
    assert done.exit_code == 0
    scores = results["tests"][0]["models"]["always_outer"]
    said = {prediction["always_outer"]["location"] for prediction in results["tests"][0]["predictions"]}
    assert said <= {"outer", "rejected"}
    assert scores["confusion"]["counts"][2][2] == 0  # no inner record is called inner


def test_ones_own_code_is_named_in_messages_as_it_was_given(classify):
    done, _ = classify("--estimator", "own_estimators:of_two")
    assert done.exit_code == 2
    assert '--estimator = "own_estimators:of_two": it failed to answer: TypeError: of_two() missing 1' in done.output


@pytest.mark.parametrize(
    "options",
    [
        ("--learner", "oracle"),
        ("--estimator", "nowhere:Thing"),
        ("--input", "windows"),
        ("--noise-db", "loud"),
        ("--noise-db=-10", "--input", "windows", "--estimator", "own_estimators:always_outer"),
        ("--learning-curve", "--estimator", "own_estimators:always_outer"),
        ("--noise-db", "nan"),
        ("--noise-db=-10,-101",),
        ("--noise-db", "inf"),
        ("--bandwidth", "nan"),
        ("--estimator", ""),
        ("--test", "nowhere"),
        ("--out", __file__),
        ("--out", f"{__file__}/report"),
        ("--speed-error", "0.1"),
    ],
)
def test_options_that_cannot_be_are_refused_before_anything_is_read(classify, options, monkeypatch):
    monkeypatch.setattr("datagen.benchmark.training.read_rows", None)
    done, _ = classify(*options)
    assert done.exit_code == 2
    assert done.output.count("\n") == 1


def test_a_corpus_is_not_scored_twice(tiny_corpus):
    again = tiny_corpus / ".." / tiny_corpus.name
    done = run("classify", "--train", tiny_corpus, "--test", tiny_corpus, "--test", again)
    assert done.exit_code == 2
    assert done.stderr.endswith("this corpus is named twice\n")


def test_impulse_trains_have_no_windows(tiny_corpus):
    command = ["classify", "--train", "impulse-trains", "--test", str(tiny_corpus), "--input", "windows"]
    done = run(*command, "--estimator", "math:sqrt")
    assert done.exit_code == 2
    assert "features only" in done.output


def test_votes_are_geometric_means_of_the_rows_of_a_record():
    probability = np.array([[0.8, 0.2], [0.2, 0.8], [0.9, 0.1]])
    found = joined(probability, np.array([3, 3, 5]), np.array([3, 5, 7]))
    np.testing.assert_allclose(found[:2], [[0.5, 0.5], [0.9, 0.1]])
    assert np.isnan(found[2]).all()
    assert averaged(probability, np.array([3, 3, 5]), np.array([3]))[0, 0] == pytest.approx(0.5)


def test_long_records_are_cut_into_equal_windows_that_lose_nothing():
    pieces = list(equal_pieces(np.arange(25_000.0), 1000.0, 10.0))
    assert [piece.size for piece in pieces] == [8334, 8333, 8333]
    np.testing.assert_array_equal(np.concatenate(pieces), np.arange(25_000.0))
    assert len(list(equal_pieces(np.arange(1290.0), 1000.0, 1.25))) == 1  # 3 % longer is still one


def test_a_record_without_a_speed_is_rejected_with_its_reason(tiny_corpus):
    labels = Corpus(tiny_corpus).labels.iloc[0].copy()
    labels["speed_rpm"] = np.nan
    assert record_rows(np.zeros((100, 2)), labels, Reading()) == RecordRows([], RecordFacts(UNKNOWN_SPEED))


def test_noise_is_added_at_the_level_asked_and_another_in_each_draw(tiny_corpus):
    corpus = Corpus(tiny_corpus)
    labels, signal = corpus.labels.iloc[0], corpus.waveform(0)[:, :1]
    clean, one, again, other = (
        record_rows(signal, labels, reading).rows[0].values
        for reading in (
            Reading(),
            Reading(noise_db=-10.0),
            Reading(noise_db=-10.0),
            Reading(noise_db=-10.0, noise_draw=1),
        )
    )
    np.testing.assert_array_equal(one, again)
    assert not np.array_equal(one, clean)
    assert not np.array_equal(one, other)


def test_raw_windows_of_any_rate_hold_the_same_tone():
    tone = np.cos(2.0 * np.pi * 100.0 * np.arange(10_000) / 10_000.0)
    slow = resampled(tone, 10_000.0, 2000.0)
    np.testing.assert_allclose(slow, np.cos(2.0 * np.pi * 100.0 * np.arange(2000) / 2000.0), atol=1e-9)
    assert [window.size for window in cut(tone)] == [WINDOW_SAMPLES, WINDOW_SAMPLES]


def test_raw_windows_lie_in_a_file_and_are_those_of_the_records(tiny_corpus):
    corpus = Corpus(tiny_corpus)
    record, rate = int(corpus.labels["record"].iloc[0]), float(corpus.labels["rate_hz"].iloc[0])
    found = read_windows(tiny_corpus, np.array([record]), rate)
    assert isinstance(found.table, np.memmap)
    first = cut(corpus.waveform(record)[:, 0].astype(np.float64))
    np.testing.assert_allclose(found.table[: len(first)], first, rtol=1e-6, atol=1e-12)  # float32 in the file
    assert set(found.record.tolist()) == {record}
    assert found.axis.tolist() == np.repeat([0, 1], len(found) // 2).tolist()


def explained(head):
    """The names in the first column of a table of docs/transfer.md that begins with this head."""
    page = (Path(__file__).parents[3] / "docs" / "transfer.md").read_text(encoding="utf-8")
    rows = page.split(f"| {head} | meaning |\n")[1].split("\n\n")[0].splitlines()[1:]
    return [name for row in rows for name in re.findall(r"`([^`]+)`", row.split("|")[1])]


def test_the_page_explains_every_column_and_key_of_the_reports(classify, tmp_path):
    done, report = classify("--estimator", "own_estimators:Guesser", "--out", tmp_path / "scores")
    assert done.exit_code == 0, done.output
    (tested,) = report["tests"]
    keys = explained("key of `report.json`")
    assert set(keys) == {*report, "learning_curve", *tested}
    scores = explained("key of a model's scores")
    assert set(scores) == {*tested["models"]["Guesser"], *tested["models"]["rule"]}
    columns = explained("column of `report.csv`")
    shown = [column.replace("MODEL", model) for model in ("rule", "Guesser") for column in columns if "MODEL" in column]
    with (tmp_path / "scores" / "report.csv").open() as file:
        assert file.readline().strip().split(",") == [*(one for one in columns if "MODEL" not in one), *shown]
    assert {"faults", "race", "AUC", "false alarms", "rejected"} <= set(explained("in that line"))


def test_the_race_is_scored_of_every_fault_whether_it_raised_the_alarm_or_not():
    said = Verdicts(
        name="model",
        location=np.array(["none", "none", "outer", "rejected", "none"]),
        condition=np.array(["healthy", "healthy", "line", "rejected", "healthy"]),
        race=np.array(["outer", "inner", "outer", "rejected", "outer"]),
        score=np.array([0.1, 0.2, 0.9, np.nan, 0.3]),
        alarm=np.full(5, 0.5),
    )
    rule = replace(said, name="rule")
    truth = np.array(["outer", "outer", "inner", "outer", "none"])
    labels = pandas.DataFrame({"record": range(5), "bearing_id": list("abcde")}).assign(
        snr_db=np.nan, speed_rpm=100.0, extent_mm=np.nan, extent_spacing=np.nan
    )
    tested = Judged(
        folder=Path("corpus"),
        labels=labels,
        truth=truth,
        classes=np.full(5, "unknown"),
        facts=(RecordFacts(),) * 5,
        verdicts=(rule,),
        imported=True,
    )
    scores = summarise(tested).models["rule"]
    assert scores.race_accuracy.value == 0.25  # right: the first of four faults; healthy records do not count
    assert scores.faults_balanced_accuracy.value == 0.0
    assert scores.detection_auc.value == pytest.approx(1.0 / 3.0)  # of three faults with a score one is above 0.3
