"""Reliability of probabilities drawn to be right."""

import numpy as np
import pytest

from labels.classifier.reliability import calibration_error, equal_priors, reliability


def test_calibrated_probabilities_lie_on_the_diagonal():
    generator = np.random.default_rng(0)
    probability = generator.uniform(0.0, 1.0, 20_000)
    positive = generator.uniform(0.0, 1.0, 20_000) < probability
    curve = reliability(positive, probability)
    # 2000 records a bin: shares scatter by 1.1 % at most.
    np.testing.assert_allclose(curve["observed"], curve["predicted"], atol=0.04)
    assert calibration_error(positive, probability) < 0.02
    assert calibration_error(~positive, probability) > 0.3


def test_probabilities_under_equal_priors_are_calibrated_whatever_the_prevalence():
    generator = np.random.default_rng(1)
    even = generator.uniform(size=40_000) < 0.5
    # Scores of two normal distributions one apart either way: ln of the odds, under equal priors, is twice the score.
    score = generator.standard_normal(even.size) + np.where(even, 1.0, -1.0)
    probability = 1.0 / (1.0 + np.exp(-2.0 * score))
    kept = ~even | (generator.uniform(size=even.size) < 0.1)
    positive, probability = even[kept], probability[kept]
    # The fewest records of a bin are about 50 positives, whose weight is ten: 1.5 % over all bins.
    assert calibration_error(positive, probability) < 0.03
    assert equal_priors(positive).sum() == pytest.approx(positive.size)


def test_a_certainty_is_of_the_last_bin():
    curve = reliability(np.array([True, False, True]), np.array([1.0, 0.05, 0.95]))
    assert curve["records"] == [1.0, 2.0]
    assert curve["predicted"] == pytest.approx([0.05, 0.975])


def test_of_a_bin_the_mean_of_what_was_predicted_weighs_like_that_of_what_was_there():
    curve = reliability(np.array([True, False, False, False]), np.array([0.41, 0.49, 0.95, 0.95]))
    # One record that is positive weighs as much as the three that are not.
    assert (curve["predicted"][0], curve["observed"][0]) == (pytest.approx(0.43), pytest.approx(0.75))
    assert (curve["records"], curve["weight"]) == ([2.0, 2.0], pytest.approx([8 / 3, 4 / 3]))


def test_without_records_there_is_no_error_of_calibration():
    assert np.isnan(calibration_error(np.zeros(0, dtype=bool), np.zeros(0)))
