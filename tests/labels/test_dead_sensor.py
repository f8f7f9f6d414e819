"""A sensor without a signal is known from a quiet one."""

import numpy as np

from labels.dead_sensor import is_dead


def test_a_sensor_without_signal_is_dead():
    assert is_dead(np.zeros(5000))
    assert is_dead(np.full(5000, np.nan))
    noise = np.random.default_rng(4).standard_normal(5000)
    assert not is_dead(noise)
    assert not is_dead(np.concatenate([np.zeros(5000), noise]))
    assert is_dead(np.concatenate([noise, [np.nan]]))
