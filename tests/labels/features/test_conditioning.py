"""The flattened spectrum: noise of any colour becomes level, tones are cut, the bandwidth is common."""

import numpy as np
import pytest

from labels.band_tree import COMMON_BANDWIDTH
from labels.features.conditioning import condition, local_mean_power, over_floor


@pytest.mark.parametrize("size", [1, 2, 3])
def test_of_few_components_the_local_mean_is_that_of_all(size):
    power = np.full(size, 3.0)
    assert local_mean_power(power, 400) == pytest.approx(power / np.log(2.0))


def test_the_local_mean_power_of_exponential_noise_is_its_mean():
    power = np.random.default_rng(0).exponential(3.0, 40_000)
    # The median of 400 values of an exponential scatters by 5 %; averaged over the axis far less.
    assert local_mean_power(power, 400).mean() == pytest.approx(3.0, rel=0.02)


def test_the_floor_runs_log_linearly_between_the_medians_of_blocks_that_overlap_by_half():
    high = np.exp(4.0)
    # Blocks of four from components 0, 2 and 4, of the middles 1.5, 3.5 and 5.5.
    between = 0.5 * (1.0 + high)
    share = np.array([0.0, 0.0, 0.25, 0.75, 0.25, 0.75, 1.0, 1.0])
    below = np.array([1.0] * 4 + [between] * 4)
    above = np.array([between] * 4 + [high] * 4)
    floor = local_mean_power(np.array([1.0] * 4 + [high] * 4), 4)
    assert floor * np.log(2.0) == pytest.approx(below ** (1.0 - share) * above**share, rel=1e-12)


def test_a_spectrum_shorter_than_a_block_has_one_floor():
    power = np.array([[1.0, 5.0, 3.0, 2.0, 4.0], [10.0, 50.0, 30.0, 20.0, 40.0]])
    expected = np.repeat([[3.0], [30.0]], 5, axis=1) / np.log(2.0)
    assert local_mean_power(power, 100) == pytest.approx(expected, rel=1e-12)


def test_what_stands_at_0_hz_is_no_line_and_raises_no_floor():
    power = np.array([[1e9, 2.0, 2.0, 2.0, 2.0, 8.0]])
    assert over_floor(power, 5)[0] == pytest.approx(np.array([0.0, 1.0, 1.0, 1.0, 1.0, 4.0]) * np.log(2.0), rel=1e-12)
    assert over_floor(power[:, :5], 2)[0] == pytest.approx(np.array([0.0, 1.0, 1.0, 1.0, 1.0]) * np.log(2.0), rel=1e-12)
    assert not over_floor(np.zeros((2, 40)), 4).any()


def test_a_spectrum_goes_up_to_its_bandwidth_and_has_nothing_at_0_hz_whatever_the_offset():
    noise = np.random.default_rng(5).standard_normal(40_000)
    found, offset = condition(noise, 20_000.0, 8000.0), condition(noise + 1e4, 20_000.0, 8000.0)
    # Two seconds: half a hertz between components, the last one at 8 kHz.
    assert (found.step, found.duration, found.raw.size, found.flat.size) == (0.5, 2.0, 16_001, 16_001)
    assert (found.raw[0], offset.raw[0]) == (0.0, 0.0)
    assert np.abs(offset.flat - found.flat).max() < 1e-6


def test_the_end_is_dropped_down_to_a_length_of_twos_threes_and_fives():
    noise = np.random.default_rng(8).standard_normal(10_799)
    whole, cut = condition(noise, 20_000.0), condition(noise[:10_368], 20_000.0)
    # 10 368 is 2^7 3^4; the next such number is 10 800, and 10 780 = 2^2 5 7^2 11 is none.
    assert (whole.samples, whole.step) == (10_368, 20_000.0 / 10_368)
    assert np.array_equal(whole.flat, cut.flat)


def test_samples_of_single_precision_are_transformed_in_double():
    noise = (1e4 + np.random.default_rng(9).standard_normal(4000)).astype(np.float32)
    found, double = condition(noise, 1000.0), condition(noise.astype(np.float64), 1000.0)
    assert found.raw.dtype == np.complex128
    assert np.array_equal(found.raw, double.raw)


def test_64_samples_are_enough_and_63_are_not():
    noise = np.random.default_rng(6).standard_normal(64)
    assert condition(noise, 1000.0).samples == 64
    with pytest.raises(ValueError, match="63"):
        condition(noise[:63], 1000.0)


def test_a_stop_band_stays_silent():
    spectrum = np.fft.rfft(np.random.default_rng(7).standard_normal(40_000))
    spectrum[8000:12_000] *= 1e-9
    flat = condition(np.fft.irfft(spectrum), 20_000.0).flat
    assert np.abs(flat[8500:11_500]).max() < 1e-2
    assert np.mean(np.abs(flat[100:7500]) ** 2) == pytest.approx(1.0, abs=0.1)


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
