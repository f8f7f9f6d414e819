"""The squared envelope of a band and its kurtosis, of signals whose values are known."""

import numpy as np
import pytest

from labels.squared_envelope import excess_kurtosis, squared_envelope


def test_a_tone_modulated_by_a_cosine_has_the_square_of_its_modulation():
    # 2 (1 + m cos wt) cos: as complex signal 1 + m cos wt at the middle of the band.
    depth, size = 0.5, 64
    inside = np.zeros(size, dtype=complex)
    inside[[16, 20, 24]] = [0.5 * depth, 1.0, 0.5 * depth]
    expected = (1.0 + depth * np.cos(2.0 * np.pi * 4.0 * np.arange(size) / size)) ** 2
    assert squared_envelope(inside, size) * size**2 == pytest.approx(expected, abs=1e-12)


def test_more_samples_than_components_are_the_same_signal_more_densely():
    inside = np.exp(1j * np.arange(8.0))
    assert squared_envelope(inside, 32)[::4] * 16.0 == pytest.approx(squared_envelope(inside, 8))


def test_kurtosis_of_noise_a_tone_a_burst_and_silence():
    noise = np.random.default_rng(1).standard_normal((2, 1_000_000))
    assert excess_kurtosis((noise**2).sum(axis=0)) == pytest.approx(0.0, abs=0.02)
    assert excess_kurtosis(np.full(100, 3.0)) == pytest.approx(-1.0)
    burst = np.zeros(100)
    burst[7] = 5.0
    assert excess_kurtosis(burst) == pytest.approx(100.0 - 2.0)
    assert excess_kurtosis(np.zeros(100)) == -2.0
