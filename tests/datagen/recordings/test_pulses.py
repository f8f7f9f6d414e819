"""Edges of pulses, and pulses that are lost or come twice."""

from __future__ import annotations

import numpy as np
import pytest

from datagen.recordings.pulses import MOST_MENDED, mended, rising_edges


def test_edges_of_a_sine_are_found_where_it_rises_through_its_middle() -> None:
    time = np.arange(20_000) / 10_000.0
    edges = rising_edges(np.sin(2.0 * np.pi * 24.7 * time - 0.4)) / 10_000.0
    assert edges.size == 50
    # A chord of a sine of 405 samples a period is off its zero by far less than a thousandth of a sample.
    assert np.allclose(edges, (np.arange(50) + 0.4 / (2.0 * np.pi)) / 24.7, atol=1e-7)


def test_noise_on_the_edge_of_a_pulse_is_not_counted() -> None:
    pulse = np.concatenate([np.zeros(50), np.linspace(0.0, 1.0, 100), np.ones(50)])
    rough = np.tile(pulse, 8) + 0.03 * np.random.default_rng(1).standard_normal(1600)
    assert rising_edges(rough).size == 8


def test_chatter_behind_an_edge_from_one_sample_to_the_next_is_not_counted() -> None:
    pulse = [0.0, 0.0, 1.0, 0.45, 1.0, 0.45, 0.55, 0.0]
    assert rising_edges(np.array(pulse * 3)).tolist() == [1.5, 9.5, 17.5]


def test_a_stated_threshold_moves_the_edges() -> None:
    ramps = np.tile(np.arange(100.0), 4)
    assert rising_edges(ramps, 80.5).tolist() == [80.5, 180.5, 280.5, 380.5]


@pytest.mark.parametrize("flat", [np.zeros(100), np.ones(100)])
def test_a_dead_channel_has_no_edges(flat: np.ndarray) -> None:
    assert rising_edges(flat).size == 0


def swinging(count: int, pulses_per_rev: float) -> np.ndarray:
    """Times of the pulses of a shaft whose speed rises by half and swings by 3 %."""
    time = np.linspace(0.0, count / pulses_per_rev / 20.0, 400_001)
    turns = 20.0 * time * (1.0 + 0.25 * time / time[-1]) + 0.03 * np.sin(2.0 * np.pi * 3.0 * time)
    return np.interp(np.arange(int(turns[-1] * pulses_per_rev)) / pulses_per_rev, turns, time)


@pytest.mark.parametrize("pulses_per_rev", [0.25, 1.0, 4.0, 60.0])
@pytest.mark.parametrize("lost", [[1], [60], [60, 61, 90], [-2], [7, 50, 51, 52, 100]])
def test_lost_pulses_are_put_back_between_their_neighbours(pulses_per_rev: float, lost: list[int]) -> None:
    times = swinging(240 if pulses_per_rev < 10.0 else 1200, pulses_per_rev)
    found, count = mended(np.delete(times, lost), pulses_per_rev)
    assert count == len(lost)
    # Between pulses of a turn the speed changes by less than 5 %, of which an eighth is what a chord misses, times nine
    # over a gap of three pulses.
    np.testing.assert_allclose(found, times, atol=0.06 * np.diff(times).max())


@pytest.mark.parametrize("share", [0.02, 0.2, 0.5, 0.7, 0.98])
def test_a_pulse_that_comes_twice_is_left_out(share: float) -> None:
    times = swinging(240, 1.0)
    twice = np.insert(times, 81, times[80] + share * (times[81] - times[80]))
    found, count = mended(twice, 1.0)
    assert count == 1
    assert found.size == times.size
    # At the very edges nothing tells which of the two is right.
    assert np.abs(found - times).max() < 0.021 * np.diff(times).max()


@pytest.mark.parametrize("teeth", [36, 60])
@pytest.mark.parametrize("missing", [1, 2])
def test_the_gap_of_a_wheel_is_its_own(teeth: int, missing: int) -> None:
    numbers = np.arange(20 * teeth)
    times = numbers[(numbers % teeth) < teeth - missing] / (20.0 * teeth)  # teeth missing, in every turn
    found, count = mended(times, teeth - missing)
    assert count == 0
    assert found is times


@pytest.mark.parametrize("teeth", [36, 60])
@pytest.mark.parametrize("missing", [1, 2])
def test_a_wheel_whose_missing_teeth_are_counted_among_its_pulses_has_them_put_in(teeth: int, missing: int) -> None:
    numbers = np.arange(20 * teeth - missing)
    turning = numbers / (20.0 * teeth) * (1.0 + numbers / (20.0 * 20.0 * teeth))  # it gains speed, a tenth in all
    times = turning[(numbers % teeth) < teeth - missing]
    found, count = mended(times, teeth)
    assert count == 0
    np.testing.assert_allclose(found, turning, atol=1e-3 / (20.0 * teeth))  # of an interval


@pytest.mark.parametrize(("lost", "count"), [([100], 0), ([100, 300, 600], 0), ([100, 300, 600, 905], 29 + 4)])
def test_nine_in_ten_gaps_of_a_wheel_must_come_again_a_turn_later(lost: list[int], count: int) -> None:
    numbers = np.arange(30 * 36 - 1)
    whole = numbers / 720.0
    # Of the 29 gaps of the wheel 28 are followed by another; of those of pulses that are lost elsewhere none.
    times = whole[(numbers % 36 < 35) & ~np.isin(numbers, lost)]
    found, counted = mended(times, 36.0)
    assert counted == count
    np.testing.assert_allclose(found, whole, atol=1e-12)


def test_a_wheel_that_lacks_teeth_in_several_places_has_them_put_in() -> None:
    numbers = np.arange(30 * 36 - 1)
    whole = numbers / 720.0
    found, count = mended(whole[~np.isin(numbers % 36, [5, 17, 18, 30])], 36.0)
    assert count == 0
    np.testing.assert_allclose(found, whole, atol=1e-12)


@pytest.mark.parametrize("share", [0.002, 0.03, 0.08])
def test_pulses_of_an_encoder_that_are_lost_now_here_now_there_are_put_back_and_counted(share: float) -> None:
    whole = np.arange(5000) / 2500.0  # a hundred a turn
    lost = np.flatnonzero(np.random.default_rng(3).uniform(size=4998) < share) + 1
    found, count = mended(np.delete(whole, lost), 100.0)
    assert count == lost.size
    np.testing.assert_allclose(found, whole, atol=1e-12)


def test_noise_has_more_pulses_to_mend_than_a_tach_may_have() -> None:
    edges = rising_edges(np.random.default_rng(4).standard_normal(50_000)) / 25_600.0
    found, count = mended(edges, 1024.0)
    assert count > MOST_MENDED * found.size


def test_a_wheel_of_slots_in_uneven_places_is_left_as_it_is() -> None:
    slots = np.sort(np.random.default_rng(5).uniform(size=12))
    times = (np.arange(40)[:, None] + slots).ravel() / 25.0
    found, count = mended(times, 12.0)
    assert count == 0
    assert found is times


def test_of_two_pulses_at_one_instant_one_is_left_out() -> None:
    even = np.arange(40) / 16.0  # exactly even, so that either may go
    found, count = mended(np.insert(even, 17, even[17]), 1.0)
    assert count == 1
    np.testing.assert_allclose(found, even, atol=1e-12)


def test_a_rest_that_is_no_whole_number_of_intervals_lacks_pulses_all_the_same() -> None:
    turning = np.arange(40) / 20.0
    _, count = mended(np.concatenate([turning, turning + turning[-1] + 7.45 / 20.0]), 1.0)
    assert count == 6  # seven intervals instead of one


@pytest.mark.parametrize(
    ("gap", "lost"),
    [(1.78, 0), (1.85, 1), (2.15, 1), (2.22, 0), (2.75, 0), (2.85, 2), (2.95, 2), (3.25, 2), (3.4, 2), (4.4, 3)],
)
def test_a_gap_near_a_whole_number_of_intervals_lacks_pulses_and_one_of_three_in_any_case(
    gap: float, lost: int
) -> None:
    turning = np.arange(20) / 20.0
    _, count = mended(np.concatenate([turning, turning + turning[-1] + gap / 20.0]), 1.0)
    assert count == lost


@pytest.mark.parametrize("lost", [[9, 30, 47, 66], [9, 22, 30, 47, 66]])
def test_pulses_that_are_lost_in_other_places_from_turn_to_turn_are_not_the_wheels_own(lost: list[int]) -> None:
    found, count = mended(np.delete(np.arange(80) / 160.0, lost), 8.0)  # eight a turn
    assert (found.size, count) == (80, len(lost))


@pytest.mark.parametrize(
    "times",
    [
        np.delete(np.arange(10) / 20.0, 4),
        swinging(240, 1.0),
        np.cumsum(np.tile([0.9, 1.1], 60)),
        np.cumsum(np.tile([0.1, 0.4], 60)),
        np.cumsum(np.geomspace(1.0, 0.1, 60)),
        np.empty(0),
    ],
    ids=["few", "swinging", "uneven", "pairs", "running up", "none"],
)
def test_other_pulses_are_left_as_they_are(times: np.ndarray) -> None:
    found, count = mended(times, 1.0)
    assert count == 0
    assert found is times


@pytest.mark.parametrize(("dip", "edges"), [(0.41, 1), (0.39, 2)])
def test_a_pulse_counts_where_the_signal_was_a_tenth_of_its_range_below_the_threshold(dip: float, edges: int) -> None:
    assert rising_edges(np.array([0.0, 1.0, dip, 1.0, 0.0])).size == edges


def test_the_height_of_pulses_counts_from_their_foot() -> None:
    pulses = np.array([0.0, 1.0, 0.41, 1.0, 0.0])  # the second rise does not begin a tenth below the middle
    for foot in (-10.0, 0.0, 10.0):
        assert rising_edges(pulses + foot) == pytest.approx([0.5])


def test_a_sample_on_the_threshold_is_an_edge() -> None:
    assert rising_edges(np.array([0.0, 0.5, 1.0, 0.0, 0.5, 1.0])).tolist() == [1.0, 4.0]


@pytest.mark.parametrize(("turns", "count"), [(18, 18), (21, 0)])
def test_pulses_that_half_of_the_turns_lack_may_be_the_wheels_own(turns: int, count: int) -> None:
    """Of 40 turns of eight pulses the first lack the same one: 18 are fewer than one in two, 21 are more."""
    times = np.arange(320) / 160.0
    found, counted = mended(np.delete(times, 4 + 8 * np.arange(1, turns + 1)), 8.0)
    assert counted == count
    np.testing.assert_allclose(found, times, atol=1e-12)
