"""What a recipe would make, told without making it; and whether a recipe or a corpus is meant."""

import json
import shutil

import pytest
from command_line import run

from datagen.corpus import Corpus
from datagen.inspection.recipe_check import check_recipe
from datagen.recipes.recipe_files import shipped_recipes


def tree(folder):
    """Every file below a folder with its bytes."""
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_it_says_what_the_recipe_makes(tiny_recipe, tiny_corpus):
    facts, corpus = check_recipe(tiny_recipe), Corpus(tiny_corpus)
    # 8 records of 4 gearboxes and 6 of as many fans, two in a shard at most.
    assert (facts.name, facts.records, facts.machines) == ("tiny", 14, 10)
    assert facts.parts == {"gearbox": 8, "fan": 6}
    assert facts.rates_hz == (32768.0,)
    assert facts.durations_s == (1638.0 / 32768.0,)  # 0.05 s in whole samples
    assert facts.signal_seconds == pytest.approx(14 * 1638 / 32768, rel=1e-12)
    made = corpus.manifest
    assert facts.shards == len(made.shards)
    assert facts.hash == made.identity.recipe_hash
    assert 0.5 * made.bytes < facts.bytes < 2.0 * made.bytes  # of shards so small most is what every shard takes


def test_the_quick_start_is_as_its_readme_says():
    facts = check_recipe("quickstart")
    assert facts.records == 60
    assert facts.bytes < 100e6
    assert facts.signal_seconds == 60 * 0.3125


def test_the_command_says_it_in_a_few_lines_and_makes_nothing(tiny_recipe, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(tiny_recipe, tmp_path / "recipe.toml")
    before = tree(tmp_path)
    done = run("check", tmp_path / "recipe.toml")
    assert (done.exit_code, done.stderr) == (0, "")
    first, *more = done.stdout.splitlines()
    assert first == f"{tmp_path / 'recipe.toml'}: a sound recipe"
    shards, together = check_recipe(tmp_path).shards, 14 * 1638 / 32768
    assert more[0] == f"it makes 14 records of 10 virtual machines in 2 parts, in {shards} shards"
    assert more[1] == f"they last 0.0499878 s each, {together:.6g} s together"
    assert more[2].startswith("sampled at 32768 Hz, about ")
    assert len(more) == 3
    assert run("check", tmp_path) == done
    assert tree(tmp_path) == before


def test_rates_and_lengths_that_differ_are_given_by_their_ends(tiny_recipe, tmp_path):
    text = tiny_recipe.read_text().replace("duration_s = 0.05", "duration_s = {choice = [0.05, 0.0625, 0.125]}")
    (tmp_path / "recipe.toml").write_text(text.replace("rate_hz = 32768", "rate_hz = {choice = [32768, 65536]}"))
    done = run("check", tmp_path, "--json", tmp_path / "facts.json")
    facts = json.loads((tmp_path / "facts.json").read_text())
    assert facts["rates_hz"] == [32768.0, 65536.0]
    assert len(facts["durations_s"]) > 1
    assert f"last {facts['durations_s'][0]:.6g} to {facts['durations_s'][-1]:.6g} s each" in done.stdout
    assert "sampled at 32768 to 65536 Hz" in done.stdout


def test_what_generate_warns_of_it_warns_of(tiny_recipe, tmp_path):
    # Most of these arcs are longer than the ball spacing, and so no line spalls.
    wide = tiny_recipe.read_text().replace("extent_deg = 2.6", "extent_deg = {uniform = [2, 60]}")
    (tmp_path / "recipe.toml").write_text(wide)
    done = run("check", tmp_path)
    assert done.exit_code == 0
    assert "were impossible and were drawn again" in done.stderr


@pytest.mark.parametrize("name", ["quickstart", "datasets/quickstart"])
def test_a_dataset_is_found_by_its_name(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run("check", name)
    assert done.exit_code == 0
    assert done.stdout.startswith(f"{shipped_recipes()['quickstart']}: a sound recipe\n")


def test_a_folder_with_a_corpus_is_a_corpus_whatever_else_lies_there(copy, tiny_recipe):
    shutil.copy(tiny_recipe, copy / "recipe.toml")
    assert "14 records in" in run("check", copy, "--remake", "0").stdout
    (copy / "manifest.json").unlink()
    for command in (("check", copy), ("preview", copy, "--out", copy / "record.png")):
        lost = run(*command)
        assert lost.exit_code == 2
        assert "the manifest.json of this corpus is lost" in lost.stderr


def test_a_folder_without_either_is_no_corpus_as_before(tmp_path):
    done = run("check", tmp_path)
    assert done.exit_code == 2
    assert f"{tmp_path}: this folder has no manifest.json, so it is not a corpus" in done.stderr


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name = ", "not valid TOML"),
        ('name = "a"\n[[recording]]\nname = "b"\n', "this is a SPEC of recordings, which `spallgen import` brings in"),
    ],
)
def test_what_is_no_recipe_is_refused_in_one_line(text, message, tmp_path):
    (tmp_path / "mine.toml").write_text(text)
    done = run("check", tmp_path / "mine.toml")
    assert (done.exit_code, done.stdout, done.stderr.count("\n")) == (2, "", 1)
    assert message in done.stderr


def test_a_path_too_long_for_the_system_is_told():
    done = run("check", "x" * 5000)
    assert (done.exit_code, done.output.count("\n")) == (2, 1)
    assert "cannot be read" in done.output
