"""What is said of a fit: how many records stay silent, and how wrong the others are."""

from __future__ import annotations

import numpy as np

from datagen.sizing.cross_fit import CrossFit


def test_silence_is_the_share_above_the_most_and_the_error_is_that_of_the_others() -> None:
    error = np.array([0.02, 0.04, 0.06, 2.0])
    said = CrossFit(error, expected=np.array([0.1, 0.2, 0.3, 0.9]), most=0.44).lines()
    assert said[0] == "4 records ask for a size: with 0.44 at most 25.0% get none, lag error 4.0%"


def test_a_larger_share_answered_takes_the_next_in_order_of_the_expected_error() -> None:
    error = np.concatenate([[1.0], np.full(80, 0.01), np.full(19, 0.06)])  # the first is the least trusted
    expected = np.concatenate([[9.0], np.linspace(0.0, 0.1, 80), np.linspace(0.2, 0.3, 19)])
    said = CrossFit(error, expected, most=0.1).lines()[1]
    # 80 at 1 %; then (0.8 + 0.06 k) / (80 + k) for k of 5, 10, 15 and 18
    assert said == "lag error by share answered: 80%: 1.0%, 85%: 1.3%, 90%: 1.6%, 95%: 1.8%, 98%: 1.9%"


def test_no_records_are_no_error() -> None:
    assert "nan%" in CrossFit(np.zeros(0), np.zeros(0), 0.5).lines()[0]


def test_the_most_is_as_large_as_the_error_of_what_is_answered_allows() -> None:
    error, expected = np.array([0.06, 0.02, 0.04, 1.0]), np.array([0.3, 0.1, 0.2, 0.9])
    assert CrossFit(error, expected, most=1.0).most_within(0.04) == 0.3  # (0.02 + 0.04 + 0.06) / 3
    assert CrossFit(error, expected, most=1.0).most_within(0.039) == 0.2
    assert CrossFit(error, expected, most=0.25).most_within(0.04) == 0.25
    assert CrossFit(error, expected, most=1.0).most_within(1.0) == 1.0
    assert CrossFit(error, expected, most=1.0).most_within(0.01) == 0.1
    assert CrossFit(error, expected, most=0.3).most_within(0.039) == 0.2  # what is at the limit is given a size
    assert CrossFit(np.zeros(0), np.zeros(0), most=0.4).most_within(0.01) == 0.4
