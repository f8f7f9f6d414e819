"""What a record shows, gathered for all pairs of events."""

import math

import numpy as np
import pytest

from labels.spall_size.columns.table import PAIR_COLUMNS
from labels.spall_size.estimation.gathering import gather_evidence, hear, peakedness, predictability
from labels.spall_size.signal.noise_floor import log_noise_share
from labels.spall_size.signal.prewhitening import prewhitened

RATE = 65536.0
PERIOD = 0.011
LAG = 60.0 / RATE


def test_every_pair_has_every_feature_and_all_are_finite(pulse_train):
    train = pulse_train(LAG, PERIOD, noise=0.3)
    pairs = gather_evidence(train.signal, RATE, {"outer": PERIOD}).pairs
    assert pairs.features.shape == (pairs.lag.size, len(PAIR_COLUMNS))
    assert np.isfinite(pairs.features).all()
    assert np.all((pairs.lag > 0.0) & (pairs.lag < 0.97 * PERIOD * 1.02 * RATE))


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_pairs_know_what_their_record_is_like(pulse_train, race):
    signal = pulse_train(LAG, PERIOD, noise=0.3, duration=0.4).signal
    found = gather_evidence(signal, RATE, {race: PERIOD})
    row, white = dict(zip(PAIR_COLUMNS, found.pairs.features[0], strict=True)), prewhitened(signal)
    assert (found.race, row["inner"]) == (race, float(race == "inner"))
    assert row["score"] == hear(signal, RATE, {race: PERIOD}).track.score
    told = {name: row[name] for name in ("noise", "predictability", "peakedness")}
    facts = (log_noise_share(signal), predictability(signal), peakedness(white.residual**2))
    assert told == pytest.approx(dict(zip(told, facts, strict=True)))
    assert (found.deviation, found.unit) == pytest.approx((signal.std(), white.unit))


def test_nothing_is_heard_of_a_signal_whose_squares_are_below_the_smallest_number(pulse_train):
    signal = pulse_train(LAG, PERIOD, noise=0.3, duration=0.4).signal
    assert hear(1e-200 * signal, RATE, {"outer": PERIOD}) is None
    assert hear(1e-100 * signal, RATE, {"outer": PERIOD}) is not None


def test_what_is_told_in_the_unit_of_the_signal_grows_with_it_and_nothing_else_does(pulse_train):
    signal = pulse_train(LAG, PERIOD, noise=0.3, duration=0.4).signal
    one, other = (gather_evidence(scale * signal, RATE, {"outer": PERIOD}) for scale in (1.0, 1e3))
    for name in ("deviation", "unit"):
        assert getattr(other, name) == pytest.approx(1e3 * getattr(one, name), rel=1e-6)
    for name in ("sway_unit", "give_unit"):
        assert getattr(other.mean, name) == pytest.approx(1e3 * getattr(one.mean, name), rel=1e-6)
    assert other.pairs.features == pytest.approx(one.pairs.features, rel=1e-4, abs=1e-4)


def test_a_signal_upside_down_turns_sway_and_displacement_and_nothing_else(pulse_train):
    train = pulse_train(LAG, PERIOD, noise=0.1)
    one, other = (gather_evidence(sign * train.signal, RATE, {"outer": PERIOD}) for sign in (1.0, -1.0))
    assert np.allclose(one.mean.energy, other.mean.energy, rtol=1e-9)
    assert np.allclose(one.mean.sway, -other.mean.sway, atol=1e-9)
    assert np.allclose(one.mean.give, -other.mean.give, atol=1e-9)
    turned = ("sway", "give", "wave_sign")
    same = [k for k, name in enumerate(PAIR_COLUMNS) if not any(word in name for word in turned)]
    assert np.allclose(one.pairs.features[:, same], other.pairs.features[:, same], atol=1e-6)
    # What was heard once serves both.
    turned_over = hear(train.signal, RATE, {"outer": PERIOD}).evidence(-1.0)
    assert np.array_equal(turned_over.pairs.features, other.pairs.features)
    assert np.array_equal(turned_over.mean.give, other.mean.give)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_differences_of_white_noise_have_twice_its_variance_whatever_its_scale(scale):
    noise = scale * np.random.default_rng(0).standard_normal(100_000)
    assert predictability(noise) == pytest.approx(-math.log(2.0), abs=0.02)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_the_energy_of_white_noise_is_as_peaked_as_its_median_says_whatever_its_scale(scale):
    energy = (scale * np.random.default_rng(0).standard_normal(100_000)) ** 2
    # Half of the squares of a standard normal variable, whose mean is 1, are below 0.6745².
    assert peakedness(energy) == pytest.approx(-2.0 * math.log(0.6745), abs=0.02)
    energy[::100] *= 1e4
    assert peakedness(energy) == pytest.approx(math.log(100.0) - 2.0 * math.log(0.6745), abs=0.1)


def test_the_race_that_shows_most_clearly_is_taken_in_whatever_order_they_are_asked_for(pulse_train):
    signal = pulse_train(LAG, PERIOD).signal
    periods = {"outer": 1.01 * PERIOD, "inner": PERIOD / 1.45}
    for races in (("outer", "inner"), ("inner", "outer")):
        assert gather_evidence(signal, RATE, {race: periods[race] for race in races}).race == "outer"
    assert gather_evidence(signal, RATE, {"outer": 1.45 * PERIOD, "inner": PERIOD}).race == "inner"


def test_too_few_passes_give_no_evidence():
    noise = np.random.default_rng(0).standard_normal(1000)  # 1.4 passes
    assert gather_evidence(noise, RATE, {"outer": 0.011}) is None
