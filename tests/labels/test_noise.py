import math

import numpy as np
import pytest

from labels.noise import band_power, signal_to_noise, with_white_noise

RATE = 1000.0
TIME = np.arange(1000) / RATE


def test_the_snr_of_equal_powers_is_0_db_and_of_ten_times_the_amplitude_20_db():
    noise = np.array([1.0, -1.0, 1.0, -1.0])
    assert signal_to_noise(noise + 5.0, noise, RATE) == pytest.approx(0.0, abs=1e-12)  # a mean is no vibration
    assert signal_to_noise(10.0 * noise, noise, RATE) == pytest.approx(20.0, abs=1e-12)
    assert math.isnan(signal_to_noise(noise, 0.0 * noise, RATE))


@pytest.mark.parametrize("band", [None, (90.0, 110.0)])
@pytest.mark.parametrize("level", [0.0, 0.1])  # a constant is no vibration either, but for its rounding
def test_a_silent_signal_has_no_snr(band, level):
    noise = np.random.default_rng(3).standard_normal(TIME.size)
    assert math.isnan(signal_to_noise(np.full(TIME.size, level), noise, RATE, band))


def test_the_snr_over_a_band_counts_only_what_lies_in_it():
    signal = 3.0 * np.cos(2.0 * np.pi * 100.0 * TIME) + 50.0 * np.cos(2.0 * np.pi * 300.0 * TIME)
    noise = 0.3 * np.sin(2.0 * np.pi * 110.0 * TIME) + 70.0 * np.sin(2.0 * np.pi * 310.0 * TIME)
    assert signal_to_noise(signal, noise, RATE, (90.0, 110.0)) == pytest.approx(20.0, abs=1e-9)  # edges included
    assert math.isnan(signal_to_noise(signal, np.sin(2.0 * np.pi * 50.0 * TIME), RATE, (90.0, 110.0)))


@pytest.mark.parametrize("level", [-10.0, 0.0, 20.0])
def test_a_signal_stands_above_the_noise_it_is_put_in_by_what_was_asked_for(level):
    signal = 7.0 + 3.0 * np.random.default_rng(0).standard_normal(50_000)
    noise = with_white_noise(signal, level, np.random.default_rng(1)) - signal
    # The deviation of 50 000 draws is known to 0.3 %, 0.03 dB.
    assert signal_to_noise(signal, noise, RATE) == pytest.approx(level, abs=0.1)


@pytest.mark.parametrize("size", [1000, 999])
def test_the_power_of_the_full_band_is_the_variance(size):
    signal = 4.0 + np.random.default_rng(5).standard_normal(size)
    assert band_power(signal, RATE, (0.0, RATE / 2.0)) == pytest.approx(np.var(signal), rel=1e-12)  # Parseval


@pytest.mark.parametrize("band", [(-1.0, 100.0), (100.0, 100.0), (0.0, 501.0)])
def test_a_band_outside_the_spectrum_is_refused_with_what_is_allowed(band):
    with pytest.raises(ValueError, match="allowed: 0 <= low < high <= 500 Hz"):
        band_power(TIME, RATE, band)
