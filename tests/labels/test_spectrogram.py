import numpy as np
import pytest

from labels.spectrogram import COLUMNS, FEWEST_WINDOW_SAMPLES, spectrogram

RATE = 8192.0
TIME = np.arange(8192) / RATE


def test_a_tone_has_half_its_squared_amplitude_at_its_frequency_at_all_times():
    time, frequency, power = spectrogram(3.0 * np.cos(2.0 * np.pi * 1000.0 * TIME), RATE, 0.2, 0.8)
    assert power.shape == (frequency.size, time.size) == (power.shape[0], COLUMNS)
    peak = np.argmax(power, axis=0)
    # The window holds 197 samples, so lines are four times 0.24 of 41.6 Hz wide: half a bin off at most.
    assert np.all(np.abs(frequency[peak] - 1000.0) <= frequency[1] / 2.0)
    assert power.max(axis=0) == pytest.approx(4.5, rel=0.02)  # half a bin from the top of the main lobe


def test_an_impulse_shows_at_its_own_instant():
    signal = np.zeros(TIME.size)
    signal[4096] = 1.0
    time, _, power = spectrogram(signal, RATE, 0.4, 0.6)
    assert time[np.argmax(power.sum(axis=0))] == pytest.approx(0.5, abs=0.5 / RATE + 0.2 / COLUMNS)  # sample and column


def test_beyond_the_ends_of_the_signal_there_is_silence_and_a_short_span_keeps_the_smallest_window():
    time, frequency, power = spectrogram(np.ones(TIME.size), RATE, 0.0, 1.0)
    assert (time[0], time[-1], frequency[-1]) == (0.0, 1.0, RATE / 2.0)
    # Half of the window hangs over the end: half of the amplitude.
    assert power[0, 0] == pytest.approx(power[0, COLUMNS // 2] / 4.0, rel=0.02)  # one sample more or less of 328
    _, short, _ = spectrogram(np.ones(TIME.size), RATE, 0.5, 0.5 + 10.0 / RATE)
    assert short[1] == RATE / (4.0 * FEWEST_WINDOW_SAMPLES)


def test_a_span_far_beyond_both_ends_is_silent_but_for_the_signal_in_it():
    time, _, power = spectrogram(np.cos(2.0 * np.pi * 1000.0 * TIME), RATE, -2.5, 3.5)
    half_window = 0.02 * 6.0
    outside = (time < -half_window - 1.0 / RATE) | (time > 1.0 + half_window + 1.0 / RATE)
    well_inside = (time > half_window) & (time < 1.0 - half_window)
    assert not power[:, outside].any()
    assert power[:, well_inside].max(axis=0) == pytest.approx(0.5, rel=0.02)  # half a bin from the top, as above
    _, _, nothing = spectrogram(np.ones(TIME.size), RATE, 5.0, 6.0)
    assert not nothing.any()


def test_a_window_that_begins_behind_the_last_sample_or_ends_before_the_first_is_silent():
    half = FEWEST_WINDOW_SAMPLES // 2
    for centre, sounds in ((TIME.size + half - 2, True), (TIME.size + half, False), (2 - half, True), (-half, False)):
        _, _, power = spectrogram(np.ones(TIME.size), RATE, centre / RATE, (centre + 1e-6) / RATE)
        assert power.any() == sounds
