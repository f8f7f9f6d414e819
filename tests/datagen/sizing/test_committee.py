"""Regressions that speak together, and of groups that they were not fitted to."""

from __future__ import annotations

import numpy as np
import pytest

from datagen.sizing.committee import Committee

STEPS = {"max_iter": 20, "min_samples_leaf": 5}


def test_every_group_is_predicted_by_a_fit_that_has_not_seen_it() -> None:
    groups = np.repeat(["a", "b", "c"], 40)
    rows = np.repeat([[0.0], [1.0], [2.0]], 40, axis=0)
    aim = np.repeat([10.0, 20.0, 30.0], 40)
    predicted = Committee(1, STEPS).out_of_fold(rows, aim, np.ones(120, dtype=np.bool_), groups)
    for group, own in (("a", 10.0), ("b", 20.0), ("c", 30.0)):
        assert np.all(np.abs(predicted[groups == group] - own) > 2.0)  # a fit that had seen it would be off by below 2


def test_rows_that_are_not_used_teach_nothing_but_are_predicted() -> None:
    groups = np.repeat([f"{k}" for k in range(12)], 10)
    rows, aim = np.zeros((120, 1)), np.where(np.arange(120) % 2 == 0, 1.0, 1000.0)
    predicted = Committee(1, STEPS).out_of_fold(rows, aim, np.arange(120) % 2 == 0, groups)
    assert predicted == pytest.approx(np.ones(120))


def test_members_see_other_columns_and_their_mean_is_predicted() -> None:
    generator = np.random.default_rng(3)
    rows = generator.standard_normal((300, 6)).astype(np.float32)
    aim = rows[:, 0] + rows[:, 1] + 0.5 * generator.standard_normal(300)
    settings = STEPS | {"max_features": 0.3}
    one, several = (Committee(members, settings).fit(rows, aim) for members in (1, 3))
    assert several.root.size == 3 * one.root.size
    assert not np.allclose(several.predict(rows), one.predict(rows))
    fresh = generator.standard_normal((2000, 6)).astype(np.float32)
    truth = fresh[:, 0] + fresh[:, 1]
    errors = [float(np.mean((trees.predict(fresh) - truth) ** 2)) for trees in (one, several)]
    assert errors[1] < errors[0]
