"""The names under which others read scored records, and which part of a record each of them is of."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from datagen.files.plain import plain_json
from datagen.sizing.flat_rows import flat_row, flat_scores
from datagen.sizing.report_files import estimates_csv, write_report
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_scores import SizeScores
from labels.event_scores import EventScores

BEFORE_THE_EVENTS = [
    "record", "recording", "channel", "bearing_id", "rig", "race", "profile", "split", "snr_db", "speed_rpm", "load_n",
    "extent_mm", "extent_spacing", "rate", "pass_period", "true_lag", "true_extent", "outcome", "reason", "method",
    "found_race", "trust", "lag", "lag_low", "lag_high", "lag_arc", "extent", "extent_low", "extent_high",
    "estimated_deg", "estimated_deg_low", "estimated_deg_high", "estimated_mm", "estimated_mm_low", "estimated_mm_high",
    "candidates", "candidates_deg", "candidates_mm", "complement_deg", "complement_mm", "static_arc", "envelope_arc",
    "known_size_factor", "seconds",
]  # fmt: skip
IN_JSON = [*BEFORE_THE_EVENTS, "event_times", "events_in_time", "events_in_arc", "known_truth"]
COUNTS = [f"events_in_{kind}_{what}" for kind in ("time", "arc") for what in ("matched", "found", "true")]
IN_CSV = [*BEFORE_THE_EVENTS, "known_truth", "passes_heard", *COUNTS]


def test_names_and_their_order_are_those_that_others_rely_on(scored: Callable[..., ScoredRecord]) -> None:
    scores = SizeScores("x", "spallgen", "all", True, [scored()], None, [], None, 1)
    assert estimates_csv(scores).splitlines()[0].split(",") == IN_CSV
    report = json.loads(plain_json(flat_scores(scores)))
    assert list(report) == [field.name for field in fields(SizeScores)]
    assert (report["folder"], report["load_given"]) == ("x", 1)
    assert list(report["records"][0]) == IN_JSON


def test_a_report_without_a_picture_does_not_keep_that_of_an_earlier_one(
    scored: Callable[..., ScoredRecord], tmp_path: Path
) -> None:
    scores = SizeScores("x", "spallgen", "all", True, [scored()], None, [], None, 1)
    for picture in (b"picture", None):
        written = write_report(scores, tmp_path, picture)
        assert sorted(path.name for path in tmp_path.iterdir()) == sorted(written)


def test_truth_and_what_was_answered_keep_their_own_names(scored: Callable[..., ScoredRecord]) -> None:
    one = scored(
        {"race": "inner", "lag": 1.0, "extent": 2.0, "extent_mm": 3.0, "known": False},
        {
            "race": "outer", "lag": 11.0, "lag_interval": (10.0, 12.0), "lag_arc": 13.0, "extent": 0.5,
            "extent_interval": (0.4, 0.6), "extent_mm": 15.0, "extent_mm_interval": (14.0, 16.0), "candidates": (0.25,),
            "candidates_mm": (17.0,), "event_times": np.ones((2, 2)), "known_size_factor": 1.5, "seconds": 18.0,
        },
        static_arc=19.0, envelope_arc=20.0, events_in_time=EventScores(1, 2, 3), events_in_arc=EventScores(4, 5, 6),
    )  # fmt: skip
    row = flat_row(one)
    assert (row["race"], row["true_lag"], row["true_extent"], row["extent_mm"]) == ("inner", 1.0, 2.0, 3.0)
    assert row["known_truth"] is False
    assert (row["found_race"], row["lag_low"], row["lag"], row["lag_high"]) == ("outer", 10.0, 11.0, 12.0)
    assert (row["lag_arc"], row["static_arc"], row["envelope_arc"]) == (13.0, 19.0, 20.0)
    for end, arc, mm in (("_low", 0.4, 14.0), ("", 0.5, 15.0), ("_high", 0.6, 16.0)):
        assert row[f"extent{end}"] == arc
        assert row[f"estimated_deg{end}"] == pytest.approx(arc * 180.0 / math.pi)
        assert row[f"estimated_mm{end}"] == mm
    assert (row["candidates"], row["candidates_mm"]) == ((0.25,), (17.0,))
    assert row["candidates_deg"] == pytest.approx((0.25 * 180.0 / math.pi,))
    assert math.isnan(row["complement_mm"])  # the candidate is not longer
    assert (row["known_size_factor"], row["seconds"]) == (1.5, 18.0)
    assert (row["events_in_time"], row["events_in_arc"]) == (EventScores(1, 2, 3), EventScores(4, 5, 6))
    assert row["event_times"].shape == (2, 2)
