"""Jumps of the bias are taken out; what a machine or a drifting sensor does is left as it is."""

import numpy as np
import pytest

from labels.features.jumps import without_jumps
from labels.features.whole_turns import FEWEST_TURNS

RATE, TURNS = 12_000.0, 50.0
TIME = np.arange(24_000) / RATE
TURN = TIME[-1] / TURNS


def noise(seed=0):
    return np.random.default_rng(seed).standard_normal(TIME.size)


def steps(*heights):
    """Steps of these heights, evenly over the record."""
    return sum(height * (TIME[-1] * (place + 1) / (len(heights) + 1) < TIME) for place, height in enumerate(heights))


@pytest.mark.parametrize("heights", [(30.0,), (-30.0,), (200.0, -300.0), (30.0, 30.0, -60.0)])
def test_jumps_are_taken_out_and_nothing_else_is(heights):
    found, count = without_jumps(noise() + steps(*heights), TURNS)
    assert count == len(heights)
    # Medians of two turns, 960 samples, have a standard deviation of 1.25 / √960 = 0.04, and heights add up.
    assert np.abs(found - noise()).max() < 0.5


@pytest.mark.parametrize("height", [4.5, -5.0, 7.0])
def test_a_jump_of_a_few_times_the_spread_is_taken_out_too(height):
    found, count = without_jumps(noise() + steps(height), TURNS)
    assert count == 1
    # Least squares place such a step within a few samples, as noise may hide its edge.
    assert np.count_nonzero(np.abs(found - noise()) > 0.5) <= 3


@pytest.mark.parametrize("place", [0.02, 0.031, 0.5, 0.977])
def test_a_jump_is_found_near_the_ends_too(place):
    found, count = without_jumps(noise() + 30.0 * (place * TIME[-1] < TIME), TURNS)
    assert count == 1
    assert np.abs(found - noise()).max() < 0.5


@pytest.mark.parametrize(
    "signal",
    [
        noise(),
        noise() + 3.0 * (TIME > 1.0),
        noise() + 1e4 * TIME,
        1e-6 * noise() + TIME**2,
        1e-3 * noise() + np.sin(2.0 * np.pi * 0.05 * TIME / TURN),
        1e-3 * noise() + np.sin(2.0 * np.pi * 0.4 * TIME / TURN),
        noise() + 500.0 * np.exp(-4000.0 * np.maximum(TIME - 1.0, 0.0)) * (TIME > 1.0),
        noise() + 100.0 * ((TIME > 1.0) & (TIME < 1.0 + 0.3 * TURN)),
        noise() + 100.0 * ((TIME > 1.0) & (TIME < 1.0 + 0.8 * TURN)),
        noise() + 30.0 * np.clip((TIME - 1.0) / (4.0 * TURN), 0.0, 1.0),
        np.where(TIME > 1.0, noise(), 0.0),
        noise() + 50.0 * np.sign(np.sin(2.0 * np.pi * 0.2 * TIME / TURN)),
        np.zeros(TIME.size),
        np.where(TIME > 1.9, 30.0, 0.0),
    ],
    ids=[
        "noise", "a small jump", "a steep ramp", "a parabola", "slow swing", "swing", "a shock", "a short bump",
        "a bump of most of a turn", "a drift over four turns", "a start", "many jumps", "silence", "a step in silence",
    ],
)  # fmt: skip
def test_what_is_no_jump_is_left_as_it_is(signal):
    found, count = without_jumps(signal, TURNS)
    assert count == 0
    assert found is signal


def test_few_turns_say_nothing_of_what_is_usual():
    assert without_jumps(noise() + steps(30.0), FEWEST_TURNS - 0.5)[1] == 0
    assert without_jumps(noise() + steps(30.0), FEWEST_TURNS)[1] == 1


@pytest.mark.parametrize("turns", [TIME.size / 15.0, 2.0 * TIME.size])
def test_nor_do_turns_of_a_few_samples(turns):
    """Parts of 16 samples are looked at where the shaft turns faster, and none without a sample."""
    found, count = without_jumps(noise() + steps(30.0), turns)
    assert count == 1
    assert np.abs(np.median(found[TIME.size // 2 :]) - np.median(found[: TIME.size // 2])) < 1.0
    short = noise()[:100]
    assert without_jumps(short, 50.0)[0] is short


def test_what_is_given_is_left_as_it_was():
    given = noise() + steps(30.0)
    kept = given.copy()
    without_jumps(given, TURNS)
    assert np.array_equal(given, kept)


def test_a_jump_in_what_comes_once_a_turn_has_its_height_over_whole_turns():
    swinging = noise() + 2.0 * np.sin(2.0 * np.pi * TIME / TURN)
    found, count = without_jumps(swinging + steps(30.0), TURNS)
    assert count == 1
    # Over a quarter of a turn to both sides a swing of 2 changes by 2.5; medians of two turns scatter by 0.1.
    assert np.abs(found - swinging).max() < 0.5


def test_blows_neither_hide_a_jump_nor_change_its_height():
    """A blow every third turn, one at the jump too, whose mean over a turn is six deviations of the noise."""
    blows = 1000.0 * np.exp(-4000.0 * np.mod(TIME - 1.0, 3.0 * TURN))
    found, count = without_jumps(noise() + blows + 30.0 * (TIME >= 1.0), TURNS)
    assert count == 1
    assert np.abs(found - noise() - blows).max() < 0.5


@pytest.mark.parametrize(("between", "count"), [(10, 5), (8, 6), (6, 0), (4, 0)])
def test_what_jumps_oftener_than_every_eighth_turn_belongs_to_the_machine(between, count):
    turns = 48
    number = np.arange(TIME.size) * turns // TIME.size
    stairs = 30.0 * ((number + between // 2) // between)
    signal = noise() + stairs
    found, jumps = without_jumps(signal, turns)
    assert jumps == count
    # Medians of two turns, 1000 samples, deviate by 0.04, and six heights add up.
    assert np.abs(found - (noise() if count else signal)).max() < 0.5
