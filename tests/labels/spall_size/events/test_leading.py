"""Which pairs of candidates lead."""

import numpy as np

from labels.spall_size.events.leading import DISTINCT, LEADING, leading_order
from labels.spall_size.events.pairs import Pairs


def _pairs(lag):
    lag = np.asarray(lag, dtype=float)
    return Pairs(np.zeros(lag.size), lag, lag, np.zeros((lag.size, 1)))


def test_of_pairs_of_nearly_one_lag_the_best_leads_alone():
    order = leading_order(_pairs([100.0, 101.0, 50.0, 99.0, 200.0]), np.array([0.5, 0.9, 0.7, 0.8, 0.1]))
    assert order.tolist() == [1, 2, 4]


def test_no_more_lead_than_are_judged_and_all_differ():
    generator = np.random.default_rng(1)
    pairs, score = _pairs(generator.uniform(5.0, 500.0, 300)), generator.random(300)
    order = leading_order(pairs, score)
    assert order.size == LEADING
    assert np.all(np.diff(score[order]) < 0.0)
    assert np.diff(np.sort(np.log(pairs.lag[order]))).min() > DISTINCT


def test_lags_five_hundredths_apart_are_two_and_of_equal_scores_the_first_leads():
    order = leading_order(_pairs([100.0, 105.0, 95.0, 200.0]), np.full(4, 0.5))
    assert order.tolist() == [0, 2, 3]  # log(1.05) is 0.049, log(0.95) −0.051
