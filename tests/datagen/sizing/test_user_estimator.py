"""What a user's estimator raises or gives instead of an estimate: one message with its name, what came, what is due."""

from __future__ import annotations

import math
import os
import sys
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_line import run
from joblib.externals.loky import get_reusable_executor

from datagen.errors import BadInput
from datagen.sizing.comparison import score_record
from datagen.sizing.corpus_run import score_sizes
from datagen.sizing.estimators import find_estimator
from datagen.sizing.size_request import SizeRequest
from datagen.sizing.sized_records import SizedRecord, sized_records
from datagen.sizing.user_estimator import ESTIMATOR_FORMS, UserEstimator
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome

GOOD = SizeEstimate(SizeOutcome.ESTIMATED, "constant", "outer", lag=1e-3, lag_arc=0.1, extent=0.1, extent_mm=1.0)
MACHINE = Situation(12, 2, 38.75e-3, 7.12e-3, 100.0)
WRONG = {
    "None and no SizeEstimate": None,
    "float 3.0 and no SizeEstimate": 3.0,
    "dict {'extent': 0.1} and no SizeEstimate": {"extent": 0.1},
    "whose outcome is str 'estimated' and no SizeOutcome": replace(GOOD, outcome="estimated"),
    "whose extent is str '0.1' and no number": replace(GOOD, extent="0.1"),
    "whose lag is an array of shape (2,) and no number": replace(GOOD, lag=np.zeros(2)),
    "whose extent_interval is float 0.2 and no pair of numbers": replace(GOOD, extent_interval=0.2),
    "whose lag_interval is tuple (1, 2, 3) and no pair of numbers": replace(GOOD, lag_interval=(1, 2, 3)),
    "ESTIMATED, whose race is str 'middle' and not outer or inner": replace(GOOD, race="middle"),
    "ESTIMATED, whose extent is -1 rad and not above 0": replace(GOOD, extent=-1.0),
    "ESTIMATED, whose extent is nan rad and not above 0": replace(GOOD, extent=math.nan),
    "ESTIMATED, whose extent is 100 rad and not above 0 and pi at most": replace(GOOD, extent=100.0),
    "ESTIMATED, whose extent_mm is inf and not above 0": replace(GOOD, extent_mm=math.inf),
    "ESTIMATED, whose trust is 7 and not between 0 and 1": replace(GOOD, trust=7.0),
    "ESTIMATED, whose lag is -0.001 s and not above 0": replace(GOOD, lag=-1e-3),
    "ESTIMATED, whose candidates are tuple (0.1, nan) and not all above 0": replace(GOOD, candidates=(0.1, math.nan)),
    "NO_PASSES, whose extent is 0.1 rad and not nan": SizeEstimate(SizeOutcome.NO_PASSES, "constant", extent=0.1),
    "NO_PASSES, whose trust is 7 and not between 0 and 1": SizeEstimate(SizeOutcome.NO_PASSES, "constant", trust=7.0),
    "whose candidates are None and not numbers": replace(GOOD, candidates=None),
    "whose event_times are an array of shape (3,) and no array of numbers (K, 2)": replace(
        GOOD, event_times=np.zeros(3)
    ),
}


class Saying:
    """An estimator that says always the same."""

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def estimate(self, acceleration: np.ndarray, rate: float, situation: Situation) -> Any:
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


def asked(answer: Any) -> SizeEstimate:
    estimator = UserEstimator("mine:Sizer", Saying(answer))
    return estimator.estimate(np.zeros((4, 2)), 1000.0, None)  # type: ignore[arg-type]


def test_an_estimator_that_changes_its_record_changes_a_copy() -> None:
    def silences(acceleration: np.ndarray, rate: float, situation: Situation) -> SizeEstimate:
        acceleration[:] = 0.0
        return GOOD

    record = np.ones((16, 2))
    assert UserEstimator("mine:silences", silences).estimate(record, 1000.0, MACHINE) is GOOD
    assert (record == 1.0).all()


@pytest.mark.parametrize("problem", WRONG)
def test_what_is_no_estimate_is_named_with_what_is_due(problem: str) -> None:
    with pytest.raises(BadInput) as refused:
        asked(WRONG[problem])
    message = str(refused.value)
    assert message.startswith('--estimator = "mine:Sizer": its method estimate gave ')
    assert problem in message
    assert message.endswith(f"allowed: {ESTIMATOR_FORMS}")


def test_estimates_and_refusals_of_one_pass() -> None:
    silent = SizeEstimate(SizeOutcome.NO_PASSES, "constant")
    whole = replace(GOOD, extent=np.float32(0.1), candidates=np.array([0.1, 0.2]), lag_interval=[1, math.inf])
    assert [asked(one) for one in (GOOD, silent, whole)] == [GOOD, silent, whole]


def test_an_estimate_of_the_least_that_is_required_is_scored_where_the_load_is_known() -> None:
    least = SizeEstimate(SizeOutcome.ESTIMATED, "constant", extent=0.1, extent_mm=1.0)
    labels = dict.fromkeys(("recording", "channel", "bearing_id", "rig", "profile", "split"), "word") | {
        "record": 3, "location": "outer", "rate_hz": 1000.0, "extent": 0.1, "snr_db": math.nan, "speed_rpm": 900.0,
        "load_n": 500.0, "extent_mm": 1.0, "extent_spacing": 0.2, "bpfo": 5.0,
    }  # fmt: skip
    loaded = replace(MACHINE, load=500.0, load_deflection=1e10)
    record = SizedRecord(3, 1000.0, np.zeros((400, 2)), None, labels, loaded, None)
    row = score_record(record, UserEstimator("mine:Sizer", Saying(least)))
    assert (row.answer.extent, row.answer.race) == (0.1, "")
    assert math.isnan(row.static_arc)


def test_what_it_raises_is_named_with_its_line() -> None:
    with pytest.raises(BadInput, match=r"its method estimate fails: ZeroDivisionError: no load \(.*, line \d+\)"):
        asked(ZeroDivisionError("no load"))


def test_a_function_is_asked_like_a_method(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "own_functions.py").write_text(
        "from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome\n"
        "def one_degree(acceleration, rate, situation):\n"
        "    return SizeEstimate(SizeOutcome.ESTIMATED, f'{acceleration.shape[1]} axes', extent=0.017, extent_mm=0.3)\n"
        "def seven(acceleration, rate, situation):\n"
        "    return 7\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    estimate = find_estimator("own_functions:one_degree").estimate(np.zeros((4, 2)), 1000.0, MACHINE)
    assert (estimate.extent, estimate.method) == (0.017, "2 axes")
    with pytest.raises(BadInput, match='"own_functions:seven": it gave int 7 and no SizeEstimate; allowed: module:Cl'):
        find_estimator("own_functions:seven").estimate(np.zeros((4, 2)), 1000.0, MACHINE)


@pytest.fixture
def new_workers() -> None:
    """Worker processes that an earlier test has left end: new ones import from what the test puts on PYTHONPATH."""
    get_reusable_executor().shutdown(wait=True)


@pytest.mark.usefixtures("new_workers")
@pytest.mark.parametrize("workers", [1, 2])
def test_the_command_ends_with_2_and_writes_nothing(
    workers: int, tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "class Sizer:\n    def estimate(self, acceleration, rate, situation):\n        return 7\n"
    (tmp_path / "seven.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{':'.join(sys.path)}")  # for the worker processes
    out = tmp_path / "out"
    command = ["size", tiny_corpus, "--split", "all", "--estimator", "seven:Sizer", "--out", out, "--workers", workers]
    done = run(*command)
    assert done.exit_code == 2
    assert done.stderr.startswith('error: --estimator = "seven:Sizer": its method estimate gave int 7')
    assert not out.exists()


@pytest.mark.usefixtures("new_workers")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_class_is_made_once_in_every_process(
    workers: int, tiny_corpus: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = f"counted_in_{workers}"
    (tmp_path / f"{name}.py").write_text(
        "import os\n"
        "from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome\n"
        "def note(what):\n"
        f"    with open({str(tmp_path / 'notes')!r}, 'a') as notes:\n"
        "        notes.write(f'{what} {os.getpid()}\\n')\n"
        "class Counted:\n"
        "    def __init__(self):\n"
        "        note('made')\n"
        "    def estimate(self, acceleration, rate, situation):\n"
        "        note('asked')\n"
        "        return SizeEstimate(SizeOutcome.NO_PASSES, 'none')\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{':'.join(sys.path)}")  # for the worker processes
    scores = score_sizes(SizeRequest(tiny_corpus, f"{name}:Counted", split="all"), workers)
    notes = [line.split() for line in (tmp_path / "notes").read_text().splitlines()]
    made = [process for what, process in notes if what == "made"]
    asked = [process for what, process in notes if what == "asked"]
    assert len(asked) == len(scores.records) == 14
    assert len(made) == len(set(made))
    assert set(made) == {str(os.getpid()), *asked}  # the command makes one of its own, to see that it can be made


def test_records_are_read_by_the_calling_thread_alone(tiny_corpus: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    readers = []

    def watched(*places: Any, **options: Any) -> Iterator[SizedRecord]:
        for one in sized_records(*places, **options):
            readers.append(threading.current_thread())
            yield one

    monkeypatch.setattr("datagen.sizing.corpus_run.sized_records", watched)
    scores = score_sizes(SizeRequest(tiny_corpus, split="all"), workers=2)
    assert len(readers) == len(scores.records) == 14
    assert set(readers) == {threading.current_thread()}


@pytest.mark.parametrize("workers", [1, 2])
def test_every_record_is_counted_as_it_is_done(tiny_corpus: Path, workers: int) -> None:
    counts: list[tuple[int, int]] = []
    scores = score_sizes(SizeRequest(tiny_corpus, split="all"), workers, lambda *reached: counts.append(reached))
    assert counts == [(done, len(scores.records)) for done in range(1, 15)]
