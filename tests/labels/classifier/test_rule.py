"""The yardstick finds outer and inner in noise and keeps its false alarms at one in twenty."""

import numpy as np
import pytest

from labels.classifier.rule import QUANTILE, fit_rule
from labels.features.table import FEATURE_NAMES


def rows(outer, inner):
    table = np.zeros((len(outer), len(FEATURE_NAMES)))
    table[:, FEATURE_NAMES.index("outer_strength")] = np.log(outer)
    table[:, FEATURE_NAMES.index("inner_strength")] = np.log(inner)
    return table


def test_the_threshold_is_passed_by_one_healthy_record_in_twenty():
    healthy = rows(np.linspace(1.0, 3.0, 1001), np.full(1001, 0.5))
    rule = fit_rule(healthy)
    assert rule.threshold == pytest.approx(1.0 + 2.0 * QUANTILE, rel=1e-6)  # the quantile of a uniform distribution
    assert np.mean(rule.locations(healthy) != "none") == pytest.approx(0.05, abs=2e-3)


def test_it_names_the_higher_family_and_only_above_the_threshold():
    rule = fit_rule(rows(np.ones(50), np.ones(50)))
    assert rule.locations(rows([5.0, 2.0, 0.9], [2.0, 7.0, 0.8])).tolist() == ["outer", "inner", "none"]
    assert rule.races(rows([0.9], [0.8])).tolist() == ["outer"]


def test_without_healthy_records_there_is_no_rule():
    with pytest.raises(ValueError, match="healthy"):
        fit_rule(np.empty((0, len(FEATURE_NAMES))))
