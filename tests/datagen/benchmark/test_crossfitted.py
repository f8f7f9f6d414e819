"""The script that has every machine judged by learners of others."""

from collections import Counter

import pytest

from datagen.corpus import Corpus


@pytest.mark.usefixtures("short_records_are_judged")
def test_every_record_is_judged_once_by_what_learned_from_all_other_machines(load_script, tiny_corpus, monkeypatch):
    script = load_script("make_crossfitted")
    parts = []

    class Listening:
        def __init__(self, learned, models):
            assert models == "learners"
            self.learned = learned

        def judge(self, chosen, found):
            assert set(chosen.numbers) <= set(found.rows.record)
            parts.append((self.learned, chosen))

    monkeypatch.setattr(script, "FOLDS", 3)
    monkeypatch.setattr(script, "train_rule", lambda training: set(training.bearings))
    monkeypatch.setattr(script, "train_models", lambda training, names: "learners")
    monkeypatch.setattr(script, "Judges", Listening)
    script.judged_by_others(tiny_corpus)
    labels = Corpus(tiny_corpus).labels
    everybody = set(labels["bearing_id"])
    assert len(parts) == script.FOLDS
    assert Counter(record for _, chosen in parts for record in chosen.numbers) == Counter(labels["record"])
    for learned, chosen in parts:
        assert learned == everybody - set(chosen.labels["bearing_id"])
