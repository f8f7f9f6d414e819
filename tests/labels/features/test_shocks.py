"""Shocks are cut down to the size of what the machine does; what it does itself is left as it is."""

import numpy as np
import pytest

from labels.features.shocks import FEWEST_TURNS, without_shocks

RATE, TURNS = 12_000.0, 50.0
TIME = np.arange(24_000) / RATE


def noise(seed=0):
    return np.random.default_rng(seed).standard_normal(TIME.size)


def shock(height, instant):
    since = np.maximum(TIME - instant, 0.0)
    return height * np.exp(-400.0 * since) * np.sin(2.0 * np.pi * 2000.0 * since)


def usual(signal):
    """The usual largest sample of a turn."""
    return np.median(np.abs(signal).reshape(int(TURNS), -1).max(axis=1))


def test_a_shock_is_cut_and_nothing_else_is():
    quiet = noise()
    shocked = quiet + shock(200.0, 0.7) + shock(-300.0, 1.3)
    found, count = without_shocks(shocked, TURNS)
    assert count == 2
    assert np.abs(found - quiet).max() < 2.0 * usual(quiet)
    far = (np.abs(TIME - 0.7) > 0.09) & (np.abs(TIME - 1.3) > 0.09)  # two turns and more
    np.testing.assert_array_equal(found[far], shocked[far])


def test_what_rings_on_in_the_turn_behind_a_shock_is_cut_too():
    quiet = noise()
    # 6 ms before the end of a turn: in the next one it is 200 e^(-2.4) = 18, six times the usual, which is no shock.
    found, count = without_shocks(quiet + shock(200.0, 0.714), TURNS)
    assert count == 1
    assert np.abs(found[TIME >= 0.72]).max() < 1.5 * np.abs(quiet).max()


def test_a_shock_that_rings_over_several_turns_is_one():
    since = np.maximum(TIME - 0.7, 0.0)
    long = 500.0 * np.exp(-15.0 * since) * np.sin(2.0 * np.pi * 2000.0 * since)
    assert without_shocks(noise() + long, TURNS)[1] == 1


@pytest.mark.parametrize(
    "signal",
    [
        noise(),
        noise() + shock(10.0, 0.7),
        0.01 * noise() + sum(shock(100.0, start) for start in np.arange(0.003, 2.0, 0.02)),
        noise() * (1.0 + TIME) ** 2,
        np.zeros(TIME.size),
        np.where(TIME > 1.9, noise(), 0.0),
    ],
    ids=["noise", "a small one", "one a turn", "growing", "silence", "mostly silent"],
)
def test_what_the_machine_does_is_left_as_it_is(signal):
    found, count = without_shocks(signal, TURNS)
    assert count == 0
    assert found is signal


def test_few_turns_say_nothing_of_what_is_usual():
    assert without_shocks(noise() + shock(200.0, 0.7), FEWEST_TURNS - 0.5)[1] == 0
    assert without_shocks(noise() + shock(200.0, 0.7), FEWEST_TURNS)[1] == 1


def test_scale_and_offset_do_not_matter():
    signal = noise() + shock(200.0, 0.7)
    found, count = without_shocks(signal, TURNS)
    scaled, again = without_shocks(5.0 - 1e-3 * signal, TURNS)
    assert count == again == 1
    np.testing.assert_allclose(scaled, 5.0 - 1e-3 * found, rtol=1e-9)
