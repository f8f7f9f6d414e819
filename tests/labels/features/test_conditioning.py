"""The flattened spectrum: noise of any colour becomes level, tones are cut, the bandwidth is common."""

import numpy as np
import pytest

from labels.band_tree import COMMON_BANDWIDTH
from labels.features.conditioning import condition, local_mean_power


def test_the_local_mean_power_of_exponential_noise_is_its_mean():
    power = np.random.default_rng(0).exponential(3.0, 40_000)
    # The median of 400 values of an exponential scatters by 5 %; averaged over the axis far less.
    assert local_mean_power(power, 400).mean() == pytest.approx(3.0, rel=0.02)


def test_coloured_noise_is_flattened():
    white = np.random.default_rng(1).standard_normal(40_000)
    coloured = np.convolve(white, np.exp(-0.3 * np.arange(40)))[:40_000]
    power = np.abs(condition(coloured, 20_000.0).flat) ** 2
    quarters = [part.mean() for part in np.array_split(power[10:], 4)]
    assert max(quarters) / min(quarters) < 1.1  # the colour itself spans a factor of 40


def test_a_tone_is_cut_to_ten_times_the_noise():
    time = np.arange(40_000) / 20_000.0
    signal = np.random.default_rng(2).standard_normal(40_000) + 30.0 * np.cos(2.0 * np.pi * 3000.0 * time)
    found = condition(signal, 20_000.0)
    assert np.abs(found.flat[round(3000.0 / found.step)]) ** 2 == pytest.approx(10.0, rel=1e-9)  # by definition


def test_no_record_keeps_more_than_the_common_bandwidth():
    noise = np.random.default_rng(3).standard_normal(100_000)
    assert condition(noise, 100_000.0).bandwidth == COMMON_BANDWIDTH
    assert condition(noise, 10_000.0).bandwidth < 5000.0


@pytest.mark.parametrize("signal", [np.zeros(1000), np.ones(1000), np.arange(10.0), np.ones((1000, 2))])
def test_what_holds_no_signal_is_refused(signal):
    with pytest.raises(ValueError, match=r"samples|change"):
        condition(signal, 1000.0)


@pytest.mark.parametrize("level", [0.1, 9.81, 1e5 / 3.0])
@pytest.mark.parametrize("size", [100, 1000, 4099])
def test_a_constant_is_no_signal_though_its_mean_is_rounded(level, size):
    with pytest.raises(ValueError, match="does not change"):
        condition(np.full(size, level), 1000.0)


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_sample_or_a_rate_that_is_not_finite_is_refused(wrong):
    noise = np.random.default_rng(4).standard_normal(1000)
    with pytest.raises(ValueError, match="samples at"):
        condition(noise, wrong)
    noise[500] = wrong
    with pytest.raises(ValueError, match="not finite"):
        condition(noise, 1000.0)
