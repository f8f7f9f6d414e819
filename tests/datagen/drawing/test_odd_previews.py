"""Previews of records that are silent, very short, slowly sampled or full of spalls."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from datagen.drawing.frequency_panels import line_heights
from datagen.drawing.sheet import draw_sheet, heading, summary
from datagen.drawing.style import house_style
from labels.truth import ball_passes
from physics.spall import Spall


def axes_of(drawn, beginning):
    """The panel of the drawn sheet whose title begins like that; warnings are errors, here as in every test."""
    with house_style(), warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = draw_sheet(drawn)
        figure.draw_without_rendering()
        found = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith(beginning))
    return found


def test_lines_above_half_the_rate_are_said_to_be_there_and_not_looked_for(portrait):
    drawn = portrait("line, outer")
    slow = replace(drawn, rate=65.0)  # balls pass at 34.28 Hz
    panel = axes_of(slow, "Squared")
    assert panel.get_xlim() == (0.0, 32.5)
    assert panel.get_legend_handles_labels()[1][0] == "BPFO 34.28 Hz (above half the rate)"
    assert panel.lines[1].get_xdata().size == 0
    assert line_heights(np.array([0.0, 1.0, 2.0]), np.ones(3), [0.0, 0.4, 2.1, 9.0], 0.3) == [(1.0, 1.0), (2.0, 1.0)]


def test_silence_is_drawn_without_a_warning(portrait):
    drawn = portrait("line, outer")
    still = np.zeros_like(drawn.acceleration)
    panel = axes_of(replace(drawn, acceleration=still, clean=still, envelope=still[:, 0]), "Squared")
    low, high = panel.get_ylim()
    assert 0.0 < low < high  # of a logarithmic axis
    assert (panel.lines[0].get_ydata() <= low).all()  # the spectrum lies at the foot
    assert all(line.get_xdata().size == 0 for line in panel.lines[1:])  # and no line stands out of it


@pytest.fixture
def too_short(portrait):
    """4 ms in which no ball passes the spall."""
    drawn = portrait("line, outer")
    samples = round(0.004 * drawn.rate)
    cut = {name: getattr(drawn, name)[:samples] for name in ("acceleration", "clean", "envelope")}
    passes = ball_passes(drawn.scene, None, 0.004)
    assert len(passes) == 0
    return replace(drawn, passes=passes, **cut)


def test_a_record_too_short_for_a_pass_or_a_line_says_so(too_short):
    words = [text.get_text() for text in axes_of(too_short, "Squared").texts]
    assert words == ["too short a record: its lines lie 250 Hz apart"]
    with house_style():
        figure = draw_sheet(too_short)
        words = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert "no ball passes a spall in this time" in words
    assert "no defect to pass" not in words


def test_where_no_pass_is_shown_the_load_is_that_of_a_full_turn_on_an_axis_of_its_own(too_short):
    panel = axes_of(too_short, "Quasi-static load")
    assert panel.get_title(loc="left") == "Quasi-static load of a ball on a full turn"
    assert panel.get_xlim() == (-180.0, 180.0)
    assert axes_of(too_short, "Path").get_xlim() == pytest.approx((-1.7, 1.7))  # 2 degrees and 0.35 of them around


def test_of_several_spalls_the_one_whose_pass_is_shown_is_drawn(portrait):
    drawn = portrait("line, outer")
    wide = Spall("outer", 1, math.radians(90.0), math.radians(6.0), 12e-6)  # the largest, where no ball is loaded
    several = replace(drawn, scene=replace(drawn.scene, spalls=(*drawn.scene.spalls, wide)))
    assert several.passes.defect[several.shown_pass] == 0
    assert "spall 1 of 2, 2° = 0.801 mm" in axes_of(several, "Path").get_title(loc="left")
    assert "on its way over the spall" in axes_of(several, "Quasi-static load").get_title(loc="left")
    assert heading(several).endswith("2 spalls, outer race (the largest: line)")
    passes = replace(drawn.passes, defect=np.ones_like(drawn.passes.defect))
    other_way = replace(several, scene=replace(drawn.scene, spalls=several.scene.spalls[::-1]), passes=passes)
    assert "spall 2 of 2, 2° = 0.801 mm" in axes_of(other_way, "Path").get_title(loc="left")


def test_a_stiffness_that_hardly_changes_is_drawn_as_a_level_line(portrait):
    drawn = portrait("line, outer")
    steady = np.full_like(drawn.stiffness, 97.8e6) + np.linspace(0.0, 10.0, drawn.stiffness.shape[1])
    low, high = axes_of(replace(drawn, stiffness=steady), "Quasi-static stiffness").get_ylim()
    assert high - low > 1e-3 * 97.8


@pytest.mark.parametrize(
    ("error", "load", "said"),
    [(1.0, 12345.6, "12346 N"), (0.9951, 9999.7, "10000 N"), (0.00049, 518.41, "518.4 N")],
)
def test_a_sheet_states_large_figures_without_powers_of_ten(portrait, error, load, said):
    drawn = portrait("line, outer")
    line = summary(replace(drawn, labels=drawn.labels | {"error_estimate": error, "load_n": load}))
    assert f"  ·  {said}  ·  " in line
    assert line.endswith("estimated error 100 %" if error > 0.99 else "estimated error 0.049 %")
