"""The examples of docs/python.md, run as they stand on the page."""

import re
from pathlib import Path

import numpy as np
import pytest

from datagen.corpus import Corpus
from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine

PAGE = (Path(__file__).parents[2] / "docs" / "python.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def corpora(tmp_path_factory, tiny_recipe):
    """A folder with two corpora of one recipe, of different seeds, named as the page names them."""
    folder = tmp_path_factory.mktemp("two")
    for name, seed in (("quickstart-corpus", 7), ("second-corpus", 8)):
        (folder / "recipe.toml").write_text(tiny_recipe.read_text().replace("seed = 7", f"seed = {seed}"))
        assert generate(load_recipe(folder), folder / name, limit=4, engine=Engine(workers=1)).complete
    return folder


@pytest.fixture(scope="module")
def names(corpora):
    """What all blocks of the page, run one after the other, leave behind."""
    found = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(corpora)
        for block in BLOCKS:
            exec(block, found)
    return found


def test_the_page_has_an_example_of_everything():
    assert len(BLOCKS) == 4


def test_balls_pass_the_spall_of_ones_own_machine_at_its_bpfo(names):
    # 9 balls, 1772 rpm: half of 9 · 29.533 Hz · (1 − 7.94 / 39.04).
    bpfo = 4.5 * 1772.0 / 60.0 * (1.0 - 7.94 / 39.04)
    passes = names["passes"]
    np.testing.assert_allclose(np.diff(passes.entry_time), 1.0 / bpfo, rtol=1e-9)
    assert len(passes) == pytest.approx(0.5 * bpfo, abs=1.0)
    crossing = 1e-3 / ((39.04e-3 + 7.94e-3) / 2.0) / (2.0 * np.pi * bpfo / 9.0)  # arc over the cage's speed
    np.testing.assert_allclose(passes.exit_time - passes.entry_time, crossing, rtol=1e-9)


def test_its_vibration_is_what_was_asked_for(names):
    trace = names["trace"]
    assert trace.acceleration.shape == (32_768, 2)
    assert trace.error_estimate <= 1e-3
    assert not names["warnings"]
    # Balls are lost and regained in the loaded zone, where the spall is: within each pass.
    passes = names["passes"]
    whole = passes.complete
    assert (passes.release_time[whole] >= passes.entry_time[whole]).all()
    assert (passes.regain_time[whole] > passes.release_time[whole]).all()
    assert np.isfinite(passes.release_time[whole]).all()
    envelope = np.abs(trace.acceleration[:, 1])
    spectrum = np.abs(np.fft.rfft(envelope - envelope.mean()))
    assert np.argmax(spectrum[:80]) == 53  # of 2 Hz: BPFO is 105.9 Hz


def test_its_stiffness_is_larger_along_the_load(names):
    stiffness = names["stiffness"]
    assert stiffness.shape == (500, 3)
    assert (stiffness[:, 1] > stiffness[:, 0]).all()
    assert (stiffness[:, 0] > 0.0).all()


def test_a_recipes_scene_gives_the_clean_acceleration_of_its_record(names, tmp_path):
    scenario, clean, record = names["scenario"], names["clean"], names["record"]
    assert generate(load_recipe("quickstart"), tmp_path / "c", records=[3], engine=Engine(workers=1)).complete
    with Corpus(tmp_path / "c") as corpus:
        stored = corpus.waveform(3, "acceleration_clean")
        assert np.array_equal(record.acceleration, corpus.waveform(3))
        assert corpus.labels["condition"].tolist() == [record.labels["condition"]] == [scenario.condition]
    difference = clean.acceleration - stored
    # Each is within 1e-3 of its RMS, or a little more where noise covers it.
    assert np.sqrt(np.mean(difference**2)) < 3e-3 * np.sqrt(np.mean(stored.astype(float) ** 2))


def test_a_recipe_under_another_name_has_the_same_machines(tmp_path, tiny_recipe, monkeypatch):
    for folder, name in (("quickstart-corpus", "tiny"), ("second-corpus", "another")):
        (tmp_path / "recipe.toml").write_text(tiny_recipe.read_text().replace('name = "tiny"', f'name = "{name}"', 1))
        assert generate(load_recipe(tmp_path), tmp_path / folder, limit=4, engine=Engine(workers=1)).complete
    monkeypatch.chdir(tmp_path)
    found = {}
    exec(BLOCKS[-1], found)
    labels = found["labels"]
    assert labels["bearing_id"].nunique() == 4
    assert labels["machine"].nunique() == 2


def test_machines_of_two_seeds_are_told_apart(names):
    labels = names["labels"]
    assert len(labels) == 8
    assert labels["bearing_id"].nunique() == 2  # the names repeat: two machines of two records in either corpus
    assert labels["machine"].nunique() == 4
    assert set(labels["machine"]) == {"7/00000", "7/00001", "8/00000", "8/00001"}
    assert labels.index.is_unique
    assert set(labels.index.get_level_values("corpus")) == {"quickstart-corpus", "second-corpus"}
