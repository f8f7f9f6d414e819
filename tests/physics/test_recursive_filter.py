import numpy as np
import pytest
from scipy.signal import lfilter

from physics.recursive_filter import filtered

SECTIONS = [((0.3, -0.2, 0.5), (-1.1, 0.9)), ((1.0, 0.4, 0.0), (0.6, 0.0))]


def test_sections_follow_each_other_as_scipys_filters_do():
    signal = np.random.default_rng(5).standard_normal((500, 3))
    expected = signal
    for forward, back in SECTIONS:
        expected = lfilter(forward, [1.0, *back], expected, axis=0)
    assert filtered(signal, SECTIONS) == pytest.approx(expected, rel=1e-12, abs=1e-12)


def test_the_signal_that_was_given_stays_as_it_is():
    signal = np.ones((4, 1))
    assert filtered(signal, SECTIONS) is not signal
    assert (signal == 1.0).all()


def test_a_decaying_sine_follows_from_one_push():
    turn, decay = 0.3, 0.98
    drive = np.zeros((200, 1))
    drive[1] = decay * np.sin(turn)
    k = np.arange(200)
    rung = filtered(drive, [((1.0, 0.0, 0.0), (-2.0 * decay * np.cos(turn), decay**2))])
    assert rung[:, 0] == pytest.approx(decay**k * np.sin(turn * k), abs=1e-12)
