"""One record beside its truth: what the plain rule is given of the race."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from datagen.sizing.comparison import CHANGING, score_record
from datagen.sizing.sized_records import SizedRecord
from datagen.sizing.stored_record import nominal_period
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome
from labels.spall_size.static_release import release_arc

RATE = 65536.0
LAG = 100.0 / RATE
MACHINE = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)
NAMES = ("recording", "channel", "bearing_id", "rig", "profile", "split")
CONSTANT = SizeEstimate(SizeOutcome.ESTIMATED, "constant", "inner", lag=LAG, lag_arc=0.1, extent=0.1, extent_mm=1.0)


class Says:
    """An estimator that gives a stated answer."""

    def __init__(self, answer: SizeEstimate) -> None:
        self.answer = answer

    def estimate(self, acceleration: np.ndarray, rate: float, situation: Situation) -> SizeEstimate:
        return self.answer


def record_at(location: str) -> SizedRecord:
    """Bursts of 6 kHz, two a pass of the inner race, LAG apart; the labels say `location`."""
    period = MACHINE.pass_periods()["inner"]
    time, signal = np.arange(32768) / RATE, np.zeros(32768)
    for start in np.arange(0.001, 0.49, period):
        for burst in (start, start + LAG):
            since = np.maximum(time - burst, 0.0)
            signal += np.exp(-since / 2e-4) * np.sin(2.0 * math.pi * 6000.0 * since)
    labels = dict.fromkeys(NAMES, "") | dict.fromkeys(("snr_db", "load_n", "extent_mm", "extent_spacing"), 1.0)
    labels |= {"record": 0, "location": location, "rate_hz": RATE, "extent": 0.1, "speed_rpm": 1800.0}
    labels |= {"bpfo": MACHINE.bearing().bpfo, "bpfi": MACHINE.bearing().bpfi}
    return SizedRecord(0, RATE, np.column_stack([signal, signal]), None, labels, MACHINE, None)


@pytest.mark.parametrize(
    ("estimate", "location", "race"),
    [
        (CONSTANT, "inner", "inner"),
        (CONSTANT, "outer", "inner"),  # as wrong as the estimate
        (SizeEstimate(SizeOutcome.NO_PASSES, ""), "inner", "inner"),
        (SizeEstimate(SizeOutcome.NO_PASSES, ""), "none", "outer"),
    ],
)
def test_the_plain_rule_divides_by_the_pass_of_the_race_that_was_estimated_or_else_of_the_true_one(
    estimate: SizeEstimate, location: str, race: str
) -> None:
    scored = score_record(record_at(location), Says(estimate))
    # A ball covers one spacing (30 degrees) of a race in a pass; a burst's peak lies within a few samples of its start.
    expected = math.radians(30.0) * LAG / MACHINE.pass_periods()[race]
    assert scored.envelope_arc == pytest.approx(expected, rel=0.05)


def test_event_times_that_equal_the_truth_match_every_event_and_shifted_ones_none() -> None:
    first = 0.01 * np.arange(1.0, 8.0)
    truth = EventTruth(first, first + LAG, np.zeros(7, dtype=np.bool_))
    sized = replace(record_at("inner"), truth=truth)
    times = np.column_stack([truth.first, truth.last])
    exact = score_record(sized, Says(replace(CONSTANT, event_times=times)))
    for scores in (exact.events_in_time, exact.events_in_arc):
        assert (scores.matched, scores.precision, scores.recall) == (14, 1.0, 1.0)  # two events of each of seven passes
    # LAG is 1.5 ms, far above both tolerances: entries found where the exits are, and exits elsewhere, match nothing.
    shifted = score_record(sized, Says(replace(CONSTANT, event_times=times + LAG)))
    assert (shifted.events_in_time.matched, shifted.events_in_arc.matched) == (0, 0)


def test_events_count_within_100_microseconds_and_within_half_a_degree() -> None:
    first = 0.01 * np.arange(1.0, 8.0)
    sized = replace(record_at("inner"), truth=EventTruth(first, first + LAG, np.zeros(7, dtype=np.bool_)))
    # A ball covers a spacing of 30 degrees in a pass.
    degree = MACHINE.pass_periods()["inner"] / 30.0
    for share, matched in ((0.9, 14), (1.1, 0)):
        for late, kind in ((share * 100e-6, "events_in_time"), (share * 0.5 * degree, "events_in_arc")):
            times = np.column_stack([first, first + LAG]) + late
            scored = score_record(sized, Says(replace(CONSTANT, event_times=times)))
            assert getattr(scored, kind).matched == matched


TOLD = SizeEstimate(
    SizeOutcome.ESTIMATED, "constant", "inner", lag=LAG, lag_interval=(1.1e-3, 1.9e-3), lag_arc=0.11, extent=0.2,
    extent_interval=(0.15, 0.3), extent_mm=2.5, extent_mm_interval=(2.0, 3.5), candidates=(0.2, 0.7), trust=0.8,
    event_times=np.array([[0.1, 0.2]]),
)  # fmt: skip


def test_truth_and_answer_have_each_number_from_its_own() -> None:
    sized = record_at("inner")
    own = {name: float(place) for place, name in enumerate(("snr_db", "load_n", "extent_mm", "extent_spacing"), 3)}
    labels = sized.labels | {name: f"the {name}" for name in NAMES} | own | {"record": 17, "extent": 0.25}
    scored = score_record(replace(sized, labels=labels), Says(TOLD))
    renamed = {"race": "location", "rate": "rate_hz"}
    for name in ("record", *NAMES, *own, "extent", "speed_rpm", "race", "rate"):
        assert getattr(scored.truth, name) == labels[renamed.get(name, name)]
    assert scored.truth.pass_period == pytest.approx(1.0 / (30.0 * MACHINE.bearing().bpfi))
    assert (scored.truth.known, math.isnan(scored.truth.lag)) == (False, True)
    told = "method race trust lag lag_interval lag_arc extent extent_interval extent_mm extent_mm_interval candidates"
    for name in told.split():
        assert getattr(scored.answer, name) == getattr(TOLD, name)
    assert (scored.answer.outcome, scored.answer.reason, scored.answer.known_size_factor) == ("estimated", "", 1.0)
    assert scored.answer.candidates_mm == pytest.approx((2.5, 8.75))  # 12.5 mm for a rad
    assert scored.answer.event_times.tolist() == [[0.1, 0.2]]


def test_the_lag_of_a_known_truth_is_told() -> None:
    first = 0.01 * np.arange(1.0, 8.0)
    truth = EventTruth(first, first + LAG, np.zeros(7, dtype=np.bool_))
    scored = score_record(replace(record_at("inner"), truth=truth), Says(TOLD))
    assert scored.truth.known
    assert scored.truth.lag == pytest.approx(LAG, rel=1e-9)


def test_the_static_rule_adds_two_release_arcs_to_the_arc_between_the_events_where_the_load_is_known() -> None:
    loaded = replace(MACHINE, load=346.0, load_deflection=6e9)
    arc = 0.11 + 2.0 * release_arc(loaded.bearing(), "inner", 346.0)
    for situation in (loaded, loaded.without_load(), replace(MACHINE, load=346.0)):  # the last without a Hertz factor
        scored = score_record(replace(record_at("inner"), situation=situation), Says(TOLD))
        assert scored.answer.load_known == (situation is loaded)
        assert scored.static_arc == pytest.approx(arc if situation is loaded else math.nan, rel=1e-12, nan_ok=True)


def test_a_known_size_changes_what_was_found_and_nothing_else() -> None:
    found = score_record(record_at("inner"), Says(TOLD), 1.05)
    assert (found.answer.extent, found.answer.lag) == (pytest.approx(0.21), LAG)
    assert found.answer.known_size_factor == 1.05
    silent = SizeEstimate(SizeOutcome.NO_PASSES, "constant")
    nothing = score_record(record_at("inner"), Says(silent), 1.05)
    assert (nothing.answer.method, nothing.answer.known_size_factor) == ("constant", 1.0)
    assert (nothing.answer.outcome, nothing.answer.reason) == ("no_passes", SizeOutcome.NO_PASSES.value)
    assert math.isnan(nothing.static_arc)


def test_the_time_told_is_that_of_the_estimate_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter((5.0, 7.5))
    monkeypatch.setattr("datagen.sizing.comparison.time.process_time", lambda: next(clock))
    assert score_record(record_at("inner"), Says(TOLD)).answer.seconds == 2.5


@pytest.mark.parametrize(("estimate", "told"), [(TOLD, ""), (SizeEstimate(SizeOutcome.NO_PASSES, ""), CHANGING)])
def test_a_changing_speed_is_a_reason_only_where_there_is_no_size(estimate: SizeEstimate, told: str) -> None:
    scored = score_record(replace(record_at("inner"), speed_changes=True), Says(estimate))
    assert scored.answer.reason == estimate.reason + told


@pytest.mark.parametrize(("location", "order"), [("outer", "bpfo"), ("inner", "bpfi"), ("none", "bpfo")])
def test_the_nominal_period_is_that_of_the_balls_over_the_race_of_the_spall(location: str, order: str) -> None:
    labels = {"location": location, "speed_rpm": 1800.0, "bpfo": 4.9, "bpfi": 7.1}
    # 30 turns a second
    assert nominal_period(labels) == pytest.approx(1.0 / (30.0 * {"bpfo": 4.9, "bpfi": 7.1}[order]))
