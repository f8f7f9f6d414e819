"""Samples that are missing or wrong are filled by what their neighbours foretell."""

import numpy as np
import pytest
from scipy.signal import lfilter
from threadpoolctl import threadpool_limits

from labels.filling import foretold, straight

TIME = np.arange(4000.0)


def test_tones_without_noise_go_on_exactly_whatever_their_offset():
    tones = 1e4 + np.sin(0.3 * TIME) + 0.5 * np.cos(1.1 * TIME)
    bad = np.array([0, 1, 700, 701, 702, 703, 704, 705, 1500, 3999])
    holed = tones.copy()
    holed[bad] = np.nan
    filled = foretold(holed, bad)
    assert filled[bad] == pytest.approx(tones[bad], abs=1e-6)
    assert np.delete(filled, bad).tolist() == np.delete(tones, bad).tolist()


def test_white_noise_foretells_nothing_but_its_mean():
    noise = 5.0 + np.random.default_rng(4).standard_normal(TIME.size)
    bad = np.arange(1000, 1010)
    assert foretold(noise, bad)[bad] == pytest.approx(np.full(10, noise.mean()), abs=0.4)


def test_samples_are_the_likeliest_of_their_neighbours():
    # x[k] = 0.9 x[k-1] + noise: between two neighbours a and b the likeliest value is 0.9 (a + b) / (1 + 0.81).
    noise, walk = np.random.default_rng(5).standard_normal(40_000), np.zeros(40_000)
    for k in range(1, walk.size):
        walk[k] = 0.9 * walk[k - 1] + noise[k]
    bad = np.arange(500, 40_000, 500)
    likeliest = 0.9 * (walk[bad - 1] + walk[bad + 1]) / 1.81
    assert np.std(likeliest - walk[bad]) > 0.2 * walk.std()  # which is far from what it truly was
    assert np.std(foretold(walk, bad)[bad] - likeliest) < 0.03 * walk.std()


def test_what_is_too_short_to_learn_from_gets_straight_lines():
    short = np.sin(0.3 * np.arange(30.0))
    bad = np.array([3, 9, 15, 21, 27])
    assert foretold(short, bad).tolist() == straight(short, bad).tolist()
    assert straight(short, bad)[9] == pytest.approx(0.5 * (short[8] + short[10]))


def ringing(size, seed):
    """Blows that ring down, which no time runs backwards in, with a little noise."""
    generator = np.random.default_rng(seed)
    force = np.where(np.arange(size) % 97 == 5, 1.0, 0.0) + 0.02 * generator.standard_normal(size)
    return lfilter([1.0], [1.0, -1.6, 0.9], force)


def test_what_comes_before_says_as_much_as_what_comes_after():
    signal = ringing(4000, 6)
    bad = np.array([0, 1, 310, 311, 312, 1500, 2222, 2223, 3990])
    backwards = foretold(signal[::-1], signal.size - 1 - bad[::-1])[::-1]
    assert foretold(signal, bad) == pytest.approx(backwards, abs=1e-9)


def test_weights_are_learned_from_all_of_a_long_signal():
    """Quiet noise, longer than all stretches that weights are learned from, and then a tone."""
    tone = np.where(np.arange(45_000) < 23_000, 0.0, np.sin(0.3 * np.arange(45_000)))
    signal = tone + 1e-3 * np.random.default_rng(7).standard_normal(tone.size)
    bad = np.arange(40_000, 40_006)
    assert foretold(signal, bad)[bad] == pytest.approx(tone[bad], abs=0.05)


def test_what_is_foretold_does_not_depend_on_how_many_threads_there_are():
    signal, found = ringing(100_000, 8), []
    for threads in (1, 2, 4):
        with threadpool_limits(threads):
            found.append(foretold(signal, np.array([5000, 30_000, 30_001])).tobytes())
    assert found[0] == found[1] == found[2]
