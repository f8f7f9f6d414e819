"""Intervals of tables and events over virtual bearings, and known sizes, against counts by hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import astuple, replace

import numpy as np
import pytest

from datagen.commands.size_tables import stated_sentence, summary_table
from datagen.sizing.aggregation import summarise
from datagen.sizing.bearing_intervals import mean_with_interval
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_summary import Seconds, StatedSizes
from labels.event_scores import EventScores
from labels.interval import Interval

BAD, GOOD = EventScores(0, 10, 10), EventScores(10, 10, 10)


def two_kinds(scored: Callable[..., ScoredRecord]) -> list[ScoredRecord]:
    """Forty records of one bearing, 10 % and 50 % wrong and all events missed, and forty exact ones of ten bearings."""
    wrong, missed = {"lag": 0.0044, "extent": 0.15}, {"events_in_time": BAD, "events_in_arc": BAD}
    bad = [scored({"bearing_id": "bad"}, wrong, **missed) for _ in range(40)]
    heard = {"events_in_time": GOOD, "events_in_arc": GOOD}
    return [*bad, *(scored({"bearing_id": f"good {k // 4}"}, **heard) for k in range(40))]


def test_every_table_has_intervals_over_virtual_bearings(scored: Callable[..., ScoredRecord]) -> None:
    summary = summarise(two_kinds(scored), True)
    for table in summary.by.values():
        (row,) = table
        # Drawn 0, 1, 2 or 3 times among eleven with 35, 39, 19 and 6 %, the bad one makes 0, 50, 69 or 79 % of all.
        assert (row.lag_error.value, row.lag_error.low) == (pytest.approx(0.05), 0.0)
        assert row.lag_error.high == pytest.approx(0.1 * 120 / 152)
        assert row.arc_error.high == pytest.approx(0.5 * 120 / 152)
        # A size is given of all: of more than this share of bearings it would be given of all eleven less often than
        # once in twenty.
        assert row.no_estimate == Interval(0.0, 0.0, pytest.approx(1.0 - 0.05 ** (1.0 / 11.0)))


def test_a_record_stands_in_every_table_by_what_its_name_says(scored: Callable[..., ScoredRecord]) -> None:
    one = scored(
        {
            "extent_spacing": 0.05, "extent_mm": 1.5, "lag": 30.0 / 65_536.0, "speed_rpm": 1800.0, "load_n": 49.0,
            "race": "inner", "profile": "tukey", "rig": "mill", "snr_db": 21.0,
        }
    )  # fmt: skip
    found = {name: [row.value for row in rows] for name, rows in summarise([one], True).by.items()}
    assert found == {
        "noise, dB": ["20"], "size, spacings": ["0.05–0.1"], "size, mm": ["1–2"], "true lag, samples": ["20–50"],
        "speed, rpm": ["1800–2400"], "load, N": ["0–50"], "race": ["inner"], "profile": ["tukey"], "rig": ["mill"],
    }  # fmt: skip


def test_the_rows_of_a_table_stand_in_order_with_errors_of_their_own(scored: Callable[..., ScoredRecord]) -> None:
    silent = {"outcome": "no_event_pair", "lag": math.nan, "extent": math.nan}
    noisy = scored({"record": 1, "snr_db": 0.0, "lag": 0.02}, {"lag": 0.016, "extent": 0.13})
    rows = summarise([noisy, scored({"record": 2, "snr_db": 0.0}, silent), scored({"snr_db": 99.0})], True).by
    names = [[row.value for row in rows[name]] for name in ("noise, dB", "true lag, samples")]
    assert names == [["clean", "0"], ["over 150"]]
    (_, row) = rows["noise, dB"]
    assert (row.records, row.no_estimate.value) == (2, 0.5)
    assert (row.lag_error.value, row.lag_error_median) == pytest.approx((0.2, 0.2))
    assert (row.arc_error.value, row.arc_error_median) == pytest.approx((0.3, 0.3))


def test_the_rules_to_compare_with_have_their_own_errors(scored: Callable[..., ScoredRecord]) -> None:
    record = scored(answer={"lag_arc": 0.04}, envelope_arc=0.15, static_arc=0.11)  # of a spall of 0.1 rad
    errors = {figure.name: figure.mean.value for figure in summarise([record], True).figures}
    expected = {
        "full size, own lag": 0.6,
        "half size, own lag": 0.2,  # the ball has passed half of the spall, so its size is twice the arc
        "plain envelope lag": 0.5,
        "own lag and static release": 0.1,
    }
    for rule, error in expected.items():
        assert errors[f"arc error by rule: {rule}, 10 dB"] == pytest.approx(error, rel=1e-12)


def test_what_an_estimator_leaves_out_is_not_scored(scored: Callable[..., ScoredRecord]) -> None:
    unknown = {"lag": math.nan, "lag_interval": (math.nan, math.nan), "extent_interval": (math.nan, math.nan)}
    wrong = {"lag": 0.0048, "lag_interval": (0.0045, 0.005)}  # of 0.004 s, which lies outside
    summary = summarise([scored(answer=unknown), scored(answer=wrong)], True)
    figures = {figure.name: (figure.mean.value, figure.count) for figure in summary.figures}
    assert figures["90 % interval of the lag holds the truth"] == (0.0, 1)
    assert figures["90 % interval of the arc holds the truth"] == (1.0, 1)
    assert figures["lag error, 10 dB"] == (pytest.approx(0.2), 1)
    (row,) = summary.by["race"]
    assert (row.records, row.lag_error.value, row.lag_error_median) == (2, pytest.approx(0.2), pytest.approx(0.2))
    (without,) = summarise([scored(answer=unknown)], True).by["race"]
    assert math.isnan(without.lag_error.value)
    assert math.isnan(without.lag_error_median)


@pytest.mark.parametrize(("count", "judged"), [(19, {"too few to judge"}), (20, {"yes", "NO"})])
def test_targets_are_judged_from_twenty_records_on(
    count: int, judged: set[str], scored: Callable[..., ScoredRecord]
) -> None:
    table = summary_table(summarise([scored({"record": k}) for k in range(count)], True))
    columns = {str(column.header): list(column.cells) for column in table.columns}
    said = [met for target, met in zip(columns["target"], columns["met"], strict=True) if target]
    assert set(said) == judged
    assert all(columns["value"])


def test_where_there_are_no_events_the_table_has_no_row_of_them(scored: Callable[..., ScoredRecord]) -> None:
    (figures, *_) = summary_table(summarise([scored()], True)).columns
    assert not [name for name in figures.cells if str(name).startswith("events")]
    (figures, *_) = summary_table(summarise(two_kinds(scored), True)).columns
    assert [name for name in figures.cells if str(name).startswith("events")]


def test_events_have_intervals_over_virtual_bearings(scored: Callable[..., ScoredRecord]) -> None:
    for events in summarise(two_kinds(scored), True).events.values():
        for share in (events.precision, events.recall, events.f1):  # all are that of the events of good bearings
            assert astuple(share) == pytest.approx((0.5, 32 / 152, 1.0))


def test_where_nothing_was_answered_there_is_no_interval(scored: Callable[..., ScoredRecord]) -> None:
    summary = summarise([scored(answer={"lag": math.nan, "extent": math.nan, "candidates": ()})], True)
    (row,) = summary.by["race"]
    assert row.no_estimate.value == 1.0
    assert all(map(math.isnan, astuple(row.lag_error)))
    assert math.isnan(summary.events["within_100_us, answered records"].f1.low)
    assert math.isnan(summary.events["within_100_us"].recall.high)
    assert math.isnan(summary.long.error_of_nearest_candidate.high)
    unanswered = [figure for figure in summary.figures if figure.count == 0]
    assert any("interval" in figure.name for figure in unanswered)
    assert all((figure.target, figure.met) == ("", None) for figure in unanswered)


def test_records_of_unknown_bearings_are_drawn_one_by_one(scored: Callable[..., ScoredRecord]) -> None:
    values = np.random.default_rng(0).standard_normal(400)
    found = mean_with_interval(values.tolist(), [scored({"bearing_id": "unknown", "record": k}) for k in range(400)])
    reach = 1.645 * values.std() / math.sqrt(400)  # of a normal distribution; 2000 draws tell quantiles to 4 %
    assert found.high - found.value == pytest.approx(reach, rel=0.1)
    # Of two records one is drawn twice in a quarter of the draws each.
    pair = mean_with_interval([0.0, 1.0], [scored({"bearing_id": "unknown", "record": k}) for k in range(2)])
    assert pair == Interval(0.5, 0.0, 1.0)


def test_each_value_is_of_the_bearing_of_its_own_record(scored: Callable[..., ScoredRecord]) -> None:
    records = [scored({"bearing_id": bearing}) for bearing in ("a", "a", "b")]
    assert mean_with_interval([math.nan, 0.0, 1.0], records) == Interval(0.5, 0.0, 1.0)


@pytest.mark.parametrize(("bearing", "count"), [("b", 9), ("unknown", 1)])
def test_one_bearing_alone_gives_a_mean_no_interval(
    scored: Callable[..., ScoredRecord], bearing: str, count: int
) -> None:
    records = [scored({"bearing_id": bearing, "record": k}) for k in range(count)]
    found = mean_with_interval(np.linspace(0.0, 1.0, count + 1)[1:].tolist(), records)
    assert math.isfinite(found.value)
    assert math.isnan(found.low)
    assert math.isnan(found.high)
    events = summarise(records, True).events["within_100_us"]
    assert math.isnan(events.recall.low)


def test_no_interval_is_printed_where_there_is_none() -> None:
    stated = StatedSizes(
        records=3, answered=2, answered_on_the_stated_race=2, healthy=0, healthy_answered=0,
        arc_error=Interval(0.303, math.nan, math.nan),
    )  # fmt: skip
    assert "mean error of their arc 0.303 of it" in stated_sentence(stated)
    bounded = replace(stated, arc_error=Interval(0.303, 0.1, 0.5))
    assert "0.303 [0.100, 0.500] of it" in stated_sentence(bounded)


def test_one_record_of_an_unknown_bearing_tells_nothing_of_another(scored: Callable[..., ScoredRecord]) -> None:
    records = [scored({"record": k, "bearing_id": "unknown"}) for k in range(3)]
    assert summarise(records, True).known_size_of_another_record.records == 0


def test_the_known_size_is_that_of_the_surest_other_record_of_the_bearing(scored: Callable[..., ScoredRecord]) -> None:
    clean, sure, unsure = (
        scored({"record": k, "snr_db": snr}, {"extent": extent, "trust": trust})
        for k, (extent, snr, trust) in enumerate([(0.102, 99.0, 0.2), (0.097, 10.0, 0.9), (0.104, 10.0, 0.8)])
    )
    summary = summarise([unsure, sure, clean, scored({"record": 9, "bearing_id": "alone"})], True)
    found = summary.known_size_of_another_record
    assert found.records == 3
    assert found.arc_error_without == pytest.approx((0.02 + 0.03 + 0.04) / 3)
    # A twentieth of the logarithm of what the known one was wrong by: the clean record's for both others, and the surer
    # other one's for the clean record.
    after = [1.04 * (1 / 1.02) ** 0.05 - 1.0, 1.0 - 0.97 * (1 / 1.02) ** 0.05, 1.02 * (1 / 0.97) ** 0.05 - 1.0]
    assert found.arc_error_with == pytest.approx(sum(after) / 3)
    # Where a size given by the user has corrected them, the answers themselves are compared.
    corrected = [
        replace(one, answer=replace(one.answer, extent=1.1 * one.answer.extent, known_size_factor=1.1))
        for one in (unsure, sure, clean)
    ]
    assert summarise(corrected, True).known_size_of_another_record.arc_error_with == pytest.approx(sum(after) / 3)


@pytest.mark.parametrize(("silent", "met"), [(40, True), (39, True), (20, False)])
def test_silence_where_there_is_no_event_is_met_from_95_per_cent_up(
    scored: Callable[..., ScoredRecord], silent: int, met: bool
) -> None:
    nothing = {"race": "none", "lag": math.nan, "extent_spacing": 0.0, "extent": 0.0}
    unsized = {"outcome": "no_passes", "lag": math.nan, "extent": math.nan, "candidates": ()}
    records = [scored(nothing, unsized if k < silent else {}) for k in range(40)]
    (figure,) = [one for one in summarise(records, True).figures if one.name.startswith("abstention")]
    assert (figure.mean.value, figure.count, figure.met) == (pytest.approx(silent / 40), 40, met)


@pytest.mark.parametrize("load_known", [True, False])
def test_the_targets_are_those_that_were_set(scored: Callable[..., ScoredRecord], load_known: bool) -> None:
    levels = [scored({"record": k, "snr_db": snr}) for k, snr in enumerate((99.0, 20.0, 10.0))]
    eventless = scored({"record": 9, "lag": math.nan}, {"lag": math.nan, "extent": math.nan})
    figures = summarise([*levels, eventless], load_known).figures
    arcs = {"arc error, clean": "≤ 0.1", "arc error, 10 dB": "≤ 0.15"} if load_known else {}
    assert {figure.name: figure.target for figure in figures if figure.target} == arcs | {
        "lag error, clean": "≤ 0.05",
        "lag error, 10 dB": "≤ 0.1",
        "no estimate, clean": "≤ 0.05",
        "abstention where there is no event": "≥ 0.95",
        "90 % interval of the lag holds the truth": "0.85 to 0.95",
        "90 % interval of the arc holds the truth": "0.85 to 0.95",
    }


@pytest.mark.parametrize(("silent", "met"), [(1, True), (2, False)])
def test_a_share_as_large_as_its_target_meets_it(scored: Callable[..., ScoredRecord], silent: int, met: bool) -> None:
    nothing = {"outcome": "no_event_pair", "lag": math.nan, "extent": math.nan}
    records = [scored({"record": k, "snr_db": 99.0}, nothing if k < silent else {}) for k in range(20)]
    (figure,) = (one for one in summarise(records, True).figures if one.name == "no estimate, clean")
    assert (figure.mean.value, figure.met) == (pytest.approx(silent / 20.0), met)


@pytest.mark.parametrize(
    ("interval", "share", "count"),
    [((0.004, 0.005), 1.0, 1), ((0.003, 0.004), 1.0, 1), ((0.0041, 0.005), 0.0, 1), ((0.003, math.nan), math.nan, 0)],
)
def test_an_interval_holds_its_ends(
    scored: Callable[..., ScoredRecord], interval: tuple[float, float], share: float, count: int
) -> None:
    figures = summarise([scored(answer={"lag_interval": interval})], True).figures
    (figure,) = (one for one in figures if one.name == "90 % interval of the lag holds the truth")
    assert (figure.mean.value, figure.count) == (pytest.approx(share, nan_ok=True), count)


def test_the_first_record_does_not_count_for_the_longest_time(scored: Callable[..., ScoredRecord]) -> None:
    records = [scored({"record": k}, {"seconds": seconds}) for k, seconds in enumerate((5.0, 0.1, 0.3))]
    assert summarise(records, True).seconds_per_record == Seconds(pytest.approx(1.8), 0.3)
    assert math.isnan(summarise(records[:1], True).seconds_per_record.largest_after_first)


def test_precision_is_of_what_was_found_and_recall_of_what_is_true(scored: Callable[..., ScoredRecord]) -> None:
    heard = {"events_in_time": EventScores(8, 16, 10), "events_in_arc": EventScores(4, 16, 10)}
    records = [scored({"record": k, "bearing_id": str(k)}, **heard) for k in range(3)]
    silent = scored({"bearing_id": "s"}, {"extent": math.nan}, events_in_time=BAD, events_in_arc=BAD)
    events = summarise(records, True).events
    answered = summarise([*records, silent], True).events
    for name, matched in (("within_100_us", 8.0), ("within_0.5_degrees", 4.0)):
        found = events[name]
        assert answered[f"{name}, answered records"] == found
        assert answered[name].recall.value == pytest.approx(3.0 * matched / 40.0)
        shares = (matched / 16.0, matched / 10.0, 2.0 * matched / 26.0)
        for share, expected in zip((found.precision, found.recall, found.f1), shares, strict=True):
            assert astuple(share) == pytest.approx((expected,) * 3)  # the same of every bearing


@pytest.mark.parametrize(("error", "met"), [(0.0, True), (0.04, True), (0.06, False)])
def test_the_lag_of_clean_records_is_met_up_to_5_per_cent_of_error(
    scored: Callable[..., ScoredRecord], error: float, met: bool
) -> None:
    records = [scored({"snr_db": math.inf}, {"lag": 0.004 * (1.0 + error)})]
    (figure,) = [one for one in summarise(records, True).figures if one.name == "lag error, clean"]
    assert (figure.mean.value, figure.met) == (pytest.approx(error), met)


def test_the_interval_of_a_mean_leaves_a_twentieth_out_at_either_end(scored: Callable[..., ScoredRecord]) -> None:
    values = np.random.default_rng(0).standard_normal(400)
    found = mean_with_interval(values.tolist(), [scored({"bearing_id": str(k)}) for k in range(400)])
    reach = 1.645 * values.std() / math.sqrt(400)  # of a normal distribution; 2000 draws tell quantiles to 4 %
    assert found.high - found.value == pytest.approx(reach, rel=0.1)
    assert found.value - found.low == pytest.approx(reach, rel=0.1)
