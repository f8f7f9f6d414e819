"""Intervals from a bootstrap over bearings."""

import math

import numpy as np
import pytest

from datagen.sizing.bearing_intervals import interval_over_bearings


@pytest.mark.parametrize("bearings", [2, 3, 40])
def test_a_share_of_none_or_all_has_the_interval_that_the_number_of_bearings_allows(bearings):
    owner = np.repeat(np.arange(bearings), 5)
    unseen = 1.0 - 0.05 ** (1.0 / bearings)  # that share of bearings is not seen in so many once in twenty
    none, every = np.zeros(owner.size), np.ones(owner.size)
    assert interval_over_bearings(none, owner, is_share=True) == pytest.approx((0.0, unseen))
    assert interval_over_bearings(every, owner, is_share=True) == pytest.approx((1.0 - unseen, 1.0))
    # Bearings without weight, as of records without events, tell nothing.
    weights = np.where(owner < 2, 3.0, 0.0)
    assert interval_over_bearings(none, owner, weights, is_share=True) == pytest.approx((0.0, 1.0 - 0.05**0.5))


def test_bearings_are_drawn_with_all_their_records():
    owner = np.repeat(np.arange(400), 10)
    values = np.repeat(np.random.default_rng(1).normal(3.0, 1.0, 400), 10)
    low, high = interval_over_bearings(values, owner, is_share=False)
    assert high - low == pytest.approx(2 * 1.645 * values.std() / math.sqrt(400), rel=0.06)


def test_one_bearing_has_no_interval():
    assert all(map(math.isnan, interval_over_bearings(np.ones(3), np.zeros(3, dtype=np.int64), is_share=True)))


def test_draws_of_bearings_without_weight_tell_nothing():
    ends = interval_over_bearings(np.array([6.0, 0.0]), np.array([0, 1]), np.array([3.0, 0.0]), is_share=False)
    assert ends == (2.0, 2.0)


@pytest.mark.parametrize("same", [0.0, 1.0])
def test_errors_that_are_all_the_same_are_no_share(same):
    assert interval_over_bearings(np.full(10, same), np.arange(10), is_share=False) == (same, same)
