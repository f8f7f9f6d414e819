"""The ringing of the machine taken away."""

import numpy as np
import pytest
from made_passes import mean_of_passes
from scipy.signal import lfilter

from labels.spall_size.signal.prewhitening import prewhitened


def test_prewhitening_takes_the_ringing_away_and_leaves_the_pulses():
    pulses = np.zeros(20000)
    places = np.arange(500, 19500, 900)
    pulses[places] = np.resize([1.0, -1.0], places.size)  # so that the mean, which is taken off, is nothing
    signal = lfilter([1.0], [1.0, -1.6, 0.95], pulses)
    # The resonator is a predictor of two terms, so all that is left of the ringing is rounding.
    residual = np.abs(prewhitened(signal + 1e-9 * np.random.default_rng(0).standard_normal(20000)).residual)
    quiet = np.delete(residual, places)
    assert residual[places].min() > 1e3 * np.percentile(quiet, 99.0)
    assert residual[places].min() > 10.0 * quiet.max()  # what is left near a pulse, where weights are small


def test_waveform_and_sway_are_of_the_signal_prewhitened_and_as_it_was():
    turn = 2.0 * np.pi * np.arange(20_000) / 400.0
    mean = mean_of_passes(np.sin(20.0 * turn), 400 * np.arange(2, 48), signal=5.0 + 3.0 * np.cos(turn))
    turn = 2.0 * np.pi * mean.offset / 400.0
    assert mean.waveform == pytest.approx(np.sin(20.0 * turn), abs=1e-9)
    assert (mean.sway.mean(), mean.sway.std()) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert mean.sway_unit == pytest.approx((3.0 * np.cos(turn)).std(), rel=0.01)  # a blur of 4 samples leaves 0.998


def test_prewhitened_noise_is_told_in_units_of_its_median_size():
    noise = 3.0 * np.random.default_rng(0).standard_normal(40_000)
    found = prewhitened(noise)
    assert np.median(np.abs(found.residual)) == pytest.approx(1.0)
    # Of a standard normal variable half are smaller than 0.6745; 40 000 samples tell it to half a per cent.
    assert found.unit == pytest.approx(3.0 * 0.6745, rel=0.02)


def test_of_a_signal_that_is_silent_most_of_the_time_the_unit_is_no_rounding():
    clicks = np.zeros(20_000)
    clicks[::499] = 1.0
    residual = prewhitened(np.concatenate([clicks, -clicks])).residual
    assert np.median(np.abs(residual)) == 0.0
    assert np.isfinite(np.sum(residual**2))


def test_what_has_no_whole_past_is_not_foretold_and_has_no_residual():
    residual = prewhitened(100.0 + np.random.default_rng(1).standard_normal(5000)).residual
    assert np.count_nonzero(residual) == np.count_nonzero(residual[30:]) == 5000 - 30
