"""What `spallgen size` prints: each number under its own heading, each sentence with its own numbers."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from rich.table import Table

from datagen.commands.size_tables import estimates_table, known_size_sentence, stated_sentence, summary_table
from datagen.sizing.aggregation import summarise
from datagen.sizing.flat_rows import flat_row
from datagen.sizing.known_sizes import KnownSize
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_summary import StatedSizes
from labels.event_scores import EventScores
from labels.interval import Interval


def columns(table: Table) -> dict[str, list[str]]:
    return {str(column.header): [str(cell) for cell in column.cells] for column in table.columns}


def test_what_a_long_size_lacks_of_a_ball_spacing_stands_beside_it(scored: Callable[..., ScoredRecord]) -> None:
    """Twelve balls are 30 degrees apart; a rad is 20 mm long."""
    records = []
    for degrees in (20.0, 10.0, 35.0):
        extent = math.radians(degrees)
        candidates = tuple(math.radians(degrees + 30.0 * more) for more in range(3))
        records.append(scored(answer={"extent": extent, "extent_mm": 20.0 * extent, "candidates": candidates}))
    assert [cell.split("] ")[-1] for cell in columns(estimates_table(records))["extent, °"]] == [
        "or 10",
        "10 [5.16, 6.88]",
        "35 [5.16, 6.88]",
    ]
    assert columns(estimates_table(records))["extent, mm"][0] == "6.98 [1.8, 2.4] or 3.49"
    rows = [flat_row(record) for record in records]
    assert [row["complement_deg"] for row in rows] == pytest.approx([10.0, 20.0, math.nan], nan_ok=True)
    assert rows[1]["complement_mm"] == pytest.approx(20.0 * math.radians(20.0))


def test_an_estimate_stands_in_degrees_and_millimetres_with_its_intervals(scored: Callable[..., ScoredRecord]) -> None:
    answer = {
        "race": "inner", "extent": math.radians(5.0), "extent_interval": (math.radians(4.0), math.radians(6.5)),
        "extent_mm": 2.0, "extent_mm_interval": (1.6, 2.6), "trust": 0.87,
    }  # fmt: skip
    silent = {"extent": math.nan, "trust": 0.2, "reason": "no two events"}
    records = [
        scored({"record": 3, "recording": "a.mat", "channel": "x"}, answer),
        scored({"record": 4, "recording": "b.mat x", "channel": "x"}, silent),
        scored({"record": 5}, silent | {"outcome": "not_asked", "reason": "not known: shaft speed"}),
    ]
    assert columns(estimates_table(records)) == {
        "record": ["3", "4", "5"],
        "recording": ["a.mat x", "b.mat x", ""],
        "race": ["inner", "", ""],
        "extent, °": ["5 [4, 6.5]", "", ""],
        "extent, mm": ["2 [1.6, 2.6]", "", ""],
        "trust": ["0.87", "0.20", ""],
        "why there is no estimate": ["", "no two events", "not known: shaft speed"],
    }


def test_figures_say_whether_they_are_met_and_those_without_records_are_left_out(
    scored: Callable[..., ScoredRecord],
) -> None:
    heard = {"events_in_time": EventScores(8, 16, 10), "events_in_arc": EventScores(4, 16, 10)}
    truths = [{"record": k, "bearing_id": f"b{k}", "snr_db": 99.0} for k in range(20)]
    records = [scored(truth, {"lag": 0.0044}, **heard) for truth in truths]  # 10 % wrong
    found = columns(summary_table(summarise(records, True)))
    met = dict(zip(found["figure"], found["met"], strict=True))
    assert (met["lag error, clean"], met["arc error, clean"]) == ("NO", "yes")
    assert "lag error, 10 dB" not in met
    value = dict(zip(found["figure"], found["value"], strict=True))
    number = dict(zip(found["figure"], found["records"], strict=True))
    assert (number["lag error, clean"], number["events within 100 us: F1"]) == ("20", "200 events")
    assert value["events within 100 us: F1"] == "0.615"  # 2 · 8 of 16 + 10
    assert value["events within 0.5 degrees: F1"] == "0.308"
    reach = dict(zip(found["figure"], found["90 % interval"], strict=True))
    assert reach["events within 100 us: F1"] == "0.615 to 0.615"  # all records are alike


def test_an_interval_that_is_not_known_is_left_out(scored: Callable[..., ScoredRecord]) -> None:
    found = columns(summary_table(summarise([scored()], True)))  # of a single bearing
    assert set(found["90 % interval"]) == {""}


def test_events_where_there_are_none_are_told_without_an_interval(scored: Callable[..., ScoredRecord]) -> None:
    heard = {"events_in_time": EventScores(0, 3, 0), "events_in_arc": EventScores(0, 0, 0)}
    records = [scored({"record": k, "bearing_id": f"b{k}"}, **heard) for k in range(3)]
    found = columns(summary_table(summarise(records, True)))
    rows = zip(found["value"], found["90 % interval"], found["records"], strict=True)
    row = dict(zip(found["figure"], rows, strict=True))
    assert row["events within 100 us: F1"] == ("0.000", "", "0 events")
    assert "events within 0.5 degrees: F1" not in row
    assert row["lag error, 10 dB"][1] == "0.000 to 0.000"


def test_what_a_known_size_changed_is_told_in_its_own_numbers() -> None:
    known = KnownSize(3, "mill", 1.5, 1.25, 1.0091, 7, 0.12, 0.11)
    assert known_size_sentence(known) == (
        "record 3 is known to have 1.5 mm and was estimated at 1.25 mm, which changes the sizes of 7 other records of "
        "mill by +0.91 %; their arc error: 12.00% without it, 11.00% with it"
    )


def test_what_recordings_state_is_told_in_its_own_numbers() -> None:
    stated = StatedSizes(
        records=9, answered=7, answered_on_the_stated_race=5, healthy=4, healthy_answered=1,
        arc_error=Interval(0.303, 0.1, 0.5),
    )  # fmt: skip
    assert stated_sentence(stated) == (
        "of 9 records of a stated extent 7 were given a size, mean error of their arc 0.303 [0.100, 0.500] of it, 5 on "
        "the stated race, 1 of 4 stated healthy were given a size"
    )
