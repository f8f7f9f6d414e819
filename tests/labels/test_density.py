import numpy as np
import pytest
from scipy.signal import welch

from labels.density import power_density, velocity_density

RATE = 4096.0


def test_it_is_welch_s_mean_where_the_windows_overlap_by_half():
    signal = np.random.default_rng(3).standard_normal(4096)
    frequency, power = power_density(signal, RATE, 4.0)
    windows = {"window": "hann", "nperseg": 1024, "noverlap": 512, "detrend": False}
    other_frequency, other = welch(signal - signal.mean(), RATE, **windows)
    assert frequency == pytest.approx(other_frequency)
    assert power == pytest.approx(other, rel=1e-9)  # rounding of another order of sums


def test_the_power_of_a_tone_is_half_its_square_whatever_the_resolution():
    time = np.arange(6000) / RATE
    for resolution in (1.0, 2.0, 8.0):
        frequency, power = power_density(3.0 * np.cos(2.0 * np.pi * 512.0 * time), RATE, resolution)
        assert np.sum(power) * frequency[1] == pytest.approx(4.5, rel=1e-3)  # the mean taken off is not quite zero
        assert frequency[np.argmax(power)] == pytest.approx(512.0)


def test_the_windows_reach_from_the_first_sample_to_the_last():
    for place in (100, 5900):
        impulse = np.zeros(6000)
        impulse[place] = 1.0
        # 100 samples from its end a window of 4096 still weighs 0.012; a place left out would leave rounding, 1e-35.
        assert power_density(impulse, RATE, 1.0)[1][100:2000].max() > 1e-12


def test_the_velocity_of_a_tone_is_its_acceleration_over_2_pi_f():
    time = np.arange(8192) / RATE
    frequency, power = velocity_density(np.cos(2.0 * np.pi * 64.0 * time), RATE, 1.0)
    amplitude = np.sqrt(2.0 * np.sum(power[32:96]) * frequency[1])
    assert amplitude == pytest.approx(
        1.0 / (2.0 * np.pi * 64.0), rel=0.01
    )  # neighbouring bins are divided by their own f
    assert power[0] == 0.0


def test_a_signal_shorter_than_a_window_is_refused():
    with pytest.raises(ValueError, match="needs 4096 samples"):
        power_density(np.zeros(4095), RATE, 1.0)


@pytest.mark.parametrize("wrong", [0.0, -1.0, np.nan, np.inf])
def test_a_rate_or_a_resolution_that_is_none_is_refused(wrong):
    for rate, resolution in ((wrong, 10.0), (1000.0, wrong)):
        with pytest.raises(ValueError, match="both must be finite and above 0"):
            power_density(np.arange(1000.0), rate, resolution)
