"""Scores against counts by hand, and intervals against the binomial distribution."""

import math

import numpy as np
import pytest
from scipy.stats import binomtest

from labels.classifier.scores import (
    accuracy,
    accuracy_against,
    area_interval,
    area_under_roc,
    balanced_accuracy,
    bootstrap,
    confusion,
    exact_interval,
    paired_difference,
    unseen_share,
)


def test_balanced_accuracy_is_the_mean_over_classes_not_over_records():
    truth = np.array(["outer"] * 8 + ["inner"] * 2)
    said = np.array(["outer"] * 8 + ["outer", "inner"])
    assert balanced_accuracy(truth, said) == 0.75
    assert accuracy(truth, said) == 0.9
    assert balanced_accuracy(truth, said, ("outer", "none")) == 1.0


def test_the_area_under_the_roc_counts_pairs_in_order_and_ties_half():
    positive = np.array([True, True, False, False])
    assert area_under_roc(positive, np.array([3.0, 1.0, 2.0, 0.0])) == 0.75
    assert area_under_roc(positive, np.zeros(4)) == 0.5
    assert math.isnan(area_under_roc(np.array([True, True]), np.zeros(2)))


def test_the_bootstrap_interval_of_a_share_is_the_binomial_one():
    truth = np.array(["a"] * 100)
    said = np.array(["a"] * 80 + ["b"] * 20)
    found = bootstrap(accuracy, truth, said)
    # Standard deviation sqrt(0.8 · 0.2 / 100) = 0.04, so 0.72 to 0.88; 2000 draws give the ends to 0.005.
    assert found.value == pytest.approx(0.8)
    assert found.low == pytest.approx(0.72, abs=0.015)
    assert found.high == pytest.approx(0.88, abs=0.015)


@pytest.mark.parametrize("wrong", [0, 20])
def test_where_all_are_right_or_all_wrong_the_interval_is_the_exact_binomial_one(wrong):
    truth, said = np.array(["a"] * 20), np.array(["a"] * (20 - wrong) + ["b"] * wrong)
    exact = binomtest(20 - wrong, 20).proportion_ci()
    found = bootstrap(accuracy, truth, said)
    assert (found.low, found.high) == pytest.approx((exact.low, exact.high))
    assert found.value == 1.0 - wrong / 20


def test_two_classes_that_are_all_right_bound_their_mean_by_both():
    truth = np.array(["a"] * 10 + ["b"] * 7)
    found = bootstrap(balanced_accuracy, truth, truth, strata=truth)
    # The least mean of two shares under which ten and seven successes still happen once in forty, on a fine grid.
    first = np.linspace(0.5, 1.0, 20_001)
    second = (0.025 / first**10) ** (1.0 / 7.0)
    assert found.high == 1.0
    assert found.low == pytest.approx(np.min((first + second)[second <= 1.0] / 2.0), abs=1e-6)


def test_a_class_all_right_beside_one_all_wrong_leaves_room_to_both_sides():
    truth = np.array(["a"] * 10 + ["b"] * 10)
    found = bootstrap(balanced_accuracy, truth, np.full(20, "a"), strata=truth)
    assert found.value == 0.5
    # At least what the class all wrong alone may gain, and no more than both classes' doubt together.
    assert 0.5 + 0.5 * (1.0 - 0.025 ** (1.0 / 10.0)) < found.high <= 0.5 + (1.0 - 0.025 ** (1.0 / 20.0)) + 1e-12
    assert found.low == pytest.approx(1.0 - found.high)


def test_a_class_of_which_all_few_records_are_right_adds_the_doubt_that_their_number_leaves():
    truth = np.array(["a"] * 60 + ["b"] * 3)
    found = bootstrap(balanced_accuracy, truth, np.array(["a"] * 40 + ["b"] * 23), strata=truth)
    many = binomtest(40, 60).proportion_ci(method="wilson")  # near what a bootstrap of 60 gives
    few = 1.0 - 0.025 ** (1.0 / 3.0)
    assert found.value == pytest.approx((40 / 60 + 1.0) / 2.0)
    # Independent doubts add up by their squares; each class has half the weight.
    assert found.value - found.low == pytest.approx(0.5 * math.hypot(40 / 60 - many.low, few), rel=0.03)
    assert found.high == 1.0


def test_a_single_record_of_a_class_leaves_as_much_doubt_whatever_is_said_of_the_others():
    truth = np.array(["a"] * 20 + ["b"])
    lows = []
    for wrong in range(4):
        said = np.array(["b"] * wrong + ["a"] * (20 - wrong) + ["b"])
        lows.append(bootstrap(balanced_accuracy, truth, said, strata=truth).low)
        assert lows[-1] < 0.52  # without that record half of the score is gone
    assert lows == sorted(lows, reverse=True)


def test_a_class_with_records_of_unlike_scores_adds_no_more_than_its_draws():
    truth = np.array(["a"] * 30 + ["b"] * 30)
    said = np.array(["a"] * 20 + ["b"] * 10 + ["b"] * 15 + ["c"] * 15)
    found = bootstrap(balanced_accuracy, truth, said, strata=truth)
    spread = 0.5 * math.sqrt(20 / 30 * 10 / 30 / 30 + 0.25 / 30)  # standard deviation of half the sum of two shares
    assert found.high - found.low == pytest.approx(2 * 1.96 * spread, rel=0.1)


def test_few_records_of_one_class_do_not_hide_that_an_answer_is_worse_in_another():
    truth = np.array(["a"] * 60 + ["b"] * 3)
    said = np.array(["a"] * 40 + ["c"] * 20 + ["b"] * 3)
    found = paired_difference(balanced_accuracy, truth, said, truth, strata=truth)
    assert found.value == pytest.approx(-1 / 6)
    assert found.low < found.value < found.high < 0.0


def test_a_paired_difference_of_equals_is_zero_as_far_as_their_number_says():
    truth = np.array(["a", "b"] * 20)
    said = np.array(["a", "a"] * 20)
    found = paired_difference(accuracy, truth, said, said)
    bound = 1.0 - 0.025 ** (1.0 / 40.0)  # at most that share of pairs differs: none of 40 did
    assert (found.value, found.low, found.high) == pytest.approx((0.0, -bound, bound))


def test_draws_of_one_recording_do_not_count_as_recordings():
    generator = np.random.default_rng(4)
    right = generator.uniform(size=40) < 0.6
    truth, said = np.full(400, "a"), np.where(np.repeat(right, 10), "a", "b")
    once = bootstrap(accuracy, truth[::10], said[::10])
    pooled = bootstrap(accuracy, truth, said, groups=np.repeat(np.arange(40), 10))
    assert (pooled.low, pooled.high) == pytest.approx((once.low, once.high))  # the same draws of the same recordings
    alone = bootstrap(accuracy, truth, said)
    assert pooled.high - pooled.low > 2.5 * (alone.high - alone.low)  # the square root of ten
    rival = np.where(np.repeat(~right, 10), "a", "b")
    grouped = paired_difference(accuracy, truth, said, rival, groups=np.repeat(np.arange(40), 10))
    independent = paired_difference(accuracy, truth, said, rival)
    assert grouped.high - grouped.low > 2.5 * (independent.high - independent.low)


def test_a_difference_is_by_how_much_the_first_answer_is_better():
    truth = np.array(["a"] * 40)
    assert paired_difference(accuracy, truth, truth, np.array(["a", "b"] * 20)).value == 0.5


def test_draws_without_a_score_leave_the_interval_to_the_others():
    positive, score = np.array([True, True, False, False]), np.array([3.0, 1.0, 2.0, 0.0])
    found = bootstrap(area_under_roc, positive, score)  # one draw in eight is of one side alone
    assert 0.0 <= found.low < found.value < found.high <= 1.0
    never = bootstrap(area_under_roc, positive[:2], score[:2])
    assert all(map(math.isnan, (never.value, never.low, never.high)))


def test_a_group_belongs_to_the_stratum_of_its_first_row():
    # The first group is of a, though it ends in b, so the third is drawn alone of b, once in every draw.
    groups, strata = np.array([1, 1, 2, 2, 3, 3]), np.array(["a", "b", "a", "a", "b", "b"])
    drawn = []
    bootstrap(lambda group: drawn.append(int((group == 3).sum())) or 0.0, groups, strata=strata, groups=groups)
    assert set(drawn[:-2]) == {2}


def test_groups_are_drawn_within_their_strata_wherever_their_rows_lie():
    truth = np.array(["a", "b"] * 30)
    groups = np.tile(["a1", "b1", "a2", "b2", "a3", "b3"], 10)
    counts = []
    bootstrap(lambda drawn: counts.append(int((drawn == "a").sum())) or 0.0, truth, strata=truth, groups=groups)
    assert set(counts[:-2]) == {30}  # but for the strata alone


def test_the_area_under_the_roc_has_no_interval_from_fewer_than_five_a_side():
    positive = np.array([True] * 30 + [False] * 4)
    score = np.random.default_rng(0).standard_normal(34) + positive
    found = area_interval(positive, score)
    assert 0.0 < found.value < 1.0
    assert math.isnan(found.low)
    # Ten draws of four records are four.
    assert math.isnan(area_interval(np.tile(positive, 10), np.tile(score, 10), groups=np.tile(np.arange(34), 10)).low)
    assert math.isnan(area_interval(positive, score, np.zeros(34)).high)


def test_an_area_of_one_is_bounded_by_the_smaller_side():
    positive = np.array([True] * 200 + [False] * 8)
    found = area_interval(positive, positive.astype(float))
    # P(pos > neg) of 1 − the exact bound of 0 in 8 is still likely if one healthy record in so many scores highest.
    assert found.low == pytest.approx(0.025 ** (1.0 / 8.0), abs=0.02)  # the larger side adds a little
    assert found.high == 1.0
    same = area_interval(positive, positive.astype(float), positive.astype(float))
    assert (same.value, same.low, same.high) == pytest.approx((0.0, found.low - 1.0, 1.0 - found.low))


def test_the_confusion_counts_rows_of_truth():
    truth, said = np.array(["x", "x", "y"]), np.array(["x", "y", "y"])
    assert confusion(truth, said, ("x", "y"), ("x", "y")).tolist() == [[1, 1], [0, 1]]


@pytest.mark.parametrize(
    ("speeds", "places"),
    [
        ([1772.0, 1772.0 + 1e-10] * 6, [1772.0]),  # but for rounding the same
        ([0.0, 9.6e-16, -4.4e-16] * 4, [0.0]),  # likewise: records of 0 dB
        ([1771.9, 1772.3] * 6, [1772.1]),
        ([900.0] * 6 + [1771.9, 1772.1, 1772.3] * 2, [900.0, 1772.1]),
        ([900.0] * 5 + [1498.6, *[1501.2] * 6], [900.0, 1501.2]),  # none of the second speed falls to the bin before
        ([1730.0, 1750.0, 1772.0, 1797.0] * 3, [1730.0, 1750.0, 1784.5]),
        ([900.0, 1772.0] * 6, [900.0, 1772.0]),  # the largest value has a bin of its own where it fills one
        ([900.0] * 4 + [1200.0] * 4 + [1772.0] * 4, [900.0, 1200.0, 1772.0]),
        ([-10.0, -10.02] * 6, [-10.01]),
        ([1000.0, 1002.9] * 6, [1001.45]),
        ([1000.0] * 6 + [1003.5] * 6, [1000.0, 1003.5]),
        ([0.3] * 4 + [0.6] * 4 + [200.0] * 4, [0.3, 0.6, 200.0]),  # small beside the largest, and not the same
    ],
)
def test_values_that_are_nearly_the_same_share_a_bin(speeds, places):
    table = accuracy_against(np.array(speeds), np.ones(12, dtype=bool), bins=3)
    assert [row["at"] for row in table] == pytest.approx(places)
    assert sum(row["records"] for row in table) == 12


def test_accuracy_against_a_quantity_leaves_unknown_values_out():
    quantity = np.array([1.0, 2.0, 3.0, 4.0, np.nan])
    table = accuracy_against(quantity, np.array([True, True, False, False, False]), bins=2)
    assert [point["accuracy"] for point in table] == [1.0, 0.0]
    assert sum(point["records"] for point in table) == 4


@pytest.mark.parametrize(("count", "total"), [(0, 1), (0, 96), (3, 7), (7, 7), (50, 100)])
def test_the_exact_interval_of_a_count_is_that_of_the_binomial_test(count, total):
    found, share = exact_interval(count, total), binomtest(count, total).proportion_ci()
    assert (found.low, found.high) == pytest.approx((share.low, share.high), rel=1e-9)
    assert found.value == count / total


def test_rows_of_one_record_make_no_interval_narrower():
    right, value = np.random.default_rng(1).random(20) < 0.5, np.arange(20.0)
    (one,) = accuracy_against(value, right, bins=1)
    groups = np.repeat(np.arange(20), 10)
    (ten,) = accuracy_against(np.repeat(value, 10), np.repeat(right, 10), bins=1, groups=groups)
    assert (ten["records"], ten["accuracy"]) == (200, one["accuracy"])
    assert (ten["low"], ten["high"]) == pytest.approx((one["low"], one["high"]))


def test_the_area_under_the_roc_has_an_interval_from_five_a_side_on():
    positive = np.array([True] * 30 + [False] * 5)
    score = np.random.default_rng(0).standard_normal(35) + positive
    found = area_interval(positive, score)
    assert 0.0 < found.low < found.value < found.high <= 1.0
    assert math.isfinite(area_interval(~positive, -score).low)


def test_groups_are_those_of_the_records_whose_quantity_is_known():
    quantity, right = np.array([np.nan] + [1.0] * 20), np.array([False, True] + [False] * 19)
    (row,) = accuracy_against(quantity, right, bins=1, groups=np.array([1, 0] + [1] * 19))
    # Of two groups, all right and all wrong, either may be drawn alone.
    assert (row["records"], row["low"], row["high"]) == (20, 0.0, 1.0)


def test_without_records_nothing_is_known():
    nothing = np.array([])
    assert math.isnan(balanced_accuracy(nothing, nothing))
    assert math.isnan(accuracy(nothing, nothing))
    found = bootstrap(accuracy, nothing, nothing)
    assert all(map(math.isnan, (found.value, found.low, found.high)))


def test_the_smaller_class_bounds_what_was_not_seen_wherever_it_stands():
    # All of the doubt of 0.025 may lie in the class of eight, half of the mean.
    expected = 0.5 * (1.0 - 0.025 ** (1.0 / 8.0))
    assert unseen_share([200, 8]) == pytest.approx(expected)
    assert unseen_share([8, 200]) == pytest.approx(expected)
