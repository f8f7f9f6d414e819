import numpy as np
import pytest

from labels.spectrum import amplitude_spectrum, line_amplitude

RATE = 4096.0
TIME = np.arange(8192) / RATE


@pytest.mark.parametrize("size", [8192, 8191])
def test_a_tone_on_a_bin_has_its_own_height(size):
    tone = size * 200 // 4096 * RATE / size
    signal = 5.0 + 3.0 * np.cos(2.0 * np.pi * tone * np.arange(size) / RATE + 0.7)
    frequency, amplitude = amplitude_spectrum(signal, RATE)
    assert frequency[np.argmax(amplitude)] == pytest.approx(tone, rel=1e-12)
    assert amplitude.max() == pytest.approx(3.0, rel=1e-12)
    assert amplitude[0] < 1e-12


def test_the_component_at_half_the_rate_is_counted_once():
    _, amplitude = amplitude_spectrum(2.0 * np.cos(np.pi * np.arange(64)), 64.0)
    assert amplitude[-1] == pytest.approx(2.0, rel=1e-12)


def test_the_component_at_0_hz_is_counted_once():
    # cos x (1 - cos x) has the mean -1/2.
    _, amplitude = amplitude_spectrum(np.cos(2.0 * np.pi * np.arange(64) / 64), 64.0)
    assert amplitude[:3] == pytest.approx([0.5, 1.0, 0.5], rel=1e-12)


def test_the_spectrum_keeps_the_power_of_the_signal_under_the_window():
    signal = np.random.default_rng(2).standard_normal(999)
    _, amplitude = amplitude_spectrum(signal, RATE)
    windowed = (signal - signal.mean()) * (1.0 - np.cos(2.0 * np.pi * np.arange(999) / 999))
    # Parseval: a line of height a carries a²/2, the mean its square.
    assert amplitude[0] ** 2 + np.sum(amplitude[1:] ** 2) / 2.0 == pytest.approx(np.mean(windowed**2), rel=1e-12)


def test_the_spectrum_ignores_the_mean_and_scales_with_the_signal():
    signal = np.random.default_rng(3).standard_normal(1024)
    _, amplitude = amplitude_spectrum(signal, RATE)
    _, other = amplitude_spectrum(-4.0 * signal + 17.0, RATE)
    assert np.allclose(other, 4.0 * amplitude, atol=1e-12)  # rounding


def test_a_line_is_the_largest_component_within_the_tolerance():
    frequency = np.arange(10.0)
    amplitude = np.array([0.0, 1.0, 2.0, 9.0, 4.0, 3.0, 8.0, 0.0, 0.0, 0.0])
    assert line_amplitude(frequency, amplitude, 4.5, 1.0) == 4.0
    assert line_amplitude(frequency, amplitude, 4.0, 1.0) == 9.0
    assert line_amplitude(frequency, amplitude, 4.0, 0.0) == 4.0
    # In floats 0.4 lies farther than 0.1 from 0.3.
    assert line_amplitude(0.1 * frequency, np.where(frequency == 4.0, 7.0, 0.0), 0.3, 0.1) == 7.0
    with pytest.raises(ValueError, match=r"within 4\.5 ± 0\.2 Hz"):
        line_amplitude(frequency, amplitude, 4.5, 0.2)


def test_a_single_sample_is_refused():
    with pytest.raises(ValueError, match="1 samples"):
        amplitude_spectrum(TIME[:1], RATE)


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan, np.inf])
def test_a_rate_that_is_none_is_refused(rate):
    with pytest.raises(ValueError, match="a rate above 0"):
        amplitude_spectrum(np.arange(10.0), rate)
