"""Jumps of the bias are taken out; what a machine or a drifting sensor does is left as it is."""

import numpy as np
import pytest

from labels.features.jumps import FEWEST_TURNS, without_jumps

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
        np.where(TIME > 1.0, noise(), 0.0),
        noise() + 50.0 * np.sign(np.sin(2.0 * np.pi * 0.2 * TIME / TURN)),
        np.zeros(TIME.size),
        np.where(TIME > 1.9, 30.0, 0.0),
    ],
    ids=[
        "noise", "a small jump", "a steep ramp", "a parabola", "slow swing", "swing", "a shock", "a short bump",
        "a start", "many jumps", "silence", "a step in silence",
    ],
)  # fmt: skip
def test_what_is_no_jump_is_left_as_it_is(signal):
    found, count = without_jumps(signal, TURNS)
    assert count == 0
    assert found is signal


def test_few_turns_say_nothing_of_what_is_usual():
    assert without_jumps(noise() + steps(30.0), FEWEST_TURNS - 0.5)[1] == 0
