"""What the benchmark of the program's own choice sums up."""

import json

import pytest
from make_accuracy import DOCS, SETS

from tests.benchmarks.own_choice import summary


@pytest.mark.parametrize("name", SETS.values())
def test_the_stored_summary_is_that_of_the_stored_scenes(name):
    found = json.loads((DOCS / name).read_text(encoding="utf-8"))
    assert json.loads(json.dumps(summary(found["rows"]))) == found["summary"]


def test_a_scene_alone_is_summed_up_and_none_is_too():
    found = json.loads((DOCS / SETS["0.1 s"]).read_text(encoding="utf-8"))["rows"]
    [[name, row], *_] = found.items()
    assert summary({name: row})["worst_error"] == row["error"]
    assert summary({name: row | {"judge_apart": 1.0}})["worst_error"] is None
    assert summary({})["scenes"] == 0
