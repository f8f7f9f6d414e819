"""What was learned is kept in a file, says the same later, and is refused where it would not."""

from __future__ import annotations

import json
import pickle
import shutil
import zlib
from pathlib import Path

import numpy as np
import pandas
import pytest
from command_line import run

from datagen.benchmark.trained import load_trained
from datagen.errors import BadInput
from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine

pytestmark = pytest.mark.usefixtures("short_records_are_judged")
LEFT_OUT = "tiny-00000"


def classify(*command):
    return run("classify", "--workers", "1", *command)


@pytest.fixture(scope="module")
def divided(tiny_recipe, tmp_path_factory):
    """A corpus of a dozen bearings of each kind, one of them of the split test."""
    place = tmp_path_factory.mktemp("divided")
    text = tiny_recipe.read_text().replace("records = 8", "records = 36").replace("records_per_machine = 2", "")
    text = text.replace('{choice = ["healthy", "line", "extended"]}', '{balanced = ["healthy", "line", "extended"]}')
    (place / "recipe.toml").write_text(text)
    assert generate(load_recipe(place / "recipe.toml"), place / "corpus", engine=Engine(workers=1)).complete
    index = pandas.read_csv(place / "corpus" / "index.csv", keep_default_na=False)
    index["split"] = np.where(index["bearing_id"] == LEFT_OUT, "test", "train")
    index.to_csv(place / "corpus" / "index.csv", index=False)
    return place / "corpus"


@pytest.fixture(scope="module")
def learned(divided, tmp_path_factory):
    """A file of what was learned from the divided corpus, and the results of that run."""
    place = tmp_path_factory.mktemp("learned")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("datagen.benchmark.fitness.SHORTEST", 0.0)
        patch.setattr("datagen.benchmark.fitness.FEWEST_TURNS", 0.0)
        options = (
            "--learner",
            "logistic",
            "--bandwidth",
            3000,
            "--save",
            place / "model",
            "--json",
            place / "results.json",
        )
        done = classify("--train", divided, "--test", divided, *options)
    assert done.exit_code == 0, done.output
    return place / "model", json.loads((place / "results.json").read_text())


def test_the_same_is_said_by_what_was_kept(learned, divided, tmp_path):
    model, before = learned
    done = classify("--train", model, "--test", divided, "--json", tmp_path / "results.json")
    assert done.exit_code == 0
    assert "learning from" not in done.output
    after = json.loads((tmp_path / "results.json").read_text())
    (test,), (again,) = before["tests"], after["tests"]
    assert again["predictions"] == test["predictions"]
    assert {entry["bearing_id"] for entry in again["predictions"]} == {LEFT_OUT}
    assert after["alarms"] == before["alarms"]
    # The corpus has two axes, so it is known by how much a vote of several is raised.
    assert after["alarms"]["logistic"]["several"] > 0.0
    assert after["alarms"]["logistic"]["height_several"] > 1.0
    assert after["rule_of_several_axes"] == after["alarms"]["logistic"]["height_several"]
    assert after["training_records"] == before["training_records"]


def test_a_run_is_logged_with_the_options_that_it_was_learned_with_and_scored_with(learned, divided, tmp_path):
    recorded = tmp_path / "recorded"
    shutil.copytree(divided, recorded)
    manifest = json.loads((recorded / "manifest.json").read_text())
    as_imported = {"origin": "imported", "recipe": manifest["recipe"] | {"spec": {}}}
    (recorded / "manifest.json").write_text(json.dumps(manifest | as_imported))
    done = classify("--train", learned[0], "--test", recorded, "--reject", 0.25, "--json", tmp_path / "results.json")
    assert done.exit_code == 0, done.output
    began, ended = (json.loads(line) for line in (recorded / "scored_runs.jsonl").read_text().splitlines())
    used = {"learner": "logistic", "bandwidth": 3000.0, "reject": 0.25}
    for options in (began["began"], ended["options"], json.loads((tmp_path / "results.json").read_text())["options"]):
        assert {name: options[name] for name in used} == used
        assert list(options) == [
            "learner",
            "estimator",
            "input",
            "bandwidth",
            "speed_error",
            "first",
            "reject",
            "noise_db",
            "noise_draws",
        ]


def test_what_was_learned_from_is_not_scored(learned, divided, tmp_path):
    model, _ = learned
    undivided = tmp_path / "undivided"
    shutil.copytree(divided, undivided)
    index = (undivided / "index.csv").read_text()
    (undivided / "index.csv").write_text(index.replace(",test,", ",train,"))
    done = classify("--train", model, "--test", undivided)
    assert done.exit_code == 2
    assert "another seed" in done.output


def test_learning_needs_no_test(divided, tmp_path):
    done = classify("--train", divided, "--learner", "logistic", "--save", tmp_path / "model")
    assert done.exit_code == 0
    assert [model.name for model in load_trained(tmp_path / "model").models] == ["logistic"]
    assert [path.name for path in tmp_path.iterdir()] == ["model"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--learner", "forest"), "--learner: {model} has learned already"),
        (("--first", 5), "--first: {model} has learned already"),
        (("--speed-error", 0.01), "--speed-error: {model} has learned already"),
        (("--bandwidth", 5000), "--bandwidth: {model} has learned already"),
        (("--learning-curve",), "--learning-curve: {model} has learned already"),
        (("--save", "other"), "--save: {model} has learned already"),
    ],
)
def test_options_of_learning_are_refused_for_what_has_learned(
    learned, divided, options, message, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    done = classify("--train", learned[0], "--test", divided, *options)
    assert done.exit_code == 2
    assert message.format(model=learned[0]) in done.output
    assert not list(tmp_path.iterdir())


def test_there_must_be_something_to_do(divided):
    done = classify("--train", divided)
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert "--test: nothing to score on" in done.output


@pytest.mark.parametrize("place", ["absent/model", "."])
def test_a_place_that_cannot_be_written_is_refused_first(divided, place, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("datagen.benchmark.training.read_rows", None)
    done = classify("--train", divided, "--save", place)
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert f'--save = "{place}"' in done.output


def test_an_estimator_of_ones_own_is_not_kept(divided, tmp_path):
    done = classify("--train", divided, "--estimator", "math:sqrt", "--save", tmp_path / "model")
    assert done.exit_code == 2
    assert "yours to keep" in done.output


class Bomb:
    """What must never be unpickled."""

    def __reduce__(self):
        return Path.write_text, (Path("exploded"), "")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda head, body: b"", "holds no learned classifiers"),
        (lambda head, body: b"\x80\x04 nothing of ours", "holds no learned classifiers"),
        (lambda head, body: b"[1, 2]\n" + body, "holds no learned classifiers"),
        (lambda head, body: head.replace(b'"features": "', b'"features": "0') + body, "was learned with features 0"),
        (lambda head, body: head.replace(b'"benchmark": "', b'"benchmark": "0') + body, "was learned with benchmark 0"),
        (lambda head, body: head.replace(b'"numpy": "', b'"numpy": "0.') + body, "was learned with numpy 0."),
        (lambda head, body: head + zlib.compress(pickle.dumps(Path()).replace(b"pathlib", b"pathlab")), "is damaged"),
        (lambda head, body: head + zlib.compress(pickle.dumps(Path()).replace(b"Posix", b"Waxen")), "is damaged"),
        (lambda head, body: head + body[:-100], "is damaged"),
        (lambda head, body: head + body[: len(body) // 2] + b"\0" + body[len(body) // 2 + 1 :], "is damaged"),
        (
            lambda head, body: b'{"format": "spallgen classifiers 1"}\n' + pickle.dumps(Bomb()),
            "was learned with python",
        ),
    ],
    ids=[
        "empty",
        "binary",
        "list",
        "other features",
        "other benchmark",
        "other numpy",
        "a module gone",
        "a class renamed",
        "cut",
        "flipped",
        "another pickle",
    ],
)
def test_a_file_that_would_not_say_the_same_is_refused(learned, change, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    head, _, body = learned[0].read_bytes().partition(b"\n")
    (tmp_path / "model").write_bytes(change(head + b"\n", body))
    with pytest.raises(BadInput) as problem:
        load_trained(tmp_path / "model")
    assert message in str(problem.value)
    assert not (tmp_path / "exploded").exists()
