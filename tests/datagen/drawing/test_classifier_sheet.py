"""The sheet of a benchmark: panels of what there is to show, and words where a corpus has nothing to score."""

from dataclasses import replace

import numpy as np
import pytest

from datagen.benchmark.model_scores import Calibration, Confusion
from datagen.benchmark.options import Options
from datagen.benchmark.results import CorpusResults, CorpusScores, NoisyScores, Results
from datagen.drawing.classifier_panels import (
    draw_against,
    draw_confusion,
    draw_curve,
    draw_importances,
    draw_noise,
    draw_reliability,
    draw_scores,
)
from datagen.drawing.classifier_sheet import columns, draw_results, scores_png
from datagen.drawing.style import INK, house_style, with_panels
from labels.interval import Interval

HALF = Interval(0.5, 0.4, 0.6)


@pytest.fixture
def summary_of(made_scores):
    """Function (healthy records, outer faults) → the summary of a corpus of so many, with one model."""
    return lambda none, outer: summary(made_scores, none, outer)


def summary(made_scores, none, outer):
    scores = made_scores(healthy=none, false_alarms=min(none, 2))
    if outer:
        scores = replace(scores, faults_balanced_accuracy=HALF, race_accuracy=HALF)
    if none and outer:
        scores = replace(scores, detection_auc=HALF)
    locations = {"none": none, "outer": outer, "inner": 0}
    return CorpusScores("out/made", False, none + outer, locations, {}, {}, {}, {}, {}, {}, 0, 0, {"rule": scores})


@pytest.fixture
def words():
    """Function (drawing, *arguments) → all words that it writes on an axes."""

    def written(draw, *arguments):
        with house_style():
            _, axes = with_panels(figsize=(4.0, 3.0))
            draw(axes, *arguments)
            texts = " ".join(text.get_text() for text in axes.texts)
        return texts

    return written


def test_a_corpus_without_faults_shows_its_false_alarms(words, summary_of):
    said = words(draw_scores, summary_of(96, 0))
    assert "no faults to score" in said
    assert "rule: 2 of 96" in said


def test_a_corpus_without_healthy_records_says_that_it_has_none(words, summary_of):
    assert "no healthy" in words(draw_scores, summary_of(0, 10))
    assert words(draw_scores, summary_of(5, 10)) == ""


def test_a_corpus_of_unknown_state_says_so(words, summary_of):
    unknown = replace(summary_of(0, 0), locations={"none": 0, "outer": 0, "inner": 0, "unknown": 7})
    assert words(draw_scores, unknown) == "the true class of no record is known"


def test_every_model_has_its_table_of_confusion(summary_of):
    test = summary_of(5, 10)
    (scores,) = test.models.values()
    counts = {"rule": 7, "forest": 8, "logistic": 9}
    models = {
        name: replace(scores, confusion=replace(scores.confusion, counts=[[count]])) for name, count in counts.items()
    }
    with house_style():
        figure, axes = with_panels(figsize=(4.0, 3.0))
        draw_confusion(axes, replace(test, models=models))
        drawn = {panel.get_title(loc="left"): panel.texts[0].get_text() for panel in figure.axes if panel.texts}
    assert drawn == {"said by rule": "7", "said by forest": "8", "said by logistic": "9"}


COUNTS = [[0, 0, 0, 0], [1, 9, 0, 0], [0, 5, 5, 0], [0, 0, 0, 0]]


def test_classes_of_no_record_have_no_row_and_dark_cells_have_white_digits(summary_of):
    test = summary_of(0, 10)
    table = Confusion(("none", "outer", "inner", "unknown"), ("none", "outer", "inner", "rejected"), COUNTS)
    models = {"rule": replace(test.models["rule"], confusion=table)}
    with house_style():
        figure, axes = with_panels(figsize=(4.0, 3.0))
        draw_confusion(axes, replace(test, models=models))
    panel = figure.axes[-1]
    assert [label.get_text() for label in panel.get_yticklabels()] == ["outer", "inner"]
    assert {text.get_text(): text.get_color() for text in panel.texts} == {
        "0": INK, "1": INK, "5": INK, "9": "white",
    }  # fmt: skip


def point(at, **more):
    return {"at": at, "bearings": at, "records": 5, "accuracy": 0.5, "value": 0.5, "low": 0.4, "high": 0.6} | more


@pytest.fixture
def results_of(summary_of):
    """Function (corpora tested=1, levels of noise=(), **fields of the facts) → results of ten faults and five healthy
    records, of which the accuracy over speeds is known; of two models."""

    def made(tested=1, levels=(), **facts):
        test = summary_of(5, 10)
        rule = replace(test.models["rule"], accuracy_against={"speed_rpm": [point(900), point(1800)]})
        calibrated = Calibration({"predicted": [0.1, 0.9], "observed": [0.0, 1.0], "records": [5, 5]}, HALF)
        test = replace(test, models={"rule": rule, "forest": replace(rule, calibration=calibrated)})
        noise = [NoisyScores(level, 1, test) for level in levels]
        facts = {"importances": {"forest": {"kurtosis": 0.1}}} | facts
        return Results("out/learned", Options(), facts, [CorpusResults(test, [], noise)] * tested, 1.0)

    return made


def drawn(results):
    with house_style():
        figure = draw_results(results)
        figure.draw_without_rendering()
    return figure


def shown(figure):
    """Titles of the panels that show something, those of tables of confusion left out."""
    titles = [axes.get_title(loc="left") for axes in figure.axes if axes.axison]
    return [title for title in titles if not title.startswith("said by")]


def empty_places(figure):
    tables = sum(axes.get_title(loc="left") == "said by rule" for axes in figure.axes)
    return sum(not axes.axison for axes in figure.axes) - tables  # each stands in a place of its own


def test_only_what_says_something_has_a_panel(results_of):
    figure = drawn(results_of())
    assert shown(figure) == ["scores", "reliability", "faults, by speed", "importances, forest"]
    assert empty_places(figure) == 0
    quiet = results_of()
    (test,) = quiet.tests
    lone = {"rule": replace(test.scores.models["rule"], accuracy_against={"speed_rpm": [point(900)]})}
    quiet = replace(quiet, tests=[replace(test, scores=replace(test.scores, models=lone))])
    assert shown(drawn(quiet)) == ["scores", "importances, forest"]


@pytest.mark.parametrize(
    ("quantity", "places", "scale"),
    [
        ("extent_mm", (0.4, 22.0), "log"),
        ("extent_mm", (4.0, 22.0), "linear"),
        ("extent_mm", (0.0, 22.0), "linear"),
        ("snr_db", (0.4, 22.0), "linear"),
    ],
)
def test_sizes_of_several_decades_have_a_logarithmic_axis(quantity, places, scale):
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw_against(axes, {"rule": [point(at) for at in places]}, quantity)
    assert axes.get_xscale() == scale


def test_scores_with_noise_added_are_drawn_over_its_level(results_of):
    assert "faults, with noise added" in shown(drawn(results_of(levels=(0.0,))))
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw_noise(axes, results_of(levels=(0.0, -10.0)).tests[0])
    assert [label.get_text() for label in axes.get_xticklabels()] == ["-10", "0", "none added"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["rule", "forest"]


def lines_of(draw, *arguments):
    """The lines that a panel draws, by the names in its legend, and its axes."""
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw(axes, *arguments)
    return {line.get_label(): line for line in axes.lines}, axes


def test_a_reliability_curve_is_what_was_observed_over_what_was_predicted():
    curve = {"predicted": [0.1, 0.6], "observed": [0.2, 0.9]}
    lines, axes = lines_of(draw_reliability, {"rule": None, "forest": curve})
    assert lines["forest"].get_xydata().tolist() == [[0.1, 0.2], [0.6, 0.9]]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("predicted probability of a spall", "share of spalls")
    assert "rule" not in lines


def test_the_most_important_feature_stands_on_top_and_no_more_than_fifteen_are_drawn():
    _, axes = lines_of(draw_importances, "forest", {f"feature {k}": 1.0 / k for k in range(1, 21)})
    from_the_top = [label.get_text() for label in axes.get_yticklabels()][::-1]
    assert from_the_top == [f"feature {k}" for k in range(1, 16)]
    assert [bar.get_width() for bar in axes.patches][::-1] == [1.0 / k for k in range(1, 16)]


def test_scores_have_their_intervals_from_end_to_end(summary_of):
    _, axes = lines_of(draw_scores, summary_of(5, 10))
    drawn = [line.get_ydata().tolist() for line in axes.lines if len(line.get_xdata())]
    assert drawn == [[0.4, 0.6], [0.5]] * 3


@pytest.mark.parametrize("draw", [lambda axes, table: draw_against(axes, table, "speed_rpm"), draw_curve])
def test_curves_have_their_intervals_as_bands(draw):
    points = [point(8, bearings=8, low=0.1, high=0.7), point(9, bearings=9, low=0.2, high=0.8)]
    _, axes = lines_of(draw, {"forest": points})
    (band,) = axes.collections
    assert {tuple(place) for place in band.get_paths()[0].vertices} == {(8.0, 0.1), (8.0, 0.7), (9.0, 0.2), (9.0, 0.8)}


def test_a_learning_curve_is_over_bearings_in_the_colour_that_its_model_has_beside_the_rule():
    points = [point(1, bearings=80), point(2, bearings=90)]
    curve, _ = lines_of(draw_curve, {"forest": points})
    against, _ = lines_of(draw_against, {"rule": points, "forest": points}, "speed_rpm")
    assert curve["forest"].get_xdata().tolist() == [80, 90]
    assert against["forest"].get_xdata().tolist() == [1, 2]
    assert curve["forest"].get_color() == against["forest"].get_color() != against["rule"].get_color()


def test_every_panel_of_scores_names_its_axis_and_its_models(results_of):
    figure = drawn(results_of(levels=(0.0,)))
    panels = {axes.get_title(loc="left"): axes for axes in figure.axes}
    for title in ("scores", "faults, by speed", "faults, with noise added"):
        assert panels[title].get_ylabel()
        assert [text.get_text() for text in panels[title].get_legend().get_texts()] == ["rule", "forest"]


def test_a_caption_says_what_the_words_mean(results_of):
    said = drawn(results_of()).get_supxlabel()
    for word in ("faults:", "race:", "AUC:", "95 % intervals"):
        assert word in said


def test_every_corpus_has_its_heading_and_the_models_follow(results_of):
    figure = drawn(results_of(tested=2))
    headings = [part.get_suptitle() for part in figure.subfigs]
    assert headings == ["made: 15 records, learned from learned"] * 2 + ["learned from learned"]
    assert [part.get_suptitle() for part in drawn(results_of()).subfigs] == headings[:1]


def test_a_learning_curve_of_one_point_is_left_out(results_of):
    assert "learning curve" not in shown(drawn(results_of(learning_curve={"forest": [point(8)]})))
    curve = {"forest": [point(8), point(9)]}
    assert "learning curve" in shown(drawn(results_of(learning_curve=curve)))
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw_curve(axes, curve)
    assert all(float(place).is_integer() for place in axes.get_xticks())


@pytest.mark.parametrize(
    ("panels", "across"), [([2], 2), ([5], 5), ([8], 4), ([7], 4), ([6, 5, 2], 3), ([10, 10], 5), ([12], 4)]
)
def test_sections_stand_in_as_many_columns_as_leave_the_fewest_places_empty(panels, across):
    assert columns(panels) == across


def test_where_nothing_was_tested_the_models_are_drawn_alone(results_of):
    assert shown(drawn(results_of(tested=0))) == ["importances, forest"]
    assert scores_png(results_of(tested=0, importances={})).startswith(b"\x89PNG")


def test_the_sheet_of_a_corpus_without_faults_is_a_picture(summary_of):
    results = Results("out/made", Options(), {"importances": {}}, [CorpusResults(summary_of(96, 0), [], [])], 1.0)
    assert scores_png(results).startswith(b"\x89PNG")


def test_dollar_signs_in_the_name_of_a_folder_are_no_mathematics(summary_of):
    scores = replace(summary_of(96, 10), corpus="out/mill $\\frac$ 3")
    results = Results("out/made", Options(), {"importances": {}}, [CorpusResults(scores, [], [])], 1.0)
    assert scores_png(results).startswith(b"\x89PNG")


def test_the_names_of_models_do_not_lie_upon_low_scores(summary_of):
    test = summary_of(5, 10)
    low = replace(test.models["rule"], faults_balanced_accuracy=Interval(0.0, 0.0, 0.6), race_accuracy=HALF)
    models = dict.fromkeys(("rule", "forest", "logistic", "boosting"), low)
    with house_style():
        figure, axes = with_panels(figsize=(4.0, 2.5))
        draw_scores(axes, replace(test, models=models))
        figure.draw_without_rendering()
        names = axes.get_legend().get_window_extent()
        lines = [line.get_path().interpolated(20).vertices for line in axes.lines if len(line.get_xdata())]
        places = axes.transData.transform(np.concatenate(lines))
    assert len(places) > 100
    assert not any(names.contains(*place) for place in places)
