"""The sheet of a benchmark says in words what a corpus leaves nothing to draw of."""

import pytest

from datagen.drawing.scores import draw_against, draw_confusion, draw_reliability, draw_scores, scores_png
from datagen.drawing.style import house_style, plt

NONE = {"value": float("nan"), "low": float("nan"), "high": float("nan")}
HALF = {"value": 0.5, "low": 0.4, "high": 0.6}


def summary_of(none, outer):
    """The summary of a corpus of so many healthy records and outer faults, with one model."""
    found = HALF if outer else NONE
    scores = {
        "faults_balanced_accuracy": found,
        "race_accuracy": found,
        "detection_auc": HALF if none and outer else NONE,
        "healthy": none,
        "false_alarms": min(none, 2),
        "confusion": {"rows": ["none"], "columns": ["none"], "counts": [[1]]},
        "accuracy_against": {},
    }
    locations = {"none": none, "outer": outer, "inner": 0}
    return {"corpus": "out/made", "records": none + outer, "locations": locations, "models": {"rule": scores}}


@pytest.fixture
def words():
    """Function (drawing, *arguments) → all words that it writes on an axes."""

    def written(draw, *arguments):
        with house_style():
            figure, axes = plt.subplots()
            draw(axes, *arguments)
            texts = " ".join(text.get_text() for text in axes.texts)
            plt.close(figure)
        return texts

    return written


def test_a_corpus_without_faults_shows_its_false_alarms(words):
    said = words(draw_scores, summary_of(96, 0))
    assert "no faults to score" in said
    assert "rule: 2 of 96" in said


def test_a_corpus_without_healthy_records_says_that_it_has_none(words):
    assert "no healthy" in words(draw_scores, summary_of(0, 10))
    assert words(draw_scores, summary_of(5, 10)) == ""


def test_what_cannot_be_drawn_is_explained(words):
    assert "needs healthy records" in words(draw_reliability, summary_of(96, 0))
    assert "unknown, or the same in all" in words(draw_against, summary_of(96, 0), "snr_db")


def test_every_model_has_its_table_of_confusion():
    test = summary_of(5, 10)
    (scores,) = test["models"].values()
    counts = {"rule": 7, "forest": 8, "logistic": 9}
    test["models"] = {
        name: scores | {"confusion": scores["confusion"] | {"counts": [[count]]}} for name, count in counts.items()
    }
    with house_style():
        figure, axes = plt.subplots()
        draw_confusion(axes, test)
        drawn = {panel.get_title(loc="left"): panel.texts[0].get_text() for panel in figure.axes if panel.texts}
        plt.close(figure)
    assert drawn == {"said by rule": "7", "said by forest": "8", "said by logistic": "9"}


def test_the_sheet_of_a_corpus_without_faults_is_a_picture():
    results = {"tests": [summary_of(96, 0)], "importances": {}}
    assert scores_png(results).startswith(b"\x89PNG")
