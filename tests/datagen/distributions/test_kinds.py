"""Distributions: their quantile functions against closed forms and scipy.stats, and what is refused."""

from __future__ import annotations

import math
from datetime import date
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from datagen.distributions.kinds import (
    DISTRIBUTIONS,
    Balanced,
    Choice,
    DistributionError,
    LogUniform,
    Normal,
    Uniform,
    distribution_schema,
    parse_distribution,
)

EXAMPLES: list[Any] = [
    5.0,
    "outer",
    {"uniform": [2.0, 8.0]},
    {"log_uniform": [0.1, 10.0]},
    {"normal": [5.0, 1.0]},
    {"normal": [5.0, 1.0], "low": 4.0},
    {"normal": [5.0, 1.0], "low": 9.0, "high": 9.5},
    {"choice": ["outer", "inner"], "weights": [3.0, 1.0]},
    {"choice": [1, 2, "both"]},
    {"balanced": ["healthy", "line"], "weights": [1.0, 2.0]},
]
PROBABILITIES = (0.0, 1e-12, 0.1, 0.25, 0.5, 0.9, 1.0 - 2.0**-53)


@pytest.mark.parametrize("example", EXAMPLES)
def test_a_distribution_written_back_to_toml_reads_as_itself(example: Any) -> None:
    distribution = parse_distribution(example)
    assert parse_distribution(distribution.to_toml()) == distribution
    assert distribution.to_toml() == example


@pytest.mark.parametrize(
    ("example", "reference"),
    [
        ({"uniform": [2, 8]}, stats.uniform(2, 6)),
        ({"log_uniform": [0.1, 10]}, stats.loguniform(0.1, 10)),
        ({"normal": [5, 2]}, stats.norm(5, 2)),
        ({"normal": [5, 2], "low": 4}, stats.truncnorm(-0.5, math.inf, 5, 2)),
        ({"normal": [5, 2], "high": 3}, stats.truncnorm(-math.inf, -1.0, 5, 2)),
        ({"normal": [0, 1], "low": 4, "high": 5}, stats.truncnorm(4, 5)),
    ],
)
def test_the_quantile_is_that_of_scipy(example: dict[str, Any], reference: Any) -> None:
    distribution = parse_distribution(example)
    for probability in (1e-6, 0.1, 0.25, 0.5, 0.9, 0.999, 1.0 - 1e-12):
        found = distribution.quantile(probability)
        assert found == pytest.approx(
            reference.ppf(probability), rel=1e-9
        )  # both round a few times in double precision


@pytest.mark.parametrize("example", EXAMPLES)
def test_no_probability_below_one_leaves_what_the_recipe_states(example: Any) -> None:
    distribution = parse_distribution(example)
    stated = distribution.stated()
    for probability in PROBABILITIES:
        value = distribution.quantile(probability)
        if isinstance(value, float):
            assert math.isfinite(value)
            if not isinstance(distribution, Normal):
                assert min(stated) <= value <= max(stated)
        else:
            assert value in stated


@settings(deadline=None, derandomize=True)
@given(st.floats(0.0, 1.0, exclude_max=True), st.floats(0.0, 1.0, exclude_max=True))
def test_quantiles_never_fall(one: float, other: float) -> None:
    low, high = sorted((one, other))
    for example in EXAMPLES[2:7]:
        distribution = parse_distribution(example)
        assert distribution.quantile(low) <= distribution.quantile(high)


def test_weights_are_shares_and_a_weight_of_zero_is_never_drawn() -> None:
    choice = parse_distribution({"choice": ["a", "b", "c", "d"], "weights": [0, 3, 1, 0]})
    assert [choice.quantile(p) for p in (0.0, 0.74, 0.76, 1.0 - 2.0**-53)] == ["b", "b", "c", "c"]


def test_equal_choices_come_equally_often() -> None:
    choice = parse_distribution({"choice": [1, 2, 3, 4]})
    drawn = [choice.quantile((k + 0.5) / 400) for k in range(400)]
    assert [drawn.count(value) for value in (1, 2, 3, 4)] == [100] * 4


def test_a_block_of_a_balanced_setting_holds_each_option_as_often_as_its_weight() -> None:
    balanced = Balanced(("a", "b", "c"), (1.0, 0.0, 3.0))
    assert balanced.block == 4
    for seed in range(5):
        assert sorted(balanced.shuffled(np.random.default_rng(seed))) == [0, 2, 2, 2]


def test_a_block_of_a_balanced_setting_may_be_a_thousand_long() -> None:
    longest = parse_distribution({"balanced": ["a", "b"], "weights": [1, 999]})
    assert isinstance(longest, Balanced)
    assert longest.block == 1000


def test_a_normal_distribution_is_cut_off_by_its_own_bounds_and_by_those_of_its_setting() -> None:
    open_above = Normal(5.0, 1.0, low=4.0)
    assert open_above.within(3.0, 6.0) == Normal(5.0, 1.0, 4.0, 6.0)
    assert Normal(5.0, 1.0, 4.0, 6.0).within(4.5, 7.0) == Normal(5.0, 1.0, 4.5, 6.0)


def test_a_normal_distribution_states_its_bounds_and_its_mean_unless_both_ends_are_cut_off() -> None:
    assert Normal(5.0, 1.0).stated() == (5.0,)
    assert set(Normal(5.0, 1.0, low=4.0).stated()) == {4.0, 5.0}
    assert set(Normal(5.0, 1.0, high=4.0).stated()) == {4.0, 5.0}
    assert set(Normal(5.0, 1.0, 9.0, 9.5).stated()) == {9.0, 9.5}  # draws come nowhere near the mean


def test_rounding_takes_no_draw_beyond_the_ends() -> None:
    for distribution in (Normal(0.0, 2.0, 0.3, 0.7), Normal(0.0, 2.0, -4.0, 4.0), LogUniform(0.7, 1.7)):
        ends = distribution.stated()
        drawn = [distribution.quantile(probability) for probability in PROBABILITIES]
        assert min(ends) <= min(drawn) <= max(drawn) <= max(ends)


@pytest.mark.parametrize(
    ("example", "message"),
    [
        ({"uniform": [8, 2]}, "the smaller number comes first"),
        ({"uniform": [2, 2]}, "the smaller number comes first"),
        ({"uniform": [2]}, "a list of two numbers"),
        ({"uniform": 2}, "a list of two numbers"),
        ({"uniform": [1, "2"]}, "a finite number"),
        ({"uniform": [1, True]}, "a finite number"),
        ({"uniform": [1, math.inf]}, "a finite number"),
        ({"log_uniform": [0, 1]}, "must be above 0"),
        ({"normal": [1, -2]}, "standard deviation must be above 0"),
        ({"normal": [1, 0]}, "standard deviation must be above 0"),
        ({"normal": [1, 2], "low": 3, "high": 2}, "low must be below high"),
        ({"normal": [1, 2], "low": 3, "high": 3}, "low must be below high"),
        ({"normal": [0, 1], "low": 4.76}, "less than one draw in a million"),  # 0.97 of a million
        ({"normal": [1, 2], "low": 30}, "less than one draw in a million"),
        ({"normal": [1, 2], "lo": 0}, 'did you mean "low"'),
        ({"choice": []}, "at least one value"),
        ({"choice": [[1], 2]}, "plain values"),
        ({"choice": [1, 2], "weights": [1]}, "one weight each"),
        ({"choice": [1, 2], "weights": [0, 0]}, "their sum must be above 0"),
        ({"choice": [1, 2], "weights": [-1, 2]}, "below 0"),
        ({"choice": [1, 2], "weights": [1e308, 1e308]}, "their sum is too large"),
        ({"choice": [1, 2], "weights": 3}, "a list of numbers"),
        ({"balanced": ["a", "b"], "weights": [0.5, 1]}, "whole numbers"),
        ({"uniform": [0] * 1000}, r"^uniform = \[(0, ?)+\.\.\.: give a list of two numbers"),
        ({"normal": [True, {"a": 1}]}, "^normal = true: give a finite number"),
        ({"balanced": ["a", "b"], "weights": [1, 1000]}, "add up to 1001: balanced takes at most 1000"),
        ({"balanced": ["a", "b"], "weight": [1, 2]}, 'did you mean "weights"'),
        ({"unifrom": [1, 2]}, 'did you mean "uniform"'),
        ({"balance": [1, 2]}, 'did you mean "balanced"'),
        ({"truncated_normal": [1, 2]}, 'did you mean "normal"'),
        ({"uniform": [1, 2], "normal": [1, 2]}, "give one of"),
        ({}, "give one of"),
        (math.nan, "neither a finite number"),
        ([1, 2], "neither a finite number"),
        (None, "neither a finite number"),
        (["fan", 2.5], r'^\["fan", 2.5\] is neither a finite number'),
        (date(2024, 1, 1), "^2024-01-01 is neither a finite number"),
    ],
)
def test_a_badly_written_distribution_is_refused_with_what_is_wrong(example: Any, message: str) -> None:
    with pytest.raises(DistributionError, match=message):
        parse_distribution(example)


def test_a_normal_distribution_may_be_cut_down_to_one_draw_in_a_million() -> None:
    assert stats.norm.sf(4.75) == pytest.approx(1.017e-6, rel=1e-3)
    assert parse_distribution({"normal": [0, 1], "low": 4.75}).quantile(0.0) == pytest.approx(4.75)


def test_the_schema_of_a_number_names_every_distribution_and_that_of_a_word_only_lists() -> None:
    number = distribution_schema({"type": "number"})["anyOf"]
    names = [next(iter(option["properties"])) for option in number[1:]]
    assert names == [kind.keys[0] for kind in DISTRIBUTIONS]
    word = distribution_schema({"enum": ["a", "b"]})["anyOf"]
    assert word[0] == {"enum": ["a", "b"]}
    assert [next(iter(option["properties"])) for option in word[1:]] == ["choice", "balanced"]


def test_the_extremes_of_a_normal_distribution_are_its_ends_where_draws_come_near_them_and_else_its_mean() -> None:
    cut, open_ended = Normal(12.0, 4.0, 4.0, 20.0), Normal(9000.0, 500.0, 1e-3, 1e7)
    assert (cut.lowest, cut.highest) == (4.0, 20.0)
    assert (open_ended.lowest, open_ended.highest) == (9000.0, 9000.0)
    assert (Uniform(2.0, 8.0).lowest, Uniform(2.0, 8.0).highest) == (2.0, 8.0)
    assert (Choice((3, 1, 2)).lowest, Choice((3, 1, 2)).highest) == (1.0, 3.0)
