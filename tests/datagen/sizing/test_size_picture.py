"""The picture of scored spall sizes: few records, many machines, nothing answered."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from datagen.drawing.size_report import draw_size_report, most_frequent
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


def test_each_panel_shows_what_its_title_and_axes_say(scored: Callable[..., ScoredRecord]) -> None:
    clean = scored(
        {"snr_db": 99.0, "lag": 0.004, "extent": math.radians(5.0)},
        {"lag": 0.005, "extent": math.radians(6.0), "lag_arc": math.radians(1.0), "trust": 0.92},
        envelope_arc=math.radians(8.0),
        static_arc=math.radians(4.0),
    )
    noisy = scored({"record": 1, "lag": 0.008, "extent": 0.1}, {"lag": 0.006, "extent": 0.12, "trust": 0.92})
    silent = scored({"record": 2}, {"lag": math.nan, "extent": math.nan, "trust": 0.92})
    long = scored({"record": 3, "extent_spacing": 1.4, "extent": 0.6}, {"extent": 0.1})  # is not scored
    healthy = scored({"record": 4, "lag": math.nan}, {"lag": math.nan, "extent": math.nan, "trust": 0.12})
    lags, extents, rules, noise, trust, *_ = drawn([clean, noisy, silent, long, healthy]).axes
    for panel, scale, what, unit in ((lags, 1e3, "lag", "ms"), (extents, 180.0 / math.pi, "extent", "degrees")):
        shown = {str(line.get_label()): line.get_xydata().tolist() for line in panel.lines}
        for name, record in (("clean", clean), ("noisy", noisy)):
            pair = [scale * getattr(of, what) for of in (record.truth, record.answer)]
            assert shown[name] == [pytest.approx(pair)]
        (even,) = (line for line in panel.lines if line.get_label() not in shown.keys() & {"clean", "noisy"})
        assert list(even.get_xdata()) == list(even.get_ydata())
        assert (panel.get_xlabel(), panel.get_ylabel()) == (f"true, {unit}", f"estimated, {unit}")
    assert heights(rules) == {
        "this estimator": pytest.approx([0.2, 0.2]),
        "full size, own lag": pytest.approx([0.8, 0.2]),
        "half size, own lag": pytest.approx([0.6, 0.6]),
        "plain envelope lag": pytest.approx([0.6, 0.5]),
        "own lag and static release": pytest.approx([0.2, 0.0]),
    }
    assert noise.get_title(loc="left") == "Noise, dB (records)"
    assert [label.get_text() for label in noise.get_xticklabels()] == ["clean\n(1)", "10\n(2)"]
    assert heights(noise) == {
        "lag": pytest.approx([0.25, 0.25]),
        "arc": pytest.approx([0.2, 0.2]),
        "no estimate, share": pytest.approx([0.0, 0.5]),
    }
    filled = {str(patch.get_label()): {round(x, 2) for x, y in patch.get_xy() if y > 0.0} for patch in trust.patches}
    assert filled == {"no event": {0.1, 0.15}, "to be given a size": {0.9, 0.95}}  # the ends of one bin each


def test_a_rule_that_says_nothing_of_some_records_is_judged_by_the_others(scored: Callable[..., ScoredRecord]) -> None:
    records = [scored({"record": 1}, static_arc=math.nan), scored({"record": 2}, static_arc=0.14)]
    assert heights(drawn(records).axes[2])["own lag and static release"] == pytest.approx([0.4])


def test_of_too_many_rows_those_of_the_most_records_are_kept_in_their_order(
    scored: Callable[..., ScoredRecord],
) -> None:
    records = [scored({"record": k, "rig": rig}) for k, rig in enumerate("abbccddeeffgghhjjkk")]
    rows = summarise(records, True).by["rig"]
    assert [row.value for row in most_frequent(rows)] == list("bcdefghj")


def test_the_bars_of_a_value_stand_round_its_name(scored: Callable[..., ScoredRecord]) -> None:
    panel = drawn([scored()]).axes[3]
    middles = [bar.get_x() + 0.5 * bar.get_width() for bars in panel.containers for bar in bars]
    assert middles == pytest.approx([-0.27, 0.0, 0.27])
    assert panel.get_xticks().tolist() == [0]


def heights(panel: Axes) -> dict[str, list[float]]:
    """The heights of all bars of a panel by their name in the legend."""
    return {str(bars.get_label()): [bar.get_height() for bar in bars] for bars in panel.containers}


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
