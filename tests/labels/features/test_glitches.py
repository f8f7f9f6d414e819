"""Glitches of a recorder are drawn over; what a machine does, and what else a recorder does, is left as it is."""

import numpy as np
import pytest
from scipy.signal import lfilter

from labels.features.glitches import without_glitches

RATE = 12_000.0
SIZE = 24_000
TIME = np.arange(SIZE) / RATE


def noise(seed=0):
    return np.random.default_rng(seed).standard_normal(SIZE)


def impacts(decay, frequency):
    """Ringing of unit height, 100 times a second, begun anywhere between two samples."""
    since = np.mod(TIME + 0.3 / RATE, 1.0 / 100.3)
    return np.exp(-decay * since) * np.sin(2.0 * np.pi * frequency * since)


@pytest.mark.parametrize("values", [[20.0], [-20.0], [20.0, 15.0], [20.0, -20.0, 20.0]])
@pytest.mark.parametrize("place", [0, 9000, SIZE - 3])
def test_a_glitch_is_replaced_by_what_its_neighbours_foretell(values, place):
    signal = lfilter([1.0], [1.0, -1.6, 0.98], noise()) / 6.0  # rings at a tenth of the rate, for a hundred samples
    glitched = signal.copy()
    glitched[place : place + len(values)] = values
    found, count = without_glitches(glitched, 10.0)
    assert count == 1
    changed = np.flatnonzero(found != glitched)
    assert changed.tolist() == list(range(place, place + len(values)))
    assert np.abs(found - signal)[changed].max() < 0.5 * signal.std()


def test_two_glitches_side_by_side_are_both_found():
    glitched = noise()
    glitched[[5000, 5008]] = 60.0, 20.0
    assert without_glitches(glitched, 10.0)[1] == 2


def test_what_comes_oftener_than_allowed_is_the_machines():
    glitched = noise()
    glitched[100::1000] = 30.0
    assert without_glitches(glitched, 24.0)[1] == 24
    found, count = without_glitches(glitched, 23.0)
    assert count == 0
    assert found is glitched


@pytest.mark.parametrize(
    "signal",
    [
        noise(),
        np.repeat(noise(), 3),
        1e6 + noise(),
        np.cumsum(noise()),
        np.clip(noise(), -1.0, 1.0),
        np.round(noise()),
        np.where(np.mod(TIME, 0.5) < 0.002, 0.0, noise()),
        noise() + 20.0 * (TIME > 1.0),
        0.05 * noise() + 5.0 * impacts(600.0, 3000.0),
        0.05 * noise() + 5.0 * impacts(1500.0, 1200.0),
        0.05 * noise() + 5.0 * impacts(400.0, 5200.0),
        0.05 * noise() + 5.0 * impacts(2500.0, 3000.0),
        np.zeros(SIZE),
        np.where(TIME == 1.0, 5.0, 0.0),
        np.arange(20.0),
        np.where(np.arange(24) == 7, 30.0, noise()[:24]),
    ],
    ids=["noise", "held", "offset", "drift", "clipped", "rounded", "dropouts", "step"]
    + ["ringing", "damped ringing", "high ringing", "sharp ringing", "silence", "one sample in silence"]
    + ["few samples", "a high one of few samples"],
)
def test_nothing_else_is_touched(signal):
    found, count = without_glitches(signal, np.inf)
    assert count == 0
    np.testing.assert_array_equal(found, signal)


def test_scale_and_offset_do_not_matter():
    glitched = noise()
    glitched[700] = -15.0
    found, _ = without_glitches(glitched, 10.0)
    scaled, count = without_glitches(3.0 - 1e-3 * glitched, 10.0)
    assert count == 1
    np.testing.assert_allclose(scaled, 3.0 - 1e-3 * found, rtol=1e-12)  # up to rounding
