"""One record beside its truth: what the plain rule is given of the race."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from datagen.sizing.comparison import score_record
from datagen.sizing.sized_records import SizedRecord
from datagen.sizing.stored_record import nominal_period
from labels.spall_size.event_truth import EventTruth
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome

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


@pytest.mark.parametrize(("location", "order"), [("outer", "bpfo"), ("inner", "bpfi"), ("none", "bpfo")])
def test_the_nominal_period_is_that_of_the_balls_over_the_race_of_the_spall(location: str, order: str) -> None:
    labels = {"location": location, "speed_rpm": 1800.0, "bpfo": 4.9, "bpfi": 7.1}
    # 30 turns a second
    assert nominal_period(labels) == pytest.approx(1.0 / (30.0 * {"bpfo": 4.9, "bpfi": 7.1}[order]))
