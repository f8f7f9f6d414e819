"""The picture of scored spall sizes: few records, many machines, nothing answered."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from matplotlib.figure import Figure

from datagen.drawing.size_report import draw_size_report
from datagen.drawing.style import house_style
from datagen.sizing.aggregation import summarise
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.size_scores import SizeScores


def drawn(records: list[ScoredRecord]) -> Figure:
    with house_style():
        summary = summarise(records, True)
        figure = draw_size_report(SizeScores("x", "spallgen", "all", True, records, summary, []), summary)
        figure.draw_without_rendering()
    return figure


@pytest.mark.parametrize("rigs", [2, 13])
def test_the_names_below_the_bars_do_not_lie_on_each_other(rigs: int, scored: Callable[..., ScoredRecord]) -> None:
    records = [scored({"record": k, "rig": f"an imaginary rig {k % rigs}", "bearing_id": f"b{k}"}) for k in range(26)]
    figure = drawn(records)
    panel = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Rig"))
    boxes = [label.get_window_extent() for label in panel.get_xticklabels() if not label.get_rotation()]
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])
    assert len(panel.get_xticklabels()) == min(rigs, 8)
    assert panel.get_title(loc="left") == ("Rig (records, 8 of 13)" if rigs > 8 else "Rig (records)")
    low, high = panel.get_xlim()
    assert low + high == pytest.approx(min(rigs, 8) - 1)  # the bars stand in the middle


def titles(figure: Figure) -> list[str]:
    return [axes.get_title(loc="left").removesuffix(" (records)") for axes in figure.axes if axes.axison]


def test_what_is_the_same_in_all_records_has_no_panel(scored: Callable[..., ScoredRecord]) -> None:
    figure = drawn([scored({"record": k, "race": ("outer", "inner")[k % 2]}) for k in range(4)])
    assert titles(figure)[3:] == ["Race", "Trust in the pair of events"]
    bars = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Race"))
    assert [text.get_text() for text in bars.get_legend().get_texts()] == ["lag", "arc", "no estimate, share"]
    assert len(figure.axes) == 6
    assert titles(drawn([scored()]))[3:] == ["Noise, dB", "Trust in the pair of events"]


def test_the_rules_are_compared_at_the_noise_there_is(scored: Callable[..., ScoredRecord]) -> None:
    rules = drawn([scored({"record": k, "snr_db": (5.0, 80.0)[k % 2]}) for k in range(4)]).axes[2]
    assert [label.get_text() for label in rules.get_xticklabels()] == ["clean", "5"]


@pytest.mark.parametrize("lags", [(2.8e-4, 5.2e-4), (2e-4, 9e-3)])
def test_ticks_of_the_true_lag_do_not_lie_on_each_other(
    lags: tuple[float, float], scored: Callable[..., ScoredRecord]
) -> None:
    figure = drawn([scored({"record": k, "lag": lag}, {"lag": lag}) for k, lag in enumerate(lags)])
    labels = [label for label in figure.axes[0].get_xticklabels(which="both") if label.get_text()]
    boxes = [label.get_window_extent() for label in labels]
    assert len(labels) > 1
    assert all("$" not in label.get_text() for label in labels)
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])


def test_where_nothing_was_answered_the_panels_say_so(scored: Callable[..., ScoredRecord]) -> None:
    records = [scored({"record": k}, {"outcome": "no_events", "lag": math.nan, "extent": math.nan}) for k in range(3)]
    figure = drawn(records)
    assert [[text.get_text() for text in axes.texts] for axes in figure.axes[:3]] == [
        ["no record was given a size"]
    ] * 3


def test_dollar_signs_in_the_name_of_a_rig_are_no_mathematics(scored: Callable[..., ScoredRecord]) -> None:
    figure = drawn([scored({"record": k, "rig": f"mill $\\frac$ {k % 2}"}) for k in range(3)])
    panel = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Rig"))
    assert [label.get_text() for label in panel.get_xticklabels()] == [
        "mill $\\frac$ 0\n(2)",
        "mill $\\frac$ 1\n(1)",
    ]
