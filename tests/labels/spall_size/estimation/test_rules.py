import math
from dataclasses import replace

import numpy as np
import pytest

from labels.spall_size.estimation.rules import EnvelopeLagRule, envelope_lag
from labels.spall_size.situation import Situation
from labels.spall_size.size_estimate import SizeOutcome
from physics.checks import InvalidParameter

RATE = 65536.0
GEARBOX = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)


def test_the_envelope_lag_of_two_bursts_a_pass_is_their_distance(pulse_train):
    train = pulse_train(150.0 / RATE, 0.011)
    # A burst of a 6 kHz resonator lasts about 90 samples, its envelope's peak lies within a few of its start.
    assert envelope_lag(train.signal, RATE, 0.45 * 0.011) * RATE == pytest.approx(150.0, abs=5.0)


def test_a_constant_signal_has_no_envelope_lag():
    assert math.isnan(envelope_lag(np.zeros(5000), RATE, 0.01))


def test_neither_an_offset_nor_what_lies_at_the_ends_makes_a_lag(pulse_train):
    signal = pulse_train(150.0 / RATE, 0.011, duration=0.3).signal
    shifted = 5.0 * signal.std() + signal
    assert envelope_lag(shifted, RATE, 0.45 * 0.011) == envelope_lag(signal, RATE, 0.45 * 0.011)
    time = np.arange(6000.0)  # round the ends the bursts would lie 150 samples apart
    ends = np.cos(1.3 * time) * sum(np.exp(-(((time - place) / 8.0) ** 2)) for place in (50, 5900))
    assert not abs(envelope_lag(ends, 1.0, 400.0) - 150.0) < 3.0


def test_a_pass_later_is_no_lag(pulse_train):
    train = pulse_train(100.0 / RATE, GEARBOX.pass_periods()["outer"], slip=0.0, exit_size=0.0)
    estimate = EnvelopeLagRule().estimate(train.signal, RATE, replace(GEARBOX, race="outer"))
    assert not estimate.lag > 0.95 * train.period


def test_no_spall_is_longer_than_half_the_race(pulse_train):
    train = pulse_train(100.0 / RATE, GEARBOX.pass_periods()["outer"])
    estimate = EnvelopeLagRule(1e3).estimate(train.signal, RATE, GEARBOX)
    assert (estimate.extent, estimate.candidates) == (math.pi, (math.pi,))


@pytest.mark.parametrize(("middle", "lag"), [(0.55, 100), (0.45, 300)])
def test_the_first_peak_counts_that_is_half_as_marked_as_the_highest(middle, lag):
    # Bursts of energy 1, `middle` and 1: their squared envelope repeats by `middle` after 100 and 200, by 1 after 300.
    time = np.arange(6000.0)
    bursts = [math.sqrt(size) * np.exp(-(((time - place) / 8.0) ** 2)) for place, size in ((2000, 1.0), (2300, 1.0))]
    bursts.append(math.sqrt(middle) * np.exp(-(((time - 2100) / 8.0) ** 2)))
    assert envelope_lag(np.cos(1.3 * time) * sum(bursts), 1.0, 400.0) == lag


@pytest.mark.parametrize(("beat", "lag"), [(3.0, 3), (9.0 / 4.0, 7)])
def test_a_lag_of_three_samples_is_the_shortest(beat, lag):
    # Two tones beat; a beat of 9/4 samples nearly repeats after two samples and, as nearly, after seven.
    time = np.arange(4200.0)
    signal = np.cos(0.2 * time) + np.cos((0.2 + 2.0 * math.pi / beat) * time)
    assert envelope_lag(signal, 1.0, 20.0) == lag


def test_the_half_size_rule_says_twice_the_arc_of_the_plain_one(pulse_train):
    train = pulse_train(100.0 / RATE, GEARBOX.pass_periods()["outer"])
    plain, half = (EnvelopeLagRule(share).estimate(train.signal, RATE, GEARBOX) for share in (1.0, 2.0))
    assert half.extent == pytest.approx(2.0 * plain.extent, rel=1e-12)
    # A ball covers one spacing of the outer race (30 degrees) in one pass period.
    assert plain.extent == pytest.approx(math.radians(30.0) * plain.lag / plain.pass_period, rel=1e-12)


@pytest.mark.parametrize(("race", "diameter_mm"), [("outer", 38.75 + 7.12), ("inner", 38.75 - 7.12)])
def test_the_length_is_told_along_the_raceway(pulse_train, race, diameter_mm):
    situation = replace(GEARBOX, race=race)
    train = pulse_train(100.0 / RATE, situation.pass_periods()[race])
    estimate = EnvelopeLagRule().estimate(train.signal, RATE, situation)
    assert estimate.extent_mm == pytest.approx(estimate.extent * diameter_mm / 2.0, rel=1e-12)


@pytest.mark.parametrize(("passes", "outcome"), [(5.9, SizeOutcome.TOO_SHORT), (6.1, SizeOutcome.ESTIMATED)])
def test_less_than_six_passes_are_too_few(passes, outcome, pulse_train):
    period = GEARBOX.pass_periods()["outer"]
    signal = pulse_train(100.0 / RATE, period).signal[: int(passes * period * RATE)]
    assert EnvelopeLagRule().estimate(signal, RATE, GEARBOX).outcome is outcome


@pytest.mark.parametrize("rate", [0.0, -1.0, math.nan, math.inf])
def test_a_rate_that_is_none_is_refused(rate):
    with pytest.raises(InvalidParameter, match="rate"):
        EnvelopeLagRule().estimate(np.random.default_rng(0).standard_normal(1000), rate, GEARBOX)


@pytest.mark.parametrize(("share", "found"), [(0.94, True), (0.96, False)])
def test_lags_are_looked_for_up_to_95_hundredths_of_a_pass(share, found):
    # Two bursts a single lag apart: there is no other peak of the autocorrelation.
    period = 2000.0
    rate = period / GEARBOX.pass_periods()["outer"]
    time, lag = np.arange(16_000.0), share * period
    bursts = sum(np.exp(-(((time - place) / 150.0) ** 2)) for place in (7000.0, 7000.0 + lag))
    estimate = EnvelopeLagRule().estimate(np.cos(1.3 * time) * bursts, rate, GEARBOX)
    if found:
        assert estimate.lag / estimate.pass_period == pytest.approx(share, rel=1e-3)
    else:
        assert estimate.outcome is SizeOutcome.NO_EVENT_PAIR
        assert math.isnan(estimate.extent)


@pytest.mark.parametrize(("longest", "found"), [(100.0, False), (101.0, True)])
def test_a_lag_must_be_below_the_longest(longest, found):
    time = np.arange(6000.0)
    bursts = sum(np.exp(-(((time - place) / 8.0) ** 2)) for place in (2000, 2100))
    assert (envelope_lag(np.cos(1.3 * time) * bursts, 1.0, longest) == 100.0) is found


def test_the_plain_rule_is_the_default_and_its_share_stands_in_the_method(pulse_train):
    train = pulse_train(100.0 / RATE, GEARBOX.pass_periods()["outer"])
    said = [rule.estimate(train.signal, RATE, GEARBOX) for rule in (EnvelopeLagRule(), EnvelopeLagRule(2.0))]
    assert [found.method for found in said] == ["envelope lag, 1 times", "envelope lag, 2 times"]
    # The arc of the lag is what was measured, whatever the size is taken for.
    assert [found.extent / found.lag_arc for found in said] == pytest.approx([1.0, 2.0])


def test_the_rule_says_where_there_is_no_signal():
    assert EnvelopeLagRule().estimate(np.zeros((5000, 2)), RATE, GEARBOX).outcome is SizeOutcome.NO_SIGNAL
