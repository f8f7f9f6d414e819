"""Learners that answer together."""

import numpy as np
import pytest
from sklearn.linear_model import LogisticRegression

from labels.classifier.blend import Blend


def made_up(size, seed):
    generator = np.random.default_rng(seed)
    answer = np.arange(size) % 2 == 1
    return generator.standard_normal((size, 2)) + 1.5 * answer[:, None], answer


def test_the_log_odds_of_a_blend_are_the_mean_of_those_of_its_parts():
    table, answer = made_up(200, 1)
    parts = LogisticRegression(C=1.0), LogisticRegression(C=1e-3)
    found = Blend(parts).fit(table, answer).predict_proba(table)
    alone = [part.fit(table, answer).predict_proba(table) for part in parts]
    odds = [np.log(own[:, 1] / own[:, 0]) for own in (found, *alone)]
    unclipped = np.abs(odds[1]) < 9.0  # log odds beyond 9.2 count as 9.2
    np.testing.assert_allclose(odds[0][unclipped], 0.5 * (odds[1] + odds[2])[unclipped], atol=1e-9)
    np.testing.assert_allclose(found.sum(axis=1), 1.0, rtol=1e-12)


def test_a_blend_finds_the_likelier_class():
    table, answer = made_up(200, 2)
    blend = Blend((LogisticRegression(),)).fit(table, answer)
    # Two features with means 1.5 standard deviations apart leave 14 % errors.
    assert np.mean((blend.predict_proba(table)[:, 1] > 0.5) == answer) == pytest.approx(0.86, abs=0.06)


def test_the_parts_given_stay_as_they_are():
    part = LogisticRegression()
    Blend((part,)).fit(*made_up(50, 3))
    assert not hasattr(part, "coef_")
