"""Sizes of recordings that know nothing of ball passes."""

from __future__ import annotations

import csv
import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line import run

from datagen.errors import BadInput
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from datagen.sizing.corpus_run import score_sizes
from datagen.sizing.size_request import SizeRequest
from datagen.sizing.sized_records import sized_records, without_load
from datagen.sizing.stated_situation import reason_against, speed_found
from labels.features.mending import Mended
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome
from physics import catalog

SPEC = """
name = "mine"
[defaults]
unit = "m/s2"
rate_hz = 20000
speed_rpm = 1200
bearing = "koyo_1205"
[[recording]]
name = "all"
files = "*.npy"
y = "data"
"""


def imported(folder: Path, spec: str = SPEC, **signals: np.ndarray) -> Path:
    """A corpus of recordings, one a signal (T,) at 20 kHz."""
    for name, signal in signals.items():
        np.save(folder / f"{name}.npy", signal)
    (folder / "spec.toml").write_text(spec)
    import_recordings(load_spec(folder / "spec.toml"), folder / "corpus")
    return folder / "corpus"


def noise(seed: int) -> np.ndarray:
    """A second of it."""
    return np.random.default_rng(seed).standard_normal(20000)


def size(*arguments: object) -> tuple[int, str, str]:
    done = run("size", *arguments)
    return done.exit_code, " ".join(done.stdout.split()), done.stderr


@pytest.mark.parametrize(
    ("settings", "shown"),
    [
        ('channel_name = "B3"\n', "│ noise B3 │"),
        ('channel_name = "B3"\nrecording = "first"\n', "│ first B3 │"),
        ("", "│ noise │"),
    ],
)
def test_a_channel_is_shown_once_beside_its_recording(settings: str, shown: str, tmp_path: Path) -> None:
    corpus = imported(tmp_path, SPEC + settings, noise=noise(2))
    assert shown in size(corpus)[1]


def test_recordings_are_given_sizes_or_not_without_being_scored(tmp_path: Path) -> None:
    corpus = imported(tmp_path, noise=noise(2))
    scores = score_sizes(SizeRequest(corpus))
    assert scores.summary is None
    (only,) = scores.records
    assert not only.truth.known
    assert not only.found
    code, said, _ = size(corpus, "--out", tmp_path / "out")
    assert code == 0
    assert "1 record, 0 with an estimate" in said
    assert "│ 0 │ noise │ │ │ │" in said
    assert (tmp_path / "out" / "estimates.csv").read_text().count("\n") == 2  # a line of names and one record
    assert not (tmp_path / "out" / "size_report.png").exists()
    assert "size_report.json and estimates.csv are in" in said


TABLE = """
name = "mine"
[defaults]
unit = "m/s2"
rate_hz = 20000
bearing = "koyo_1205"
[[recording]]
name = "all"
files = "*.npy"
y = "data"
table = "speeds.csv"
"""


def test_a_machine_at_rest_or_of_unknown_speed_gets_no_estimate_and_the_others_do(tmp_path: Path) -> None:
    (tmp_path / "speeds.csv").write_text("file,speed_rpm\nrest.npy,0\nruns.npy,1200\nunsaid.npy,\n")
    corpus = imported(tmp_path, TABLE, rest=noise(1), runs=noise(2), unsaid=noise(3))
    code, said, _ = size(corpus, "--json", tmp_path / "s.json", "--out", tmp_path / "out")
    assert code == 0
    assert "3 records, 0 with an estimate, 2 could not be given to the estimator" in said
    rows = {row["recording"]: row for row in json.loads((tmp_path / "s.json").read_text())["records"]}
    assert rows["rest"]["outcome"] == rows["unsaid"]["outcome"] == "not_asked"
    assert rows["rest"]["reason"] == "the machine stood still: speed_rpm = 0"
    assert rows["unsaid"]["reason"] == "not known: shaft speed"
    assert rows["runs"]["outcome"] != "not_asked"
    assert "the machine stood still" in said
    listed = list(csv.DictReader((tmp_path / "out" / "estimates.csv").open()))
    assert [row["reason"] for row in listed] == [rows[row["recording"]]["reason"] for row in listed]
    assert len(listed) == 3


def test_where_no_record_can_be_sized_one_message_says_why_and_nothing_is_written(tmp_path: Path) -> None:
    (tmp_path / "speeds.csv").write_text("file,speed_rpm\nrest.npy,0\nunsaid.npy,\n")
    corpus = imported(tmp_path, TABLE, rest=noise(1), unsaid=noise(3))
    code, said, complaint = size(corpus, "--json", tmp_path / "s.json", "--out", tmp_path / "out")
    assert (code, said, complaint.count("\n")) == (2, "", 1)
    assert "none of its 2 records can be sized: 1 (the machine stood still: speed_rpm = 0), 1 (not known" in complaint
    assert not (tmp_path / "s.json").exists()
    assert not (tmp_path / "out").exists()


def test_the_speed_stated_with_a_recording_is_taken_as_it_is(tmp_path: Path) -> None:
    (one,) = sized_records(imported(tmp_path, noise=noise(2)))
    assert one.situation.shaft_speed == pytest.approx(2.0 * math.pi * 20.0, rel=1e-12)  # 1200 rpm
    assert one.situation.load is None
    assert not one.situation.polarity_known


def knocks(shaft_hz: float) -> np.ndarray:
    """A second in which every ball that passes the outer race knocks, and the shaft is unbalanced."""
    time = np.arange(20000) / 20000.0
    passing = catalog.bearing("koyo_1205").bpfo * shaft_hz
    since = (time * passing) % 1.0 / passing
    ringing = np.exp(-since / 1e-3) * np.sin(2.0 * np.pi * 3000.0 * since)
    return ringing + 0.3 * np.sin(2.0 * np.pi * shaft_hz * time) + 0.05 * noise(5)


@pytest.mark.parametrize(("key", "expected"), [("nominal_speed_rpm", 0.962), ("speed_rpm", 1.0)])
def test_a_nominal_speed_is_looked_for_and_another_one_is_not(key: str, expected: float, tmp_path: Path) -> None:
    spec = SPEC.replace("speed_rpm", key)
    (record,) = sized_records(imported(tmp_path, spec, knocks=knocks(0.962 * 20.0)))
    assert record.situation.shaft_speed == pytest.approx(expected * 1200.0 * math.pi / 30.0, rel=2e-3)


@pytest.mark.parametrize("spoilt", ["jump", "drift", "glitch"])
def test_neither_a_bias_that_moves_nor_a_glitch_changes_a_size(spoilt: str, tmp_path: Path) -> None:
    signal = knocks(20.0)
    place, spread = np.arange(signal.size), signal.std()
    added = {"jump": 30.0 * (place > 9000), "drift": 3e-4 * place, "glitch": 300.0 * (place == 7000)}
    clean, other = sized_records(imported(tmp_path, knocks=signal, spoilt=signal + spread * added[spoilt]))
    assert np.abs(other.acceleration - clean.acceleration).max() < 0.2 * spread


def test_a_shock_is_cut_before_a_size_is_told(tmp_path: Path) -> None:
    signal = knocks(20.0)
    (one,) = sized_records(
        imported(tmp_path, shock=signal + 100.0 * signal.std() * (np.abs(np.arange(20000) - 9000) < 60))
    )
    assert np.abs(one.acceleration).max() < 3.0 * np.abs(signal).max()


def test_recordings_are_mended_by_the_turns_of_the_recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    turns = []

    def listening(signal: np.ndarray, made: float) -> Mended:
        turns.append(made)
        return Mended(signal)

    monkeypatch.setattr("datagen.sizing.sized_records.mended", listening)
    (one,) = sized_records(imported(tmp_path, noise=noise(2)[:4000]))
    # 0.2 s at 20 turns a second, of each axis
    assert turns == pytest.approx([4.0] * one.acceleration.shape[1])


def test_a_changing_speed_is_named_where_there_is_no_size(tmp_path: Path) -> None:
    time = np.arange(20000) / 20000.0
    turns = 15.0 * time + 5.0 * time**2
    np.savez(tmp_path / "run.npz", a=noise(2), pulses=1.0 * (turns % 1.0 < 0.5))
    spec = (
        SPEC.replace("*.npy", "*.npz")
        .replace('"data"', '"a"')
        .replace("speed_rpm = 1200", 'tach = {variable = "pulses"}')
    )
    (tmp_path / "spec.toml").write_text(spec)
    import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    assert size(tmp_path / "corpus", "--json", tmp_path / "s.json")[0] == 0
    assert "the speed of the shaft changes" in (tmp_path / "s.json").read_text()


KNOWN = {
    "balls": 12, "pitch_diameter": 38e-3, "ball_diameter": 8e-3, "contact_angle": 0.0, "speed_rpm": 1200.0,
    "rate_hz": 2e4, "speed_basis": "nominal",
}  # fmt: skip


@pytest.mark.parametrize("signal", [np.zeros(20000), np.arange(50.0)])
def test_where_a_signal_says_nothing_of_a_nominal_speed_it_is_taken_as_it_is(signal: np.ndarray) -> None:
    assert speed_found(KNOWN, signal) == 1.0


def test_geometry_that_no_bearing_can_have_is_a_reason_and_no_crash() -> None:
    labels = {"record": 0, "balls": 40, "rows": 1, "pitch_diameter": 38e-3, "ball_diameter": 8e-3, "rate_hz": 2e4,
              "contact_angle": math.nan, "speed_rpm": 600.0}  # fmt: skip
    assert "40 balls of 8.000 mm do not fit" in reason_against(labels)
    assert reason_against(labels | {"balls": 12}) == ""
    assert reason_against(labels | {"balls": math.nan, "ball_diameter": math.nan}) == (
        "not known: number of balls, ball diameter"
    )


class Tells:
    """An estimator that tells one spall of every record."""

    def estimate(self, acceleration: np.ndarray, rate: float, situation: Situation) -> SizeEstimate:
        return SizeEstimate(
            SizeOutcome.ESTIMATED, "constant", "inner", lag=1e-3, lag_interval=(9e-4, 2e-3), lag_arc=0.05, extent=0.1,
            extent_interval=(0.08, 0.12), extent_mm=2.0, extent_mm_interval=(1.6, 2.4), candidates=(0.1, 0.6),
            trust=0.8, event_times=np.array([[0.1, 0.101], [0.2, 0.201]]),
        )  # fmt: skip


def test_the_table_of_recordings_tells_race_size_intervals_and_trust(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.sizing.corpus_run.find_estimator", lambda _: Tells())
    code, said, _ = size(imported(tmp_path, noise=noise(2)), "--json", tmp_path / "s.json")
    assert code == 0
    # 0.1 rad is 5.73 degrees, its interval 4.58 to 6.88.
    assert "│ 0 │ noise │ inner │ 5.73 [4.58, 6.88] │ 2 [1.6, 2.4] │ 0.80 │ │" in said
    (row,) = json.loads((tmp_path / "s.json").read_text())["records"]
    assert row["event_times"] == [[0.1, 0.101], [0.2, 0.201]]
    assert (row["method"], row["lag_low"], row["lag_high"]) == ("constant", 9e-4, 2e-3)
    assert row["candidates_mm"] == pytest.approx([2.0, 12.0])


STATED = """
name = "mine"
[defaults]
unit = "m/s2"
rate_hz = 20000
speed_rpm = 1200
bearing = {balls = 12, rows = 2, pitch_diameter_mm = 38.75, ball_diameter_mm = 7.12%s}
load_n = 346
[[recording]]
name = "all"
files = "*.npy"
y = "data"
table = "states.csv"
"""
STATES = "file,location,extent_deg\nnone.npy,none,\nwide.npy,inner,7.16197\nlong.npy,outer,11.45916\nsilent.npy,,\n"


@pytest.fixture
def stated(tmp_path: Path) -> Path:
    """Four recordings: a healthy one, spalls of 0.125 rad (inner) and 0.2 rad (outer), one of which nothing is said."""
    (tmp_path / "states.csv").write_text(STATES)
    return imported(tmp_path, STATED % "", none=noise(2), wide=noise(3), long=noise(4), silent=noise(5))


def test_recordings_are_scored_by_the_extents_that_are_stated_and_the_run_is_logged(
    stated: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("datagen.sizing.corpus_run.find_estimator", lambda _: Tells())
    code, said, _ = size(stated, "--json", tmp_path / "s.json")
    assert code == 0
    found = json.loads((tmp_path / "s.json").read_text())
    assert found["summary"] is None
    scores = found["stated"]
    # 0.1 rad on the inner race is the answer to each: 20 % and 50 % wrong.
    assert scores["arc_error"] == pytest.approx(0.35, abs=1e-6)
    counts = ("records", "answered", "answered_on_the_stated_race", "healthy", "healthy_answered")
    assert [scores[name] for name in counts] == [2, 2, 1, 1, 1]
    assert "of 2 records of a stated extent 2 were given a size, mean error of their arc 0.350" in said
    began, ended = (json.loads(line) for line in (stated / "scored_runs.jsonl").read_text().splitlines())
    assert began["began"]["load_known"]
    assert ended["scores"] == scores


def test_recordings_of_which_nothing_is_stated_are_neither_scored_nor_logged(tmp_path: Path) -> None:
    corpus = imported(tmp_path, noise=noise(2))
    assert score_sizes(SizeRequest(corpus)).stated is None
    assert not (corpus / "scored_runs.jsonl").exists()


def test_without_a_hertz_factor_the_command_says_that_it_is_blind(stated: Path) -> None:
    assert "blind: the load or the Hertz factor of these records is unknown" in size(stated)[1]
    assert "blind:" not in size(stated, "--blind")[1]  # as was asked


def test_the_records_whose_load_and_hertz_factor_were_given_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "speeds.csv").write_text(
        "file,speed_rpm,load_n\nfree.npy,1200,\npressed.npy,1200,200\nrest.npy,0,200\n"
    )
    corpus = imported(tmp_path, TABLE, free=noise(1), pressed=noise(2), rest=noise(3))
    monkeypatch.setattr("datagen.sizing.corpus_run.find_estimator", lambda _: Tells())
    for load_known, given in ((True, ["pressed"]), (False, [])):
        scores = score_sizes(SizeRequest(corpus, load_known=load_known))
        assert [one.truth.recording for one in scores.records if one.answer.load_known] == given
        assert scores.load_given == len(given)


@pytest.mark.parametrize(
    ("bearing", "factor"),
    [
        (", load_deflection_n_per_m_to_n = 6e9, exponent = 1.4", (6e9, 1.4)),
        (", load_deflection_n_per_m_to_n = 6e9", (6e9, 1.5)),
    ],
)
def test_a_stated_hertz_factor_comes_with_the_load(tmp_path: Path, bearing: str, factor: tuple[float, float]) -> None:
    (tmp_path / "states.csv").write_text(STATES)
    corpus = imported(tmp_path, STATED % bearing, none=noise(1), wide=noise(2), long=noise(3), silent=noise(4))
    situations = [one.situation for one in sized_records(corpus)]
    assert {(one.load, one.load_deflection, one.exponent) for one in situations} == {(346.0, *factor)}
    assert {one.situation.load for one in without_load(sized_records(corpus))} == {None}
    assert "blind" not in size(corpus)[1]


def test_a_bearing_of_the_catalogue_has_its_hertz_factor(tmp_path: Path) -> None:
    corpus = imported(tmp_path, SPEC.replace("speed_rpm", "load_n = 200\nspeed_rpm"), noise=noise(2))
    (one,) = sized_records(corpus)
    assert one.situation.load_deflection == catalog.bearing("koyo_1205").load_deflection


def test_an_exponent_without_its_factor_is_refused(tmp_path: Path) -> None:
    (tmp_path / "states.csv").write_text(STATES)
    with pytest.raises(BadInput, match="an exponent needs its factor K"):
        imported(tmp_path, STATED % ", exponent = 1.4", none=noise(1))


def test_a_corpus_none_of_whose_records_could_be_made_says_so(tiny_corpus: Path, tmp_path: Path) -> None:
    shutil.copytree(tiny_corpus, tmp_path / "empty")
    index = tmp_path / "empty" / "index.csv"
    index.write_text(index.read_text().splitlines()[0] + "\n")
    code, _, message = size(tmp_path / "empty")
    assert code == 2
    assert message.endswith("empty: this corpus has no records\n")


def test_a_size_without_an_interval_is_shown_without_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "plain_sizes.py").write_text(
        "from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome\n"
        "def a_tenth(acceleration, rate, situation):\n"
        "    size = {'lag': 1e-3, 'lag_arc': 0.1, 'extent': 0.1, 'extent_mm': 2.5}\n"
        "    return SizeEstimate(SizeOutcome.ESTIMATED, 'constant', 'outer', trust=1.0, **size)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    corpus = imported(tmp_path, noise=noise(2))
    code, said, message = size(corpus, "--estimator", "plain_sizes:a_tenth")
    assert code == 0, message
    assert "│ 5.73 │ 2.5 │" in said  # degrees, mm
