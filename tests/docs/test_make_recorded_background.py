"""Corpora that are compared have equally many records."""

from pathlib import Path

import pytest
from make_recorded_background import with_recording


def test_records_are_shared_equally_by_the_channels():
    recipe = {"part": [{"name": "machines", "records": 6, "background": {}}]}
    with_recording(recipe, Path("/a.mat"), 12000.0, ["x", "y"], 6)
    assert [part["records"] for part in recipe["part"]] == [3, 3]
    assert [part["background"]["recording"]["channels"] for part in recipe["part"]] == [["x"], ["y"]]


def test_records_that_the_channels_cannot_share_are_refused():
    with pytest.raises(ValueError, match="RECORDS = 7; allowed: a multiple of the 2 channels"):
        with_recording({"part": [{}]}, Path("/a.mat"), 12000.0, ["x", "y"], 7)
