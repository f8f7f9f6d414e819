"""The share of white noise in signals whose noise is known."""

import math

import numpy as np
import pytest
from scipy.signal import lfilter

from labels.spall_size.signal.noise_floor import CLEANEST, log_noise_share


def resonance(size=65536):
    pulses = np.zeros(size)
    pulses[::701] = 1.0
    return lfilter([1.0], [1.0, -1.9, 0.95], pulses)


@pytest.mark.parametrize("decibel", [0.0, 10.0, 20.0])
def test_white_noise_is_seen_to_its_level(decibel):
    clean = resonance()
    noise = np.random.default_rng(3).standard_normal(clean.size) * clean.std() * 10.0 ** (-decibel / 20.0)
    true = 1.0 / (1.0 + 10.0 ** (decibel / 10.0))
    # Nine bins of 64 segments make 576 independent means, each ±4 %; the least of some fifty is about 10 % low. The
    # resonance reaches 0.2 % of its variance up there.
    assert log_noise_share(clean + noise) == pytest.approx(math.log(true), abs=0.25)


def test_a_tone_without_noise_is_quiet_and_so_is_a_record_too_short_to_tell():
    tone = np.sin(2.0 * np.pi * 0.01 * np.arange(65536))
    assert log_noise_share(tone) < math.log(1e-6)
    assert log_noise_share(tone[:500]) == math.log(CLEANEST)


def test_noise_alone_is_noisy_at_any_scale():
    noise = 1e-6 * np.random.default_rng(1).standard_normal(65536)
    assert log_noise_share(noise) == pytest.approx(0.0, abs=0.25)
    assert log_noise_share(noise + 1e-3) == pytest.approx(log_noise_share(noise), abs=1e-6)  # rounding
