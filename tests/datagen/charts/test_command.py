"""`spallgen chart`: what bad input, a scene without an answer and a full disk say."""

import errno

import pytest
from command_line import run

from datagen.charts import measure as measuring
from physics.outcome import Outcome, SimulationFailed


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("chart", "G9", "--out", "OUT"), "G0, G1, G1s"),
        (("chart", "G9", "--out", "OUT"), "quickstart"),
        (("chart", "quikstart", "--out", "OUT"), 'did you mean "quickstart"?'),
        (("chart", "G1@fast", "--out", "OUT"), "G1@0.01 to G1@100"),
        (("chart", "fan@", "--out", "OUT"), "fan@0.01 to fan@100"),
        (("chart", "G1~11", "--out", "OUT"), "G1~0 to G1~10"),
        (("chart", "G1~1@3", "--out", "OUT"), "G1@3~1"),
        (("chart", "nowhere.toml", "--out", "OUT"), "nowhere.toml"),
        (("chart", "G1"), "--out"),
        (("chart", "--out", "OUT"), "--stability"),
        (("chart", "G1", "--stability", "--out", "OUT"), "--stability"),
        (("chart", "G1", "--out", "OUT", "--rounds", "0"), "--rounds"),
        (("chart", "datasets/quickstart", "--record", "99999", "--out", "OUT"), "record"),
        (("chart", "G1", "--record", "3", "--out", "OUT"), "--record = 3: G1 is one scene without records"),
        (("chart", "G1@3~1", "--record", "0", "--out", "OUT"), "--record = 0: G1@3~1 is one scene without records"),
        (("chart", "--stability", "--record", "3", "--out", "OUT"), "--record = 3: the maps are of no record"),
    ],
)
def test_bad_input_ends_with_2_and_nothing_is_written(arguments, words, tmp_path):
    out = tmp_path / "out"
    code, _, message = run(*(str(out) if argument == "OUT" else argument for argument in arguments))
    assert code == 2, message
    assert words in message
    assert not out.exists()


def test_a_scene_that_cannot_be_simulated_ends_with_1_and_one_line(monkeypatch, tmp_path):
    def refuse(*_, **__):
        raise SimulationFailed(Outcome.NO_START, "no position carries the load")

    monkeypatch.setattr(measuring, "simulate", refuse)
    code, _, message = run("chart", "F1", "--quick", "--out", tmp_path)
    assert code == 1
    assert "this cannot be simulated: no position carries the load; " in message
    assert "Traceback" not in message
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_one_line_that_names_the_folder(monkeypatch, tmp_path, small_chart):
    def full(path, data):
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    monkeypatch.setattr(measuring, "measure", lambda *_: small_chart)
    monkeypatch.setattr("datagen.files.atomic.write_atomically", full)
    code, _, message = run("chart", "F1", "--out", tmp_path)
    assert code == 2
    assert "cannot write here: No space left on device" in message
    assert str(tmp_path) in message
    assert "Traceback" not in message
