"""What the estimator tells of the pair of events that it found."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from labels.spall_size.columns.table import PAIR_COLUMNS
from labels.spall_size.estimation.calibration import SMALLEST_SPREAD, Calibration, Guess, Judgement
from labels.spall_size.estimation.estimator import ONSET, SizeEstimator
from labels.spall_size.events.evidence import Evidence
from labels.spall_size.events.pairs import Pairs
from labels.spall_size.signal.alignment import Alignment
from labels.spall_size.signal.mean_pass import MeanPass
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeEstimate, SizeOutcome
from physics.checks import InvalidParameter

GEARBOX = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)
RATE, PERIOD = 1000.0, 100.0


@pytest.fixture
def judging(saying):
    """A maker of estimators that expect the same doubt and correct by the same factors whatever they see; every lag
    gets an interval of a factor of 1.5, every arc one of 1.25."""

    def make(doubt, lag_factor, arc_factor):
        lag, arc = (
            Guess(saying(math.log(factor)), saying(math.log(spread) - SMALLEST_SPREAD), 1.0)
            for factor, spread in ((lag_factor, 1.5), (arc_factor, 1.25))
        )
        judgement = Judgement(saying(0.5), lag, arc, saying(doubt), 0.4)
        return SizeEstimator(Calibration(saying(0.5), judgement, judgement))

    return make


def one_pair(entry, lag, race="outer"):
    """Evidence of a single pair of events on an even mean pass, heard in two of three passes."""
    offset = np.arange(-110, 111)
    flat = np.zeros(offset.size)
    mean = MeanPass(offset, np.ones((4, offset.size)), flat, flat, 1.0, flat, 1.0, 3.0, PERIOD)
    pairs = Pairs(np.array([entry]), np.array([entry + lag]), np.array([lag]), np.zeros((1, len(PAIR_COLUMNS))))
    place = np.array([200.0, 300.0, 400.0])
    return Evidence(race, RATE, 1.0, 1.0, Alignment(place, np.array([1.0, 0.0, 0.5])), mean, pairs)


def test_no_lag_is_longer_than_a_pass_and_no_spall_than_half_the_race(judging):
    estimate = judging(0.1, 1.2, 10.0).judge(one_pair(0.0, 95.0), GEARBOX)
    assert estimate.outcome is SizeOutcome.ESTIMATED
    assert estimate.lag == pytest.approx(0.1)  # 95 samples times 1.2 are more than a pass of 100
    assert estimate.lag_interval == pytest.approx((0.1 / 1.5, 0.15))
    assert estimate.extent == pytest.approx(math.pi)
    assert estimate.candidates == pytest.approx((math.pi,))


@pytest.mark.parametrize(("race", "diameter_mm"), [("outer", 38.75 + 7.12), ("inner", 38.75 - 7.12)])
def test_a_size_is_told_along_its_race_with_its_own_interval(judging, race, diameter_mm):
    estimate = judging(0.1, 1.0, 1.0).judge(one_pair(0.0, 20.0, race), GEARBOX)
    length = math.radians(0.2 * 30.0) * diameter_mm / 2.0
    assert estimate.extent_mm == pytest.approx(length)
    assert estimate.extent_mm_interval == pytest.approx((length / 1.25, length * 1.25))
    assert (estimate.race, estimate.pass_period) == (race, pytest.approx(0.1))
    # 6, 36, … 156 degrees: as many as are no longer than half the race.
    assert np.degrees(estimate.candidates) == pytest.approx(np.arange(6.0, 180.0, 30.0))


def passes_of_noise(passes, race, samples_a_pass):
    """Noise of so many nominal passes over a race, sampled so often, and its rate."""
    noise = np.random.default_rng(0).standard_normal(round(passes * samples_a_pass))
    return noise, samples_a_pass / GEARBOX.pass_periods()[race]


@pytest.mark.parametrize(
    ("passes", "samples_a_pass", "refused"),
    [(5.9, 40.0, SizeOutcome.TOO_SHORT), (6.0, 40.0, None), (50.0, 15.9, SizeOutcome.TOO_COARSE), (50.0, 16.1, None)],
)
def test_six_passes_of_sixteen_samples_over_the_race_that_balls_pass_faster_are_enough(
    judging, passes, samples_a_pass, refused
):
    outcome = judging(0.1, 1.0, 1.0).estimate(*passes_of_noise(passes, "inner", samples_a_pass), GEARBOX).outcome
    assert outcome is refused if refused else outcome not in (SizeOutcome.TOO_SHORT, SizeOutcome.TOO_COARSE)


@pytest.mark.parametrize("signal", [np.zeros(5000), np.full((5000, 2), np.nan)])
def test_without_a_signal_there_is_no_size(judging, signal):
    assert judging(0.1, 1.0, 1.0).estimate(signal, 1e4, GEARBOX).outcome is SizeOutcome.NO_SIGNAL


def test_lag_and_arc_are_corrected_each_by_its_own_factor(judging):
    estimate = judging(0.1, 1.1, 1.5).judge(one_pair(0.0, 20.0), GEARBOX)
    assert estimate.lag == pytest.approx(0.022)
    assert estimate.lag_arc == pytest.approx(math.radians(0.22 * 30.0))
    assert estimate.extent == pytest.approx(math.radians(0.2 * 30.0 * 1.5))
    assert estimate.extent_interval == pytest.approx((estimate.extent / 1.25, estimate.extent * 1.25))
    assert estimate.trust == pytest.approx(0.9)
    assert estimate.candidates[:2] == pytest.approx((estimate.extent, estimate.extent + math.radians(30.0)))


@pytest.mark.parametrize(("entry", "first"), [(0.0, 0.0), (-20.0, -22.0)])
def test_the_event_that_is_the_anchor_stays_where_it_was_found(judging, entry, first):
    estimate = judging(0.1, 1.1, 1.0).judge(one_pair(entry, 20.0), GEARBOX)
    heard = np.array([200.0, 400.0])  # a pass without weight is not heard
    assert estimate.event_times[:, 0] == pytest.approx((heard + first - ONSET) / RATE)
    assert estimate.event_times[:, 1] - estimate.event_times[:, 0] == pytest.approx(0.022)


def test_above_the_most_doubt_nothing_is_told(judging):
    estimate = judging(0.41, 1.0, 1.0).judge(one_pair(0.0, 20.0), GEARBOX)
    assert estimate.outcome is SizeOutcome.NO_EVENT_PAIR
    assert (estimate.trust, math.isnan(estimate.extent)) == (pytest.approx(0.59), True)
    assert estimate.race == "outer"
    assert judging(0.4, 1.0, 1.0).judge(one_pair(0.0, 20.0), GEARBOX).found
    trust = [judging(doubt, 1.0, 1.0).judge(one_pair(0.0, 20.0), GEARBOX).trust for doubt in (-0.1, 3.0)]
    assert trust == [1.0, 0.0]


def test_load_and_hertz_factor_ask_for_their_own_judgement(judging, saying):
    made = judging(0.1, 1.0, 1.0)
    blind = replace(made.calibration.blind, doubt=saying(0.9))
    estimator = SizeEstimator(replace(made.calibration, blind=blind))
    assert not estimator.judge(one_pair(0.0, 20.0), GEARBOX).found
    assert estimator.judge(one_pair(0.0, 20.0), replace(GEARBOX, load=100.0, load_deflection=1e10)).found


@pytest.mark.parametrize("rate", [0.0, -1.0, math.nan, math.inf])
@pytest.mark.parametrize("polarity_known", [True, False])
def test_a_rate_that_is_none_is_refused(judging, rate, polarity_known):
    noise, situation = np.random.default_rng(0).standard_normal(1000), replace(GEARBOX, polarity_known=polarity_known)
    with pytest.raises(InvalidParameter, match="rate"):
        judging(0.1, 1.0, 1.0).estimate(noise, rate, situation)


HEAR = "labels.spall_size.estimation.estimator.hear"


@pytest.mark.parametrize(("known", "signs", "trust"), [(True, [1.0], 0.3), (False, [1.0, -1.0], 0.7)])
def test_both_polarities_are_tried_where_it_is_unknown_and_the_more_trusted_counts(
    judging, monkeypatch, known, signs, trust
):
    asked = []

    def evidence(sign):
        asked.append(sign)
        return {1.0: 0.3, -1.0: 0.7}[sign]

    def judged(self, found, situation):
        return SizeEstimate(SizeOutcome.NO_EVENT_PAIR, "", trust=found)

    monkeypatch.setattr(HEAR, lambda *_: SimpleNamespace(evidence=evidence))
    monkeypatch.setattr(SizeEstimator, "judge", judged)
    noise, rate = passes_of_noise(20, "inner", 40.0)
    found = judging(0.1, 1.0, 1.0).estimate(noise, rate, replace(GEARBOX, polarity_known=known))
    assert (found.trust, asked) == (trust, signs)


@pytest.mark.parametrize("heard", [None, SimpleNamespace(evidence=lambda sign: None)])
def test_without_passes_or_events_there_are_no_passes(judging, monkeypatch, heard):
    monkeypatch.setattr(HEAR, lambda *_: heard)
    found = judging(0.1, 1.0, 1.0).estimate(*passes_of_noise(20, "inner", 40.0), GEARBOX)
    assert found.outcome is SizeOutcome.NO_PASSES


@pytest.mark.parametrize("doubt", [0.1, 0.9])
def test_the_method_says_whether_the_load_was_known(judging, doubt):
    estimator, evidence = judging(doubt, 1.0, 1.0), one_pair(0.0, 20.0)
    loaded = replace(GEARBOX, load=100.0, load_deflection=1e10)
    assert estimator.judge(evidence, loaded).method == "event pair, shortening from load and Hertz factor"
    assert estimator.judge(evidence, GEARBOX).method == "event pair, prior shortening"


def test_passes_that_are_hardly_heard_have_no_event_times(judging):
    lined_up = Alignment(np.array([200.0, 300.0, 400.0]), np.array([1.0, 0.019, 0.021]))
    found = judging(0.1, 1.0, 1.0).judge(replace(one_pair(0.0, 20.0), alignment=lined_up), GEARBOX)
    assert found.event_times[:, 0] == pytest.approx((np.array([200.0, 400.0]) - ONSET) / RATE)


def test_the_arc_of_the_lag_is_its_share_of_the_mean_pass(judging):
    assert judging(0.1, 1.0, 1.0).judge(one_pair(0.0, 20.0), GEARBOX).lag_arc == pytest.approx(math.radians(0.2 * 30.0))


@pytest.mark.parametrize(
    ("passes", "samples_a_pass", "outcome"),
    [(5.9, 40.0, SizeOutcome.TOO_SHORT), (50.0, 15.9, SizeOutcome.TOO_COARSE), (0.0, 40.0, SizeOutcome.NO_SIGNAL)],
)
def test_the_method_is_told_where_no_size_is(judging, passes, samples_a_pass, outcome):
    noise, rate = passes_of_noise(passes or 50.0, "inner", samples_a_pass)
    loaded = replace(GEARBOX, load=100.0, load_deflection=1e10)
    for situation, method in ((GEARBOX, "prior shortening"), (loaded, "shortening from load and Hertz factor")):
        found = judging(0.1, 1.0, 1.0).estimate(noise if passes else 0.0 * noise, rate, situation)
        assert (found.outcome, found.method) == (outcome, f"event pair, {method}")


def test_an_event_lies_1_8_samples_before_the_peak_of_its_energy(judging):
    found = judging(0.1, 1.0, 1.0).judge(one_pair(0.0, 20.0), GEARBOX)
    assert found.event_times[:, 0] * RATE == pytest.approx([198.2, 398.2])


def test_a_signal_in_single_precision_is_judged_as_in_double(judging, pulse_train):
    signal = pulse_train(60.0 / 65536.0, GEARBOX.pass_periods()["outer"], duration=0.15).signal.astype(np.float32)
    estimator = judging(0.1, 1.0, 1.0)
    single, double = (estimator.estimate(signal.astype(kind), 65536.0, GEARBOX) for kind in (np.float32, np.float64))
    assert single.found
    assert np.array_equal(single.event_times, double.event_times)
    assert single.lag == double.lag
