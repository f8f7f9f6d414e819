"""Samples that are missing or wrong are filled by what their neighbours foretell."""

import numpy as np
import pytest

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
