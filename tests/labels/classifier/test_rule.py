"""The yardstick finds outer and inner in noise and keeps its false alarms at one in twenty."""

import numpy as np
import pytest

from labels.classifier.rule import QUANTILE, Rule, fit_rule, line_heights, strengths
from labels.features.table import FEATURE_NAMES


def rows(outer, inner):
    table = np.zeros((len(outer), len(FEATURE_NAMES)))
    table[:, FEATURE_NAMES.index("outer_strength")] = np.log(outer)
    table[:, FEATURE_NAMES.index("inner_strength")] = np.log(inner)
    return table


def one_axis(count):
    """Owners and axes of rows that are a record each."""
    return np.arange(count), np.zeros(count, dtype=np.int64)


def two_axes(count):
    """Owners and axes of pairs of rows, each a record."""
    return np.repeat(np.arange(count), 2), np.tile([0, 1], count)


def test_the_threshold_is_passed_by_one_healthy_record_in_twenty():
    healthy = rows(np.exp(np.linspace(1.0, 3.0, 1001)), np.full(1001, 0.5))
    rule = fit_rule(healthy, *one_axis(1001))
    assert np.log(rule.threshold) == pytest.approx(1.0 + 2.0 * QUANTILE)  # the quantile of a uniform distribution
    assert np.mean(rule.locations(strengths(healthy)) != "none") == pytest.approx(0.05, abs=2e-3)
    assert rule.of_several == 1.0


def test_of_healthy_records_the_higher_family_sets_the_threshold_whichever_it_is():
    level, low = np.linspace(1.0, 3.0, 1001), np.full(1001, 0.0)
    by_turns = np.arange(1001) % 2 == 0
    healthy = rows(np.exp(np.where(by_turns, level, low)), np.exp(np.where(by_turns, low, level)))
    rule = fit_rule(healthy, *one_axis(1001))
    assert np.log(rule.threshold) == pytest.approx(1.0 + 2.0 * 0.95)  # either family alone passes 2.8 in 5 % of them


def test_it_names_the_higher_family_and_only_above_the_threshold():
    rule = Rule(1.0)
    assert rule.locations(np.array([[5.0, 2.0], [2.0, 7.0], [0.9, 0.8]])).tolist() == ["outer", "inner", "none"]
    assert rule.races(np.array([[0.9, 0.8]])).tolist() == ["outer"]
    assert rule.locations(np.array([[1.0, 0.5]])).tolist() == ["none"]  # as high as the threshold is not above it


def test_of_two_axes_the_one_with_the_higher_lines_counts_twice_for_both_races():
    table = rows([8.0, 1.0, 4.0], [1.0, 2.0, 3.0])
    owner, axis = np.array([4, 4, 6]), np.array([0, 1, 0])
    # 8 counts twice and 1 once: the cube root of 8 · 8 · 1, and beside it of 1 · 1 · 2.
    expected = np.array([[4.0, 3.0], [4.0, 2.0 ** (1.0 / 3.0)], [np.nan, np.nan]])
    np.testing.assert_allclose(line_heights(table, owner, np.array([6, 4, 5]), axis), expected)
    other = line_heights(rows([2.0, 1.0], [1.0, 16.0]), owner[:2], np.array([4]), axis[:2])
    np.testing.assert_allclose(other, [[2.0 ** (1.0 / 3.0), 256.0 ** (1.0 / 3.0)]])  # here the second says most
    halved = line_heights(table, owner, np.array([6, 4, 5]), axis, of_several=2.0)
    np.testing.assert_allclose(halved, expected * [[1.0], [0.5], [1.0]])


def test_a_vote_of_two_axes_alarms_as_seldom_as_their_mean():
    generator = np.random.default_rng(3)
    level = generator.standard_normal(4000)
    healthy = rows(np.exp(np.repeat(level, 2) + generator.standard_normal(8000)), np.full(8000, 1e-6))
    owner, axis = two_axes(4000)
    rule = fit_rule(healthy, owner, axis)
    heights = line_heights(healthy, owner, np.arange(4000), axis, rule.of_several)
    assert rule.of_several > 1.05
    # 5 % of 4000 records; that the rise is taken from the highest fifth and not at the threshold itself moves 1 %.
    assert np.mean(rule.score(heights) > rule.threshold) == pytest.approx(0.05, abs=0.01)
    assert np.mean(rule.score(heights * rule.of_several) > rule.threshold) > 0.06


def test_without_healthy_records_there_is_no_rule():
    with pytest.raises(ValueError, match="healthy"):
        fit_rule(np.empty((0, len(FEATURE_NAMES))), *one_axis(0))
