"""A sensor without a signal is known from a quiet one."""

import numpy as np

from labels.dead_sensor import is_dead, live_axis


def test_a_sensor_without_signal_is_dead():
    assert is_dead(np.zeros(5000))
    assert is_dead(np.full(5000, np.nan))
    noise = np.random.default_rng(4).standard_normal(5000)
    assert not is_dead(noise)
    assert not is_dead(np.concatenate([np.zeros(5000), noise]))
    assert is_dead(np.concatenate([noise, [np.nan]]))
    assert is_dead(np.arange(5000) % 3)
    assert not is_dead(np.arange(5000) % 4)


def test_of_several_axes_the_last_that_lives_is_taken():
    first, last = np.random.default_rng(4).standard_normal((2, 5000))
    dead = np.zeros(5000)
    for axes, chosen in (((first, last), last), ((first, dead), first), ((dead, last), last), ((last,), last)):
        assert np.array_equal(live_axis(np.column_stack(axes)), chosen)
    assert np.array_equal(live_axis(last), last)
    assert live_axis(np.column_stack([dead, dead])) is None
    assert live_axis(dead) is None
