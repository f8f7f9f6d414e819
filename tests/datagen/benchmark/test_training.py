"""What is learned from: the records, the rule's threshold, the rival training set."""

import numpy as np
import pandas
import pytest

from datagen.benchmark.impulse_signal import Ingredients
from datagen.benchmark.impulse_training import impulse_training
from datagen.benchmark.reading_policy import Reading
from datagen.benchmark.rows import Rows
from datagen.benchmark.training import TrainingSet, train_rule, training_records
from datagen.errors import BadInput
from labels.features.table import FEATURE_NAMES

pytestmark = pytest.mark.usefixtures("short_records_are_judged")


def test_only_the_first_records_are_learned_from_if_asked(tiny_corpus):
    every = training_records(tiny_corpus, also_tested=False)
    assert training_records(tiny_corpus, False, 10)["record"].tolist() == every["record"].tolist()[:10]


def test_the_rule_is_set_on_healthy_records_as_they_are():
    column, size = FEATURE_NAMES.index("outer_strength"), 80
    table = np.zeros((2 * size, len(FEATURE_NAMES)))
    table[:size, column] = np.repeat(np.linspace(0.0, 1.0, size // 2), 2)  # two axes a record
    table[size:, column] = 5.0
    noisy = np.arange(2 * size) >= size
    records = np.tile(np.repeat(np.arange(size // 2), 2), 2)
    rows = Rows(table, records, np.zeros(2 * size, dtype=np.int64), noisy)
    training = TrainingSet(rows, np.full(2 * size, "healthy"), np.full(2 * size, "a"))
    # The 95 % quantile of records evenly spread from 0 to 1, in logarithms as the table has it.
    assert np.log(train_rule(training).threshold) == pytest.approx(0.95, abs=0.005)


def test_a_rule_without_healthy_records_that_can_be_judged_says_where_to_look_why():
    nothing = Rows(np.zeros((0, len(FEATURE_NAMES))), np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0, bool))
    with pytest.raises(BadInput, match=r"no healthy record that can be judged.*`spallgen features` says why"):
        train_rule(TrainingSet(nothing, np.zeros(0, np.str_), np.zeros(0, np.str_)))


def test_plain_impulse_trains_are_as_many_as_asked():
    counts = []
    made = impulse_training(Ingredients(), Reading(), 1, 12, lambda done, total: counts.append((done, total)))
    assert counts == [(3, 12), (6, 12), (9, 12), (12, 12)]
    assert sorted(set(made.classes)) == ["healthy", "line inner", "line outer"]
    assert len(made.classes) == 12


def test_too_few_of_the_first_records_are_told_of_the_option_that_left_the_others_out(tiny_corpus):
    with pytest.raises(BadInput, match=r"--first = 1: too few virtual bearings .*; allowed: records of 4 virtual"):
        training_records(tiny_corpus, also_tested=False, first=1)


def test_where_no_number_of_first_records_would_do_the_corpus_is_refused(divided):
    index = pandas.read_csv(divided / "index.csv", keep_default_na=False)
    bearings = sorted(index["bearing_id"].unique())
    index["split"] = np.where(index["bearing_id"].isin(bearings[:3]), "train", "test")
    index.to_csv(divided / "index.csv", index=False)
    with pytest.raises(BadInput, match=r"--train: too few .*; allowed: a corpus with 4 .* outside its split test"):
        training_records(divided, also_tested=True, first=2)
