"""Which records may be scored: none of a virtual bearing that was learned from."""

import shutil

import pytest

from datagen.benchmark.machines import learned_machines, machines, share_machines, unseen_records
from datagen.benchmark.training import training_records
from datagen.corpus import Corpus
from datagen.errors import BadInput


def renamed(folder, name):
    """A copy of a corpus whose virtual bearings have another name."""
    copy = folder.with_name(name)
    shutil.copytree(folder, copy)
    text = (copy / "index.csv").read_text()
    (copy / "index.csv").write_text(text.replace("tiny-0", f"{name}-0"))
    return copy


def test_a_corpus_learned_from_and_tested_on_is_divided_by_virtual_bearing(divided):
    train = training_records(divided, also_tested=True)
    test = unseen_records(Corpus(divided), learned_machines(Corpus(divided), train["record"].to_numpy()))
    assert set(test["split"]) == {"test"}
    assert not set(train["bearing_id"]) & set(test["bearing_id"])
    every = training_records(divided, also_tested=False)
    assert len(every) == len(train) + len(test) == 14
    # Records that were left out of what is learned from, but are not of the split test, are not scored either.
    few = training_records(divided, also_tested=True, first=8)
    assert len(unseen_records(Corpus(divided), learned_machines(Corpus(divided), few["record"].to_numpy()))) == len(
        test
    )


def test_a_split_test_that_was_learned_from_is_not_scored(divided):
    corpus = Corpus(divided)
    every = training_records(divided, also_tested=False)["record"].to_numpy()
    with pytest.raises(BadInput, match="all its virtual bearings"):
        unseen_records(corpus, learned_machines(corpus, every))
    labels = corpus.labels
    tests = sorted(set(labels.loc[labels["split"] == "test", "bearing_id"]))
    learned = labels.loc[(labels["split"] != "test") | (labels["bearing_id"] == tests[0]), "record"].to_numpy()
    scored = unseen_records(corpus, learned_machines(corpus, learned))
    assert sorted(set(scored["bearing_id"])) == tests[1:]
    assert len(tests) > 1


def test_a_copy_under_any_name_is_divided_like_the_corpus_itself(divided):
    copy = renamed(divided, "other")
    assert share_machines(Corpus(divided), Corpus(copy))
    train = training_records(divided, also_tested=True)
    test = unseen_records(Corpus(copy), learned_machines(Corpus(divided), train["record"].to_numpy()))
    numbers = [{name.rpartition("-")[2] for name in labels["bearing_id"]} for labels in (train, test)]
    assert numbers[1]
    assert not numbers[0] & numbers[1]


def test_machines_of_another_seed_or_recorded_are_others(tiny_corpus, other_corpus, tmp_path):
    one, other = Corpus(tiny_corpus), Corpus(other_corpus)
    assert not share_machines(one, other)
    assert set(one.labels["bearing_id"]) == set(other.labels["bearing_id"])
    assert len(unseen_records(other, learned_machines(one, one.labels["record"].to_numpy()))) == len(other.labels)
    assert machines(one)[0] == "7-00000"
