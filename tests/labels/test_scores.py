"""Scores against counts by hand, and intervals against the binomial distribution."""

import math

import numpy as np
import pytest

from labels.scores import (
    accuracy,
    accuracy_against,
    area_under_roc,
    balanced_accuracy,
    bootstrap,
    calibration_error,
    confusion,
    paired_difference,
    reliability,
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


def test_a_paired_difference_of_equals_is_zero_without_scatter():
    truth = np.array(["a", "b"] * 20)
    said = np.array(["a", "a"] * 20)
    found = paired_difference(accuracy, truth, said, said)
    assert (found.value, found.low, found.high) == (0.0, 0.0, 0.0)


def test_the_confusion_counts_rows_of_truth():
    truth, said = np.array(["x", "x", "y"]), np.array(["x", "y", "y"])
    assert confusion(truth, said, ("x", "y"), ("x", "y")).tolist() == [[1, 1], [0, 1]]


def test_calibrated_probabilities_lie_on_the_diagonal():
    generator = np.random.default_rng(0)
    probability = generator.uniform(0.0, 1.0, 20_000)
    positive = generator.uniform(0.0, 1.0, 20_000) < probability
    curve = reliability(positive, probability)
    # 2000 records a bin: shares scatter by 1.1 % at most.
    np.testing.assert_allclose(curve["observed"], curve["predicted"], atol=0.04)
    assert calibration_error(positive, probability) < 0.02
    assert calibration_error(~positive, probability) > 0.3


def test_accuracy_against_a_quantity_leaves_unknown_values_out():
    quantity = np.array([1.0, 2.0, 3.0, 4.0, np.nan])
    table = accuracy_against(quantity, np.array([True, True, False, False, False]), bins=2)
    assert [point["accuracy"] for point in table] == [1.0, 0.0]
    assert sum(point["records"] for point in table) == 4
