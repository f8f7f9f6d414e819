"""The command on a tiny corpus: own estimators, progress, what is refused before anything is read."""

import shutil
import sys
from dataclasses import replace

import numpy as np
import pandas
import pytest
from command_line import run

from datagen.benchmark.options import Learning, Options, Scoring
from datagen.benchmark.plan import Benchmark
from datagen.benchmark.request import checked
from datagen.benchmark.windows import WINDOW_SAMPLES
from datagen.corpus import Corpus
from datagen.errors import BadInput
from datagen.judging.stated_speed import SPEED_ERROR
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from labels.features.table import FEATURE_NAMES

pytestmark = pytest.mark.usefixtures("short_records_are_judged")


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


def test_an_estimator_of_ones_own_is_fitted_and_scored(classify):
    done, results = classify("--estimator", "own_estimators:Guesser")
    assert done.exit_code == 0
    scores = results["tests"][0]["models"]["Guesser"]
    assert set(scores["confusion"]["columns"]) == {"none", "outer", "inner", "rejected"}
    assert results["training_records"] == 14


@pytest.mark.parametrize(
    ("inputs", "columns"),
    [
        pytest.param("features", len(FEATURE_NAMES), marks=pytest.mark.slow),
        ("windows", WINDOW_SAMPLES),
    ],
)
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


@pytest.mark.parametrize("inputs", ["features", pytest.param("windows", marks=pytest.mark.slow)])
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


def test_that_no_noise_is_added_to_simulated_records_is_said(classify):
    done, results = classify("--estimator", "own_estimators:always_outer", "--noise-db=-10")
    assert done.exit_code == 0
    assert results["tests"][0]["noise"] == []
    assert done.output.count("no noise is added to") == 1


@pytest.mark.parametrize("inputs", [pytest.param("features", marks=pytest.mark.slow), "windows"])
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
    ("options", "told"),
    [
        (("--learner", "oracle"), '--learner = "oracle"; allowed: forest, logistic, boosting, all'),
        (("--estimator", "nowhere:Thing"), '--estimator = "nowhere:Thing"'),
        (("--input", "windows"), '--input = "windows": our learners take features; allowed: with --estimator'),
        (("--input", "sound", "--estimator", "own_estimators:Guesser"), "allowed: features, windows"),
        (("--noise-db", "loud"), '--noise-db = "loud"; allowed: numbers from -100 to 100 dB'),
        (
            ("--noise-db=-10", "--input", "windows", "--estimator", "own_estimators:always_outer"),
            "noise is added where features are computed",
        ),
        (
            ("--learning-curve", "--estimator", "own_estimators:always_outer"),
            "always_outer does not learn",
        ),
        (("--noise-db", "1_0"), '--noise-db = "1_0"; allowed: numbers from -100 to 100 dB'),
        (("--noise-db", "nan"), '--noise-db = "nan"; allowed: numbers from -100 to 100 dB'),
        (("--noise-draws", "3"), "--noise-draws = 3: there is no noise to draw; allowed: with --noise-db"),
        (("--noise-db=-10,-101",), "allowed: numbers from -100 to 100 dB"),
        (("--noise-db", "inf"), "allowed: numbers from -100 to 100 dB"),
        (("--noise-db", "0,101"), "allowed: numbers from -100 to 100 dB"),
        (("--bandwidth", "nan"), "--bandwidth = nan; allowed: 1000 Hz or more"),
        (("--bandwidth", "inf"), "--bandwidth = inf; allowed: 1000 Hz or more"),
        (("--bandwidth", "999"), "--bandwidth = 999.0; allowed: 1000 Hz or more"),
        (("--estimator", ""), "--estimator"),
        (
            ("--estimator", "own_estimators:always_outer", "--learner", "forest"),
            '--learner = "forest": an estimator',
        ),
        (("--estimator", "own_estimators:nothing"), "it can be neither fitted nor asked"),
        (("--estimator", "own_estimators:rule"), 'reports hold something else under the name "rule"'),
        (("--estimator", "own_estimators:rejected"), 'reports hold something else under the name "rejected"'),
        (("--test", "nowhere"), '--test = "nowhere": no such file or folder'),
        (("--test", "."), '--test = "."'),
        (("--out", __file__), "--out"),
        (("--out", f"{__file__}/report"), "--out"),
        (("--speed-error", "0.1"), "--speed-error = 0.1; allowed: 0 to 0.02"),
        (("--speed-error=-0.01",), "--speed-error = -0.01; allowed: 0 to 0.02"),
    ],
)
def test_options_that_cannot_be_are_refused_before_anything_is_read(classify, options, told, monkeypatch):
    monkeypatch.setattr("datagen.benchmark.training.read_rows", None)
    done, _ = classify(*options)
    assert done.exit_code == 2
    assert done.output.count("\n") == 1
    assert told in done.output


def test_options_at_the_edges_of_what_is_allowed_are_taken(tiny_corpus, other_corpus, tmp_path):
    learning = Learning(bandwidth=1000.0, speed_error=0.0)
    asked = (tiny_corpus, (other_corpus,), Options(learning, Scoring(noise_db="-100,100", reject=1.0)))
    plan = checked(Benchmark(*asked, save=tmp_path / "saved"))
    assert (plan.learning, plan.scoring.levels, plan.save) == (learning, (-100.0, 100.0), tmp_path / "saved")
    kept = replace(asked[2], scoring=Scoring(reject=0.0), learning=Learning(speed_error=SPEED_ERROR))
    assert checked(Benchmark(*asked[:2], kept, learning_curve=True)).learning_curve


@pytest.mark.parametrize("reject", [-0.1, 1.1, float("nan")])
def test_a_share_of_doubt_that_is_none_is_refused_whoever_asks(reject, tiny_corpus, other_corpus):
    options = Options(Learning(), Scoring(reject=reject))
    with pytest.raises(BadInput, match=r"--reject = .*; allowed: 0 to 1"):
        checked(Benchmark(tiny_corpus, (other_corpus,), options))


def test_what_can_be_asked_once_it_has_learned_is_an_estimator(tiny_corpus, other_corpus, tmp_path, monkeypatch):
    (tmp_path / "late.py").write_text("class Late:\n    def fit(self, X, y):\n        return self\nlate = Late()\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    options = Options(Learning(estimator="late:late"), Scoring())
    plan = checked(Benchmark(tiny_corpus, (other_corpus,), options, learning_curve=True))
    assert type(plan.estimator).__name__ == "Late"


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


def test_nothing_is_learned_from_recordings(other_corpus, tmp_path):
    np.save(tmp_path / "a.npy", np.random.default_rng(0).standard_normal(4000))
    spec = 'name = "mine"\n[defaults]\nunit = "m/s2"\nrate_hz = 20000\nspeed_rpm = 1200\nbearing = "koyo_1205"\n'
    (tmp_path / "spec.toml").write_text(f'{spec}[[recording]]\nname = "all"\nfiles = "*.npy"\ny = "data"\n')
    import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    done = run("classify", "--train", tmp_path / "corpus", "--test", other_corpus)
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert "classifiers learn from simulated corpora only" in done.output
