"""The picture of docs/transfer.md shows what the report says."""

import pytest
from make_transfer_picture import draw

from datagen.drawing.style import house_style

MODELS = ("rule", "forest")
SCORED = {"rule": 0.5, "forest": 0.75}


def _models(shift):
    curve = {"predicted": [0.2, 0.9], "observed": [0.1, 0.8 + shift]}
    point = {"at": 1.0, "accuracy": 0.4 + shift, "low": 0.3, "high": 0.6}
    found = {}
    for name in MODELS:
        value = SCORED[name] + shift
        found[name] = {
            "faults_balanced_accuracy": {"value": value, "low": value - 0.1, "high": value + 0.1},
            "accuracy_against": {quantity: [point] for quantity in ("snr_db", "speed_rpm", "extent_mm")},
        }
    found["forest"]["reliability"] = curve
    return found


def _test(name, outer, noise=()):
    levels = [{"snr_db": level, "models": _models(shift)} for level, shift in noise]
    return {"corpus": f"out/{name}", "locations": {"outer": outer, "inner": 0}, "models": _models(0.0), "noise": levels}


@pytest.fixture(scope="module")
def figure():
    noise = ((-10.0, -0.1), (-16.0, -0.3))
    with house_style():
        return draw(
            {
                "tests": [
                    _test("cwru_de12k", 3, noise),
                    _test("mfpt", 2, noise),
                    _test("healthy", 0),
                    _test("transfer", 9),
                ],
                "learning_curve": {
                    "forest": [{"bearings": n, "value": 0.8, "low": 0.7, "high": 0.9} for n in (10, 20)]
                },
                "importances": {"forest": {"crest_factor": 0.2}},
            },
            _models(0.1),
        )


def _markers(figure, start):
    """Heights of the single dots of the panel whose title begins so, by place along the axis."""
    panel = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith(start))
    dots = [line.get_xydata()[0] for line in panel.lines if line.get_marker() == "o" and len(line.get_xydata()) == 1]
    places = {}
    for at, height in dots:
        places.setdefault(round(at), []).append(pytest.approx(height))
    return places, [label.get_text() for label in panel.get_xticklabels()]


def test_corpora_without_faults_are_left_out(figure):
    places, names = _markers(figure, "faults, by corpus")
    assert names == ["cwru\nde12k", "mfpt", "transfer"]
    assert places == {0: [0.5, 0.75], 1: [0.5, 0.75], 2: [0.5, 0.75]}


def test_levels_of_noise_stand_in_order_and_none_added_last(figure):
    places, names = _markers(figure, "cwru_de12k, with")
    assert names == ["-16", "-10", "none added"]
    assert places == {0: [0.2, 0.45], 1: [0.4, 0.65], 2: [0.5, 0.75]}


def test_a_rule_without_probabilities_has_no_reliability(figure):
    panel = next(axes for axes in figure.axes if axes.get_title(loc="left") == "reliability")
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["forest"]


def test_what_depends_on_snr_speed_size_and_probability_is_of_the_machines_judged_by_learners_of_others(figure):
    panels = {axes.get_title(loc="left"): axes for axes in figure.axes}
    for name in ("SNR", "speed", "size"):
        heights = [line.get_ydata()[0] for line in panels[f"faults, by {name}"].lines]
        assert heights == pytest.approx([0.5, 0.5]), name  # of both models; of those of the report 0.4
    assert panels["reliability"].lines[-1].get_ydata() == pytest.approx([0.1, 0.9])
