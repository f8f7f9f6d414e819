"""The band that is chosen of signals whose impacts ring where they are made to."""

import numpy as np
import pytest

from labels.band import holds_a_line
from labels.kurtogram import most_impulsive_band

RATE, SIZE = 25_600.0, 51_200
TIME = np.arange(SIZE) / RATE


def ringing(frequency, places, size=SIZE):
    """Decaying tones of a `frequency` (Hz) that begin at these places."""
    force = np.zeros(size)
    force[places] = 1.0
    return np.convolve(force, np.exp(-600.0 * TIME[:400]) * np.sin(2.0 * np.pi * frequency * TIME[:400]))[:size]


@pytest.fixture
def noise():
    return 0.4 * np.random.default_rng(2).standard_normal(SIZE)


@pytest.mark.parametrize("frequency", [900.0, 3300.0, 8500.0])
def test_the_band_holds_the_frequency_at_which_impacts_ring(noise, frequency):
    low, high = most_impulsive_band(noise + ringing(frequency, np.arange(100, SIZE, 300)), RATE, SIZE)
    assert low < frequency < high
    assert high - low < 0.3 * RATE / 2.0


def test_neither_one_knock_nor_tones_choose_the_band(noise):
    impacts = ringing(3300.0, np.arange(100, SIZE, 300))
    knock, tones = 50.0 * ringing(8500.0, [20_000]), 3.0 * np.cos(2.0 * np.pi * 900.0 * TIME)
    low, high = most_impulsive_band(noise + impacts + knock + tones, RATE, SIZE)
    assert low < 3300.0 < high < 8500.0
    assert low > 900.0


def test_nothing_above_20_khz_nor_next_to_half_the_rate_is_chosen():
    for rate, top in ((200_000.0, 20_000.0), (10_000.0, 4750.0)):
        signal = np.random.default_rng(3).standard_normal(SIZE)
        assert 0.0 <= most_impulsive_band(signal, rate, SIZE)[0] < most_impulsive_band(signal, rate, SIZE)[1] <= top


@pytest.mark.parametrize("size", [16, 17, 100, 4000])
@pytest.mark.parametrize("piece", [16, 50, 4000])
def test_the_band_holds_a_line_of_every_piece(size, piece):
    for seed in range(20):
        signal, shortest = np.random.default_rng(seed).standard_normal(size), min(piece, size)
        low, high = most_impulsive_band(signal, 1000.0, shortest)
        assert holds_a_line((low, high), shortest, 1000.0)
        assert high - low > 1.9 * 1000.0 / shortest  # two components, less rounding
        # And two of an eighth of the signal, of which the kurtosis is taken; or all that there is, below 475 Hz.
        assert high - low > min(1.9 * 8.0 * 1000.0 / size, 474.0)


def test_an_offset_does_not_choose_the_band(noise):
    signal = noise + ringing(900.0, np.arange(100, SIZE, 300))  # in the band that holds 0 Hz
    assert most_impulsive_band(1e4 + signal, RATE, SIZE) == most_impulsive_band(signal, RATE, SIZE)


@pytest.mark.parametrize("signal", [np.zeros(400), np.full(400, 3.0), np.where(np.arange(400) == 7, 1.0, 0.0)])
def test_a_signal_that_hardly_changes_has_a_band_too(signal):
    low, high = most_impulsive_band(signal, 1000.0, 400)
    assert 0.0 <= low < high <= 475.0
