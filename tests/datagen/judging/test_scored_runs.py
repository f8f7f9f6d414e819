"""The log of runs that scored recordings."""

import json
import math
import re
from datetime import UTC, datetime
from pathlib import Path

import pytest

from datagen.errors import BadInput
from datagen.judging.scored_runs import log_path, require_log, write_line
from datagen.versions import program_versions


def test_runs_on_recordings_are_listed_line_by_line(tmp_path):
    write_line(tmp_path, {"first": 1})
    write_line(tmp_path, {"second": 2})
    lines = [json.loads(line) for line in log_path(tmp_path).read_text().splitlines()]
    assert [list(line) for line in lines] == [["time", "first", "versions"], ["time", "second", "versions"]]
    for line in lines:
        assert datetime.fromisoformat(line["time"]) <= datetime.now(UTC)
        assert line["versions"] == program_versions()
    with pytest.raises(BadInput, match="logged"):
        write_line(tmp_path / "nowhere", {})


def test_a_score_that_does_not_exist_is_null_as_json_knows_no_nan(tmp_path):
    write_line(tmp_path, {"scores": {"arc_error": math.nan, "answered": 0}, "sizes": {3: 1.5}})
    line = json.loads(log_path(tmp_path).read_text(), parse_constant=pytest.fail)
    assert line["scores"] == {"arc_error": None, "answered": 0}
    assert line["sizes"] == {"3": 1.5}


def test_a_line_tells_the_second_and_a_folder_by_its_path(tmp_path):
    write_line(tmp_path, {"train": Path("out/a")})
    line = json.loads(log_path(tmp_path).read_text())
    assert line["train"] == "out/a"
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\+00:00", line["time"])


def test_a_log_that_cannot_be_written_is_told_with_the_cause(tmp_path):
    log_path(tmp_path).mkdir()
    with pytest.raises(BadInput, match=r"it cannot be written: Is a directory; allowed: a corpus that can be written"):
        write_line(tmp_path, {})
    with pytest.raises(BadInput, match=r"it cannot be written: Is a directory; allowed: a corpus that can be written"):
        require_log(tmp_path)


def test_a_log_that_cannot_be_made_is_told_before_anything_is_scored(tmp_path, monkeypatch):
    monkeypatch.setattr("datagen.judging.scored_runs.is_writable", lambda folder: folder != tmp_path)
    with pytest.raises(BadInput, match=r"it cannot be written: Permission denied; allowed: a corpus"):
        require_log(tmp_path)


def test_asking_for_a_log_leaves_it_as_it_is(tmp_path):
    require_log(tmp_path)
    assert list(tmp_path.iterdir()) == []
    log_path(tmp_path).write_text("a line\n")
    require_log(tmp_path)
    assert log_path(tmp_path).read_text() == "a line\n"
