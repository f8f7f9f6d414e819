"""The drawing of speed against accuracy."""

import dataclasses

import pytest

from datagen.charts import contestants as entrants
from datagen.drawing.style import house_style
from datagen.drawing.work_precision import (
    RINGED,
    draw_work_precision,
)
from physics.integrators.rivals.general_purpose import BALL_BY_BALL


def test_the_default_is_named_in_the_legend_and_small_errors_are_on_the_panel(small_chart):
    tiny = dataclasses.replace(small_chart.runs[0].score, acceleration=3e-8)
    run = dataclasses.replace(small_chart.runs[0], name="modal", score=tiny)
    with house_style():
        figure = draw_work_precision(dataclasses.replace(small_chart, runs=(run,), edges={}))
        panel = figure.axes[1]
        named, low = [text.get_text() for text in panel.get_legend().get_texts()], panel.get_ylim()[0]
    assert named == ["modal (default)"]
    assert low == pytest.approx(1e-8)


@pytest.mark.parametrize(("error", "edge"), [(12.0, 8.0), (1e-9, 1e-8)])
def test_an_error_beyond_the_panel_is_ringed_on_its_edge_and_one_on_it_is_not(small_chart, error, edge):
    score = small_chart.runs[0].score
    runs = [
        dataclasses.replace(small_chart.runs[0], real_time=speed, score=dataclasses.replace(score, acceleration=value))
        for speed, value in ((3.0, 1e-3), (7.0, error))
    ]
    with house_style():
        drawn = {}
        for kept in (1, 2):
            chart = dataclasses.replace(small_chart, runs=tuple(runs[:kept]), edges={})
            figure = draw_work_precision(chart)
            drawn[kept] = {line.get_label(): line.get_xydata().tolist() for line in figure.axes[1].lines}
    assert RINGED not in drawn[1]
    assert drawn[2][RINGED] == [[7.0, edge]]
    assert drawn[2][runs[0].name] == [[3.0, 1e-3], [7.0, edge]]


def test_names_in_a_chart_do_not_lie_on_each_other(small_chart):
    speeds = {"exponential_rk4": 50.0, "exponential_adams4": 48.0, "runge_kutta4": 0.5}
    run = dict.fromkeys(("exponential_adams4", "runge_kutta4", "quasi-static"), small_chart.runs[0])
    model = next(one for one in small_chart.runs if one.group == entrants.MODEL)
    more = [dataclasses.replace(model if name == "quasi-static" else one, name=name) for name, one in run.items()]
    with house_style():
        figure = draw_work_precision(dataclasses.replace(small_chart, edges=speeds, runs=(*small_chart.runs, *more)))
        figure.draw_without_rendering()
        strip, panel = figure.axes
        boxes = [text.get_window_extent() for text in (*strip.texts, *panel.texts, *figure.texts)]
        named = [text.get_text() for text in panel.get_legend().get_texts()]
    assert len(boxes) == len(speeds) + 2
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])
    assert not any(box.overlaps(panel.get_window_extent()) for box in boxes)
    assert {"model: impulse train", "model: quasi-static"} <= set(named)


def test_target_real_time_and_longest_stable_steps_stand_where_they_are(small_chart):
    one = small_chart.runs[0]
    silent = dataclasses.replace(one, name="runge_kutta4", score=None)
    chart = dataclasses.replace(small_chart, runs=(one, silent), edges={one.name: 50.0, "runge_kutta4": 0.5})
    with house_style():
        strip, panel = draw_work_precision(chart).axes
    lines = [line.get_xydata().tolist() for line in panel.lines]
    assert [[0.0, 1e-3], [1.0, 1e-3]] in lines  # across the panel
    assert [[1.0, 0.0], [1.0, 1.0]] in lines
    assert [line.get_xydata().tolist() for line in strip.lines] == [[[50.0, 0.0]], [[0.5, 1.0]]]
    assert [text.get_text() for text in panel.get_legend().get_texts()] == [one.name, "runge_kutta4: gave up"]
    assert [text.get_ha() for text in strip.texts] == ["right", "left"]  # each towards the middle of the panel
    assert [text.xyann[0] for text in strip.texts] == [-6, 6]


def test_what_was_simulated_and_how_long_is_told(small_chart):
    with house_style():
        facts = draw_work_precision(small_chart).texts[1].get_text()
    assert facts.startswith(f"{small_chart.rate:g} Hz, 0.12 s, against {small_chart.reference}; ")


@pytest.mark.parametrize(
    ("name", "marker", "style"), [("SciPy RK45", "^", "--"), (f"SciPy RK45, {BALL_BY_BALL}", "s", ":")]
)
def test_solvers_that_see_each_ball_by_itself_are_told_from_those_on_the_kernel(small_chart, name, marker, style):
    rival = dataclasses.replace(small_chart.runs[0], name=name, group="a library's solver")
    with house_style():
        panel = draw_work_precision(dataclasses.replace(small_chart, runs=(rival,), edges={})).axes[1]
    (line,) = (line for line in panel.lines if line.get_label() == name)
    assert (line.get_marker(), line.get_linestyle()) == (marker, style)
