"""The vibration as velocity."""

import numpy as np
import pytest

from labels.features.analysis import analyse
from labels.features.kinematics import bearing_kinematics
from labels.features.orders import _velocity_power

KNOWN = bearing_kinematics(9, 39.04e-3, 7.94e-3, 0.0, 25.0)


def test_the_velocity_of_a_tone_is_its_acceleration_over_its_frequency():
    rate, size = 20_000.0, 20_000
    time = np.arange(size) / rate
    tones = sum(np.cos(2.0 * np.pi * frequency * time) for frequency in (110.0, 440.0))
    analysis = analyse(tones + 1e-4 * np.random.default_rng(0).standard_normal(size), rate, KNOWN)
    power = _velocity_power(analysis)
    low, high = (power[round(frequency / analysis.record.step)] for frequency in (110.0, 440.0))
    assert low / high == pytest.approx(16.0, rel=1e-3)  # (440 / 110)²; the noise adds some 1e-6
    assert power[: int(0.5 * 25.0 / analysis.record.step)].max() == 0.0
