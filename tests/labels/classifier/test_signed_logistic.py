"""Logistic regression with signs, against scikit-learn's where no sign is asked for."""

import warnings

import numpy as np
import pytest
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LogisticRegression

from labels.classifier.signed_logistic import C, SignedLogistic


@pytest.fixture
def table():
    """Rows (400, 3) and classes (400,): the first feature raises class 1, the second lowers it, the third is noise."""
    generator = np.random.default_rng(3)
    rows = generator.standard_normal((400, 3))
    odds = 1.5 * rows[:, 0] - 1.0 * rows[:, 1] - 0.8
    return rows, np.where(generator.random(400) < 1.0 / (1.0 + np.exp(-odds)), "spall", "healthy")


def test_without_signs_it_is_the_usual_regression(table):
    rows, classes = table
    own = SignedLogistic().fit(rows, classes)
    usual = LogisticRegression(C=C, class_weight="balanced", tol=1e-8).fit(rows, classes)
    # Two minimisers of one convex function; they stop at gradients of 1e-5 of its curvature.
    np.testing.assert_allclose(own.coef_, usual.coef_[0], atol=1e-3)
    np.testing.assert_allclose(own.predict_proba(rows), usual.predict_proba(rows), atol=1e-3)


def test_a_coefficient_keeps_its_sign_and_others_are_free(table):
    rows, classes = table
    held = SignedLogistic((-1, 1, 0)).fit(rows, classes)
    assert held.coef_[:2].tolist() == [0.0, 0.0]  # both would go the other way
    assert held.coef_[2] != 0.0
    agreed = SignedLogistic((1, -1, 0)).fit(rows, classes)
    assert agreed.coef_[0] > 0.0 > agreed.coef_[1]


def test_probabilities_stay_probabilities_however_far_the_row(table):
    far = SignedLogistic().fit(*table).predict_proba(np.array([[1e6, 0.0, 0.0], [-1e6, 0.0, 0.0]]))
    np.testing.assert_allclose(far, [[0.0, 1.0], [1.0, 0.0]], atol=1e-9)


def test_a_fit_that_is_stopped_at_its_step_limit_warns_and_a_finished_one_does_not(table, monkeypatch):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SignedLogistic((1, -1, 0)).fit(*table)
    monkeypatch.setattr("labels.classifier.signed_logistic.MOST_STEPS", 1)
    with pytest.warns(ConvergenceWarning, match="did not converge: .*LIMIT"):
        SignedLogistic((1, -1, 0)).fit(*table)
