"""Estimators of one's own: what they may answer, and what is refused."""

from enum import Enum

import numpy as np
import pytest

from datagen.benchmark.answers import class_probability
from datagen.benchmark.rows import Rows
from datagen.benchmark.training import TrainingSet, train_user_estimator
from datagen.errors import BadInput
from labels.classifier.classes import CLASSES

ROWS = np.zeros((3, 2))
NAME = "own:Estimator"


class Guesser:
    """A scikit-learn estimator that learns shares only."""

    def fit(self, X, y):
        self.classes_, counts = np.unique(y, return_counts=True)
        self.shares = counts / counts.sum()
        return self

    def predict_proba(self, X):
        return np.tile(self.shares, (len(X), 1))


class Unfit(Guesser):
    """One whose learning fails."""

    def fit(self, X, y):
        raise ArithmeticError("too hard")


class Named(Guesser):
    """One that was taught other names."""

    def fit(self, X, y):
        return super().fit(X, np.where(y == "healthy", "none", y))


def training():
    classes = np.array(["line outer", "healthy", "line outer"])
    rows = Rows(ROWS.copy(), np.arange(3), np.zeros(3, dtype=np.int64), np.zeros(3, dtype=bool))
    return TrainingSet(rows, classes, np.array(["a", "b", "c"]))


def test_probabilities_are_sorted_by_the_names_of_the_classes():
    found = train_user_estimator(training(), Guesser(), False, NAME).probability(ROWS)
    assert found[0, CLASSES.index("line outer")] == pytest.approx(2.0 / 3.0)
    assert found[0, CLASSES.index("extended inner")] == 0.0


def test_columns_that_an_estimator_sorts_by_name_come_in_the_order_of_the_classes():
    guesser = Guesser().fit(None, np.repeat(["line outer", "healthy", "extended inner"], (5, 3, 2)))
    assert guesser.classes_.tolist() == ["extended inner", "healthy", "line outer"]
    # Healthy, line outer, line inner, extended outer, extended inner.
    np.testing.assert_allclose(
        class_probability(guesser, ROWS, NAME), np.tile([0.3, 0.5, 0.0, 0.0, 0.2], (3, 1)), rtol=1e-12
    )


def test_names_and_probabilities_of_a_function_are_taken_as_they_are():
    assert class_probability(lambda table: np.full(len(table), "line outer"), ROWS, NAME)[:, 1].tolist() == [1.0] * 3
    said = np.tile([0.2, 0.1, 0.3, 0.4, 0.0], (3, 1))
    np.testing.assert_allclose(class_probability(lambda table: said, ROWS, NAME), said)


def test_probabilities_that_were_rounded_are_brought_between_0_and_1():
    said = np.tile([1.0005, -0.0005, 0.0, 0.0, 0.0], (3, 1))
    assert class_probability(lambda table: said, ROWS, NAME).tolist() == [[1.0, 0.0, 0.0, 0.0, 0.0]] * 3


@pytest.mark.parametrize(
    "said",
    [
        np.full(3, "none"),
        np.array(["healthy", "line outer", "Healthy"]),
        np.array([0, 1, 2]),
        np.full(2, "healthy"),
        "healthy",
        np.full((3, 4), 0.25),
        np.full((3, 1, 5), 0.2),
        np.full((3, 5), 0.9),
        np.tile([1.4, -0.4, 0.0, 0.0, 0.0], (3, 1)),
        np.tile([0.5, 0.55, -0.05, 0.0, 0.0], (3, 1)),
        np.tile([0.95, 0.0, 0.0, 0.0, 0.0], (3, 1)),
        np.full((3, 5), np.nan),
        np.full((3, 5), "healthy"),
        np.array(["healthy", None, "line outer"], dtype=object),  # of kinds that cannot be sorted
        [None] * 3,
        None,
    ],
)
def test_what_is_no_answer_is_refused_with_what_would_be(said):
    with pytest.raises(BadInput, match=r"--estimator.*line outer"):
        class_probability(lambda table: said, ROWS, NAME)


def test_an_estimator_that_fails_or_knows_other_classes_is_refused_before_it_is_scored():
    with pytest.raises(BadInput, match=r"failed to learn: ArithmeticError: too hard \(.*test_answers.py, line \d+\)"):
        train_user_estimator(training(), Unfit(), False, NAME)
    with pytest.raises(BadInput, match="none of ours: none;"):
        train_user_estimator(training(), Named(), False, NAME)
    with pytest.raises(
        BadInput, match=r"failed to answer: ZeroDivisionError.*--estimator|--estimator.*ZeroDivisionError"
    ):
        class_probability(lambda table: 1 / 0, ROWS, NAME)


class Doubled:
    """One whose answers name a class in two columns, of which one would be lost."""

    classes_ = ("healthy", "healthy", "line outer")

    def predict_proba(self, X):
        return np.tile([0.5, 0.3, 0.2], (len(X), 1))


def test_a_class_in_two_columns_is_refused():
    with pytest.raises(BadInput, match="its classes_ name a class twice"):
        class_probability(Doubled(), ROWS, NAME)


class Word(Enum):
    """Names of classes that are no texts, but read like them."""

    OUTER = "line outer"

    def __str__(self):
        return self.value


def test_names_that_read_like_those_of_classes_are_taken_for_them():
    found = class_probability(lambda table: [Word.OUTER] * len(table), ROWS, NAME)
    assert found[:, CLASSES.index("line outer")].tolist() == [1.0] * 3


class InPlace(Guesser):
    """One that overwrites all that it is given."""

    def fit(self, X, y):
        super().fit(X, y)
        X[:], y[:] = 7.0, "healthy"
        return self

    def predict_proba(self, X):
        X[:] = 7.0
        return super().predict_proba(X)


def test_what_an_estimator_overwrites_is_a_copy():
    given = training()
    before = given.rows.table.copy(), given.classes.copy()
    train_user_estimator(given, InPlace(), False, NAME).probability(given.rows.table)
    np.testing.assert_array_equal(given.rows.table, before[0])
    assert given.classes.tolist() == before[1].tolist()
