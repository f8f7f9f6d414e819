"""The learning curve on made-up rows."""

from dataclasses import replace

import numpy as np
import pytest

from datagen.benchmark.learning_curve import learning_curve
from datagen.benchmark.options import Learning
from datagen.benchmark.rows import Rows, joined
from datagen.benchmark.training import ROWS_TO_TRY, TrainingSet
from datagen.benchmark.verdicts import vote
from datagen.progress import Listener
from labels.classifier.classes import CLASSES
from labels.features.table import FEATURE_NAMES


def made_up(bearings, classes=CLASSES):
    """Two records of each bearing, each of two axes as they are and one in noise, in which nothing is seen."""
    generator = np.random.default_rng(3)
    records = np.repeat(np.arange(2 * bearings), 3)
    own = np.array(classes)[(records + records // 2) % len(classes)]
    table = generator.standard_normal((records.size, len(FEATURE_NAMES)))
    noisy = np.tile([False, False, True], 2 * bearings)
    table[:, FEATURE_NAMES.index("outer_evidence")] += 4.0 * ((own != "healthy") & ~noisy)
    table[:, FEATURE_NAMES.index("race_evidence")] += 4.0 * (np.char.endswith(own, "outer") & ~noisy)
    axes = np.tile([0, 1, 0], 2 * bearings)
    return TrainingSet(Rows(table, records, axes, noisy), own, np.char.add("b", (records // 2).astype(str)))


def test_a_subset_keeps_what_is_known_of_each_row():
    whole = made_up(6)
    part = whole.subset(np.arange(len(whole.rows)) % 5 == 2)
    assert len(part.rows) == 7
    for name in ("classes", "bearings"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[2::5])
    for name in ("table", "record", "axis", "noisy"):
        np.testing.assert_array_equal(getattr(part.rows, name), getattr(whole.rows, name)[2::5])


def test_axes_of_held_out_records_are_told_apart(monkeypatch):
    heard = []

    def said(model, rows, records):
        heard.append(rows.axis)
        return vote(model, rows, records)

    monkeypatch.setattr("datagen.benchmark.learning_curve.vote", said)
    learning_curve(made_up(20), Learning("logistic"))
    assert heard
    assert all(axis.tolist() == [0, 1] * (axis.size // 2) for axis in heard)


def test_points_are_of_different_shares_and_records_without_noise():
    points = learning_curve(made_up(60), Learning("logistic"))["logistic"]
    assert [point["bearings"] for point in points] == [10, 11, 22, 45]
    # A shift of four standard deviations is hardly ever missed, and never seen in the noisy third of the rows.
    assert points[-1]["value"] > 0.8


def test_few_bearings_leave_one_point_and_a_wide_interval():
    (point,) = learning_curve(made_up(12), Learning("logistic"))["logistic"]
    assert point["bearings"] == 9
    assert point["high"] - point["low"] > 0.2  # three bearings


def test_shares_that_cannot_be_learned_from_are_left_out_and_told():
    few, told = made_up(60), []
    healthy = ~np.isin(few.bearings, ["b58", "b59"])
    one_class = replace(few, classes=np.where(healthy, "healthy", few.classes))
    assert learning_curve(one_class, Learning("logistic"), listener=Listener(say=told.append)) == {}
    assert [line.partition(" virtual")[0] for line in told] == [
        f"learning curve: none from {bearings}" for bearings in (10, 11, 22, 45)
    ]
    assert all("cannot learn" in line for line in told)


def test_more_records_of_the_same_bearings_make_no_interval_narrower():
    one = made_up(40)
    copies = range(4)
    more = TrainingSet(
        joined([replace(one.rows, record=one.rows.record + 1000 * copy) for copy in copies]),
        np.tile(one.classes, len(copies)),
        np.tile(one.bearings, len(copies)),
    )
    once, often = (learning_curve(training, Learning("logistic"))["logistic"][-1] for training in (one, more))
    # Half as wide if records were drawn; what is learned from four copies differs a little.
    assert often["high"] - often["low"] > 0.8 * (once["high"] - once["low"]) > 0.04


class Listens:
    """Learns nothing, says "healthy", and keeps the rows that it learned from and those that it was asked about."""

    learned, asked = [], []

    def fit(self, table, classes):
        self.learned.append(table)

    def predict(self, table):
        self.asked.append(table)
        return np.full(len(table), "healthy")


def test_rows_in_noise_are_learned_from_and_not_judged():
    whole = made_up(60)
    noise = FEATURE_NAMES.index("kurtosis")
    whole.rows.table[:, noise] = whole.rows.noisy
    Listens.learned.clear()
    Listens.asked.clear()
    learning_curve(whole, Learning(), estimator=Listens())
    assert [table[:, noise].mean() for table in Listens.learned] == pytest.approx([1 / 3] * 4)
    judged = [table for table in Listens.asked if len(table) > ROWS_TO_TRY]
    assert [len(table) for table in judged] == [15 * 2 * 2] * 4  # a quarter of the bearings
    assert not any(table[:, noise].any() for table in judged)


def test_no_bearing_is_learned_from_and_judged():
    whole = made_up(60)
    number = FEATURE_NAMES.index("kurtosis")
    whole.rows.table[:, number] = whole.rows.record // 2
    Listens.learned.clear()
    Listens.asked.clear()
    learning_curve(whole, Learning(), estimator=Listens())
    (judged,) = {frozenset(table[:, number]) for table in Listens.asked if len(table) > ROWS_TO_TRY}
    assert [len(set(table[:, number])) for table in Listens.learned] == [10, 11, 22, 45]
    assert all(judged.isdisjoint(table[:, number]) for table in Listens.learned)
