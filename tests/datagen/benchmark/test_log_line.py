"""Runs on recordings leave a line in their folder, and a run that cannot is not made."""

import json

import pytest

from datagen.benchmark.log_line import log_run
from datagen.errors import BadInput
from datagen.judging.scored_runs import log_path
from labels.interval import Interval

SCORES = {"faults_balanced_accuracy": {"value": 0.75, "low": 0.5, "high": 1.0}}
SCORES |= {"false_alarms": 1, "healthy": 4, "rejected": 0}


def test_each_run_adds_a_line_of_what_was_learned_from_and_the_scores(tiny_corpus, made_scores, tmp_path):
    scores = made_scores(faults_balanced_accuracy=Interval(0.75, 0.5, 1.0), false_alarms=1, healthy=4)
    for first in (10, 20):
        log_run(tmp_path, tiny_corpus, "9f86d0", {"first": first}, {"forest": scores})
    lines = [json.loads(line) for line in log_path(tmp_path).read_text().splitlines()]
    assert [line["options"]["first"] for line in lines] == [10, 20]
    assert lines[0]["train"] == str(tiny_corpus)
    assert lines[0]["recipe"] == "9f86d0"
    assert lines[0]["scores"] == {"forest": SCORES}
    assert lines[0]["time"].endswith("+00:00")
    assert "numpy" in lines[0]["versions"]


def test_a_log_that_cannot_be_written_is_refused_by_name(tmp_path):
    log_path(tmp_path).mkdir()
    with pytest.raises(BadInput, match=r"scored_runs\.jsonl: runs on recordings are logged here.*such as a copy of it"):
        log_run(tmp_path, tmp_path / "impulses", "", {}, {})
