"""One vote a record."""

import numpy as np
import pytest

from labels.classifier.votes import averaged, joined, of_several_axes, raised, vote_shares


def test_rows_of_a_record_agree_on_the_geometric_mean_of_their_probabilities():
    probability = np.array([[0.9, 0.1], [0.2, 0.8], [0.5, 0.5]])
    found = joined(probability, np.array([7, 8, 7]), np.array([7, 8, 9]))
    # Odds of 9 and of 1 have a geometric mean of 3.
    assert found[:2] == pytest.approx(np.array([[0.75, 0.25], [0.2, 0.8]]))
    assert np.isnan(found[2]).all()


def test_a_row_that_is_certain_has_no_veto():
    # What is thought impossible counts as 1e-6.
    found = joined(np.array([[0.0, 1.0], [0.9, 0.1]]), np.array([7, 7]), np.array([7]))
    odds = np.sqrt(1e-6 * 0.9) / np.sqrt(0.1)
    assert found[0] == pytest.approx([odds / (1.0 + odds), 1.0 / (1.0 + odds)])


def test_other_values_are_averaged_as_they_are():
    found = averaged(np.array([9.0, 2.0, 1.0]), np.array([7, 8, 7]), np.array([8, 7, 9]))
    assert found == pytest.approx([2.0, 5.0, np.nan], nan_ok=True)


def test_rows_count_by_their_shares():
    owner, shares = np.array([7, 8, 7]), np.array([0.75, 1.0, 0.25])
    found = averaged(np.array([[8.0], [3.0], [4.0]]), owner, np.array([7, 8, 9]), shares)
    assert found[:, 0] == pytest.approx([7.0, 3.0, np.nan], nan_ok=True)
    # Odds of 81 and of 1: three quarters of the one.
    probability = np.array([[81.0, 1.0], [1.0, 1.0], [41.0, 41.0]]) / 82.0
    assert joined(probability, owner, np.array([7]), shares)[0] == pytest.approx([27.0 / 28.0, 1.0 / 28.0])


def test_the_axis_that_says_most_counts_twice_and_its_windows_share():
    owner = np.array([3, 3, 3, 3, 3, 1, 1, 2])
    axis = np.array([0, 0, 1, 1, 2, 0, 1, 5])
    # Of record 3 axis 1 says most on average, though its second window says little.
    level = np.array([1.0, 1.0, 9.0, -1.0, 0.0, -5.0, -4.0, 0.0])
    assert vote_shares(level, owner, axis) == pytest.approx([1 / 8, 1 / 8, 1 / 4, 1 / 4, 1 / 4, 1 / 3, 2 / 3, 1.0])
    assert vote_shares(np.empty(0), owner[:0], axis[:0]).size == 0


def test_windows_of_one_axis_are_no_axes():
    owner, axis = np.array([4, 4, 7, 7, 7]), np.array([0, 1, 0, 0, 0])
    assert of_several_axes(owner, axis, np.array([7, 4, 5, 4])).tolist() == [False, True, False, True]
    assert not of_several_axes(owner[:0], axis[:0], np.array([1])).any()


def test_votes_are_raised_by_what_lifts_the_highest_fifth():
    means = np.arange(10.0)
    votes = np.where(means >= 8.0, means + 0.5, means + 3.0)  # 0 to 7 rise to 3 … 10, above 8.5 and 9.5
    # Of two axes, each as far from the mean, the higher one draws the vote a third of that way.
    level = np.concatenate([means + 3.0 * (votes - means), means - 3.0 * (votes - means)])[:, None]
    owner, axis = np.tile(np.arange(10), 2), np.repeat([0, 1], 10)
    assert raised(level, owner, axis) == pytest.approx((10.0 + 9.5) / 2.0 - 8.5)
    assert raised(np.tile(means, 2)[:, None], owner, axis) == 0.0
    assert raised(level, owner, np.zeros(20, np.int64)) == 0.0
    assert raised(np.empty((0, 1)), owner[:0], axis[:0]) == 0.0


def test_a_fifth_of_six_records_is_two():
    # Axes 3 apart raise a vote of 2 : 1 by 0.5, and those of the highest record, which say the same, by nothing.
    level = np.array([9.0, 9.0, *np.ravel([[k - 1.5, k + 1.5] for k in range(5)])])[:, None]
    owner, axis = np.repeat(np.arange(6), 2), np.tile([0, 1], 6)
    assert raised(level, owner, axis) == pytest.approx((0.0 + 0.5) / 2.0)


def test_a_vote_is_raised_by_the_column_that_is_highest_in_it():
    owner, axis = np.array([0, 0]), np.array([0, 1])
    level = np.array([[0.0, 6.0], [3.0, 0.0]])  # axis 0 counts twice: (1, 4), where plain means are (1.5, 3)
    assert raised(level, owner, axis) == pytest.approx(1.0)


def test_rows_of_records_that_are_not_asked_for_are_left_out():
    found = averaged(np.array([0.8, 0.2, 0.9]), np.array([3, 3, 5]), np.array([3]))
    assert found == pytest.approx([0.5])


def test_of_axes_with_unlike_numbers_of_windows_the_higher_mean_counts_twice():
    shares = vote_shares(np.array([0.6, 0.6, 1.0]), np.array([4, 4, 4]), np.array([0, 0, 1]))
    assert shares == pytest.approx([1 / 6, 1 / 6, 2 / 3])


def test_of_few_records_the_highest_alone_says_by_how_much_votes_are_raised():
    # The plain means of four records are 0, 1, 2 and 3; the higher axis draws each vote a third of 3, 6, 9 and 12 up.
    means, apart = np.arange(4.0), np.array([3.0, 6.0, 9.0, 12.0])
    level = np.concatenate([means + apart, means - apart])[:, None]
    owner, axis = np.tile(np.arange(4), 2), np.repeat([0, 1], 4)
    assert raised(level, owner, axis) == pytest.approx(4.0)


def test_no_record_asked_for_has_no_mean():
    assert averaged(np.array([0.8, 0.2]), np.array([3, 5]), np.empty(0, np.int64)).shape == (0,)


def test_shares_count_beside_each_other_whatever_their_sum():
    found = averaged(np.array([8.0, 4.0]), np.array([7, 7]), np.array([7]), np.array([0.3, 0.1]))
    assert found == pytest.approx([7.0])


def test_records_of_a_single_axis_have_no_say_in_how_much_a_vote_raises():
    level = np.array([[9.0], [8.0], [0.0], [6.0]])  # of record 2 the higher axis draws the vote from 3 to 4
    assert raised(level, np.array([0, 1, 2, 2]), np.array([0, 0, 0, 1])) == pytest.approx(1.0)


def test_the_loudest_axis_is_the_one_whose_highest_column_is_highest():
    # Axis 0 counts twice, for its 6, though both columns of axis 1 are higher on average: 17/3 where the mean has 5.5.
    assert raised(np.array([[0.0, 6.0], [5.0, 5.0]]), np.array([0, 0]), np.array([0, 1])) == pytest.approx(1.0 / 6.0)
