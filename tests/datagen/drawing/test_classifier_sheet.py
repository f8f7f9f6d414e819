"""The sheet of a benchmark says in words what a corpus leaves nothing to draw of."""

from dataclasses import replace

import pytest

from datagen.benchmark.options import Options
from datagen.benchmark.results import CorpusResults, CorpusScores, Results
from datagen.drawing.classifier_sheet import draw_against, draw_confusion, draw_reliability, draw_scores, scores_png
from datagen.drawing.style import house_style, with_panels
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
    return CorpusScores("out/made", False, none + outer, locations, {}, {}, {}, {}, {}, {"rule": scores})


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


def test_what_cannot_be_drawn_is_explained(words, summary_of):
    assert "needs healthy records" in words(draw_reliability, summary_of(96, 0))
    assert "unknown, or the same in all" in words(draw_against, summary_of(96, 0), "snr_db")


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


def test_the_sheet_of_a_corpus_without_faults_is_a_picture(summary_of):
    results = Results("out/made", Options(), {"importances": {}}, [CorpusResults(summary_of(96, 0), [], [])], 1.0)
    assert scores_png(results).startswith(b"\x89PNG")


def test_dollar_signs_in_the_name_of_a_folder_are_no_mathematics(summary_of):
    scores = replace(summary_of(96, 10), corpus="out/mill $\\frac$ 3")
    results = Results("out/made", Options(), {"importances": {}}, [CorpusResults(scores, [], [])], 1.0)
    assert scores_png(results).startswith(b"\x89PNG")
