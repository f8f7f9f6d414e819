"""Of a long record the first passes are looked at, by the estimator and by the rules that it is compared with."""

import math

import numpy as np
import pytest

from datagen.sizing.estimators import default_estimator
from labels.spall_size.estimation.first_passes import first_passes
from labels.spall_size.estimation.rules import EnvelopeLagRule
from labels.spall_size.situation import Situation

RATE = 65536.0
GEARBOX = Situation(12, 2, 38.75e-3, 7.12e-3, 2.0 * math.pi * 30.0)
# Balls pass a point of the outer race 30 · 12 / 2 · (1 - 7.12 / 38.75) times a second.
PASS_SAMPLES = RATE / (30.0 * 6.0 * (1.0 - 7.12 / 38.75))


@pytest.fixture
def forty(monkeypatch):
    """How many samples the first forty passes last, which alone are looked at."""
    monkeypatch.setattr("labels.spall_size.estimation.first_passes.MOST_PASSES", 40)
    return math.ceil(40.0 * PASS_SAMPLES)


def test_four_thousand_passes_of_the_outer_race_are_looked_at():
    long = np.zeros(2_000_000)
    assert first_passes(long, RATE, GEARBOX).size == math.ceil(4000.0 * PASS_SAMPLES)
    assert first_passes(long[:1_700_000], RATE, GEARBOX).size == 1_700_000


def test_the_estimator_hears_nothing_of_later_passes(forty, monkeypatch):
    heard = []
    monkeypatch.setattr("labels.spall_size.estimation.estimator.hear", lambda signal, *_: heard.append(signal))
    signal = np.random.default_rng(1).standard_normal(forty + 20_000)
    default_estimator().estimate(signal, RATE, GEARBOX)
    assert np.array_equal(heard, [signal[:forty]])


def test_later_passes_change_no_lag_of_the_envelope(forty, pulse_train):
    first = pulse_train(150.0 / RATE, GEARBOX.pass_periods()["outer"]).signal[:forty]
    later = pulse_train(50.0 / RATE, GEARBOX.pass_periods()["outer"], seed=4).signal
    alone, followed = (EnvelopeLagRule().estimate(x, RATE, GEARBOX) for x in (first, np.concatenate([first, later])))
    assert alone.lag == followed.lag == pytest.approx(150.0 / RATE, abs=5.0 / RATE)
