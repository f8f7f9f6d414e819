"""`--known-size`: a record whose spall was measured corrects the other records of its machine."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_line import run

from datagen.errors import BadInput
from datagen.recordings.importing import import_recordings
from datagen.recordings.spec import load_spec
from datagen.sizing.corpus_run import score_sizes
from datagen.sizing.known_sizes import (
    KnownSize,
    factor_for,
    machine_of,
    parse_known_sizes,
    shared_factors,
    with_effect,
)
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_request import SizeRequest
from labels.spall_size.known_size import known_size_factor
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome

SPEC = """
name = "mine"
[defaults]
unit = "m/s2"
rate_hz = 20000
bearing = "koyo_1205"
[[recording]]
name = "all"
files = "*.npy"
y = "data"
table = "t.csv"
"""
TABLE = """file,speed_rpm,bearing_id,rig
a.npy,1200,one,r
b.npy,1200,one,r
c.npy,1200,one,r
d.npy,1200,two,r
e.npy,0,two,r
f.npy,1200,,
g.npy,1200,,r
h.npy,1200,,r
"""


class Tells:
    """2 mm for every record that is not silent."""

    def estimate(self, acceleration: np.ndarray, rate: float, situation: Situation) -> SizeEstimate:
        if np.abs(acceleration).max() < 1e-9:
            return SizeEstimate(SizeOutcome.NO_PASSES, "constant")
        return SizeEstimate(SizeOutcome.ESTIMATED, "constant", "inner", extent=0.1, extent_interval=(0.08, 0.12),
                            extent_mm=2.0, extent_mm_interval=(1.6, 2.4), candidates=(0.1, 0.6))  # fmt: skip


@pytest.fixture
def corpus(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Recordings a to h, that is records 0 to 7; c is silence."""
    for k, name in enumerate("abcdefgh"):
        signal = np.random.default_rng(k).standard_normal(4000)
        np.save(tmp_path / f"{name}.npy", 1e-12 * signal if name == "c" else signal)
    (tmp_path / "t.csv").write_text(TABLE)
    (tmp_path / "spec.toml").write_text(SPEC)
    import_recordings(load_spec(tmp_path / "spec.toml"), tmp_path / "corpus")
    monkeypatch.setattr("datagen.sizing.corpus_run.find_estimator", lambda _: Tells())
    return tmp_path / "corpus"


def size(*arguments: object) -> tuple[int, str, str]:
    return run("size", *arguments)


def test_the_other_records_of_the_machine_are_corrected_and_no_others(corpus: Path, tmp_path: Path) -> None:
    code, said, _ = size(corpus, "--known-size", "0=2.5", "--json", tmp_path / "s.json")
    assert code == 0
    factor = known_size_factor(2.0, 2.5)
    assert factor > 1.0
    result = json.loads((tmp_path / "s.json").read_text())
    sizes = {row["record"]: row["estimated_mm"] for row in result["records"]}
    assert sizes[1] == pytest.approx(2.0 * factor, rel=1e-12)
    assert [sizes[k] for k in (0, 3, 5, 6, 7)] == [2.0] * 5  # itself, another bearing, unknown ones
    assert [row["known_size_factor"] for row in result["records"]][:3] == [1.0, factor, 1.0]
    assert "known size of another record" in result["records"][1]["method"]
    (known,) = result["known_sizes"]
    assert (known["record"], known["machine"], known["corrected"]) == (0, "one", 1)
    assert (known["known_mm"], known["estimated_mm"], known["factor"]) == (2.5, 2.0, factor)
    assert known["arc_error_with"] is None
    assert "changes the sizes of 1 other record of one by +0.25 %" in said


def test_without_a_known_bearing_the_rig_is_the_machine(corpus: Path) -> None:
    scores = score_sizes(SizeRequest(corpus, split="all", sizes={6: 1.0}))
    factor = known_size_factor(2.0, 1.0)
    each = {one.truth.record: one.answer.known_size_factor for one in scores.records}
    factors = {record: own for record, own in each.items() if own != 1.0}
    assert factors == {7: factor}
    assert machine_of("unknown", "unknown") == machine_of("", "") == ""


def test_known_sizes_of_a_machine_count_by_their_geometric_mean() -> None:
    known = KnownSize(0, "one", 2.5, 2.0, 1.002)
    shared = shared_factors([known, replace(known, record=1, factor=0.999), replace(known, record=2, machine="two")])
    mean = math.sqrt(1.002 * 0.999)
    assert [one.factor for one in shared] == pytest.approx([mean, mean, 1.002], rel=1e-12)
    assert [factor_for(shared, *who) for who in ((9, "one"), (0, "one"), (9, "three"), (9, ""))] == [
        shared[0].factor,
        1,
        1,
        1,
    ]
    three = shared_factors(
        [replace(known, record=record, factor=factor) for record, factor in enumerate((1.0, 1.0, 8.0))]
    )
    assert [one.factor for one in three] == pytest.approx([2.0, 2.0, 2.0], rel=1e-12)


def test_the_effect_of_a_known_size_is_the_error_of_the_others_of_its_machine_without_and_with_it(
    scored: Callable[..., ScoredRecord],
) -> None:
    corrected = {"known_size_factor": 1.05}
    records = [
        scored({"record": 0, "bearing_id": "one"}),
        scored({"record": 1, "bearing_id": "one"}, corrected | {"extent": 0.105}),  # was exact
        scored({"record": 2, "bearing_id": "one"}, corrected | {"extent": 0.0945}),  # was a tenth too small
        scored({"record": 3, "bearing_id": "one", "known": False}, corrected),  # of unknown truth
        scored({"record": 4, "bearing_id": "one"}, corrected | {"extent": math.nan}),  # without an estimate
        scored({"record": 5, "bearing_id": "two"}),
        # In which a whole ball spacing may hide: such are not scored.
        scored({"record": 6, "bearing_id": "one", "extent_spacing": 1.4}, corrected | {"extent": 0.2}),
    ]
    (effect,) = with_effect([KnownSize(0, "one", 2.1, 2.0, 1.05)], records)
    assert effect.corrected == 4
    assert effect.arc_error_without == pytest.approx((0.0 + 0.1) / 2, abs=1e-12)  # rounding
    assert effect.arc_error_with == pytest.approx((0.05 + 0.055) / 2, abs=1e-12)


@pytest.mark.parametrize("text", ["0", "0=", "=2", "a=2", "0=x", "0=-1", "0=0", "0=nan", "0=inf", "-1=2", "0.5=1"])
def test_a_text_that_is_no_known_size_is_refused(text: str, corpus: Path) -> None:
    code, said, complaint = size(corpus, f"--known-size={text}")
    assert (code, said, complaint.count("\n")) == (2, "", 1)
    assert text in complaint
    assert "RECORD=MM" in complaint


@pytest.mark.parametrize(
    ("record", "words"),
    [
        (8, "allowed: 0 to 7"),
        (2, "it gets no estimate: no ball passes stand out"),
        (4, "it gets no estimate: the machine stood still"),
        (5, "its machine is not known"),
    ],
)
def test_a_record_that_can_teach_nothing_is_refused_in_words(record: int, words: str, corpus: Path) -> None:
    code, said, complaint = size(corpus, "--known-size", f"{record}=1")
    assert (code, said, complaint.count("\n")) == (2, "", 1)
    assert words in complaint
    assert f"--known-size: record = {record}" in complaint


@pytest.mark.parametrize("text", ["1_0=2", "3=1_5", "3=nan", "-3=1", "3"])
def test_a_size_that_is_none_is_refused(text: str) -> None:
    with pytest.raises(BadInput, match="allowed: RECORD=MM"):
        parse_known_sizes([text])


def test_a_record_has_one_size() -> None:
    assert parse_known_sizes(["3=1.5", "4=2"]) == {3: 1.5, 4: 2.0}
    with pytest.raises(BadInput, match="already"):
        parse_known_sizes(["3=1.5", "3=1.6"])
