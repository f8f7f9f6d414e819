"""Jumps, glitches and shocks of one signal are all taken out of it; a dead sensor is left dead."""

import numpy as np

from labels.dead_sensor import is_dead
from labels.features.mending import mended

TURNS = 50.0
NOISE = np.random.default_rng(0).standard_normal(24_000)


def test_all_three_are_counted_apart_and_taken_out():
    since = np.maximum(np.arange(NOISE.size) - 16_200, 0)
    shock = 300.0 * np.exp(-0.03 * since) * np.sin(1.05 * since)
    signal = NOISE + 30.0 * (np.arange(NOISE.size) > 9000) + shock
    signal[[3000, 6000, 21_000]] = -40.0, 50.0, 70.0
    found = mended(signal, TURNS)
    assert (found.jumps, found.glitches, found.shocks) == (1, 3, 1)
    # The median largest sample of a turn of 480 is 3.2 deviations.
    assert np.abs(found.signal).max() < 5.0
    calm = np.abs(np.arange(NOISE.size) - 16_200) > 1500  # three turns
    assert np.median(np.abs(found.signal - NOISE)[calm]) < 0.2


def test_what_would_be_put_in_place_of_glitches_makes_no_dead_sensor_a_live_one():
    dead = (NOISE > 0.0).astype(float)
    dead[[3000, 6000, 21_000]] = 40.0
    assert is_dead(dead)
    found = mended(dead, TURNS)
    assert found.signal is dead
    assert (found.jumps, found.glitches, found.shocks) == (0, 0, 0)
