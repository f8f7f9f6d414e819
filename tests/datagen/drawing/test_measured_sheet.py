from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import QuadMesh
from matplotlib.patches import Rectangle
from matplotlib.text import Text

from datagen.drawing.measured_portrait import MeasuredPortrait
from datagen.drawing.measured_sheet import draw_measured_sheet, heading, measured_sheet_png, summary
from datagen.drawing.style import house_style

RATE = 8000.0
LABELS: dict[str, Any] = {
    "record": 4, "recording": "105 DE", "condition": "line", "location": "outer", "rig": "mill", "bearing": "6205",
    "speed_rpm": 1500.0, "speed_basis": "nominal", "load_n": math.nan, "extent_mm": 0.5, "bpfo": 3.6, "bpfi": 5.4,
    "bsf": 2.4, "ftf": 0.4, "envelope_band": (2000.0, 3000.0),
}  # fmt: skip
UNKNOWN: dict[str, Any] = {
    "speed_rpm": math.nan, "location": "unknown", "condition": "unknown", "envelope_band": (math.nan, math.nan),
    "extent_mm": math.nan,
}  # fmt: skip


def portrait(axes: tuple[str, ...] = ("y",), **changes: Any) -> MeasuredPortrait:
    """A second of bursts at 90 Hz on a carrier of 2500 Hz; the largest begins at 0.7 s."""
    time = np.arange(8000) / RATE
    since = time % (1.0 / 90.0)
    strength = 1.0 + 2.0 * ((time >= 0.7) & (time < 0.7 + 1.0 / 90.0))
    signal = strength * np.exp(-800.0 * since) * np.sin(2.0 * np.pi * 2500.0 * since)
    return MeasuredPortrait("mine", LABELS | changes, RATE, axes, np.stack([signal] * len(axes), axis=1))


def test_fast_machines_and_heavy_loads_are_told_without_powers_of_ten() -> None:
    line = summary(portrait(speed_rpm=12000.0, load_n=250000.0))
    assert "12000 rpm (nominal)" in line
    assert "250000 N" in line


def test_frequencies_follow_from_orders_and_speed_and_are_left_out_where_unknown() -> None:
    assert portrait().frequencies == pytest.approx(
        {"BPFO": 90.0, "BPFI": 135.0, "BSF": 60.0, "FTF": 10.0, "shaft": 25.0}
    )
    assert portrait(bpfo=math.nan, ftf=math.nan).frequencies.keys() == {"BPFI", "BSF", "shaft"}
    assert portrait(**UNKNOWN).frequencies == {}


def test_the_lines_shown_are_those_of_the_stated_place_or_of_both_races() -> None:
    assert portrait().expected_lines == ("BPFO",)
    assert portrait(location="inner").expected_lines == ("BPFI",)
    assert portrait(location="ball").expected_lines == ("BSF",)
    assert portrait(location="none").expected_lines == ("BPFO", "BPFI")
    assert portrait(bpfo=math.nan).expected_lines == ()


def test_y_is_drawn_where_it_was_recorded_and_else_the_only_axis() -> None:
    along_y = portrait().main_axis
    of_both = replace(portrait(("x", "y")), acceleration=np.stack([np.zeros(along_y.size), along_y], axis=1))
    assert np.array_equal(of_both.main_axis, along_y)
    assert np.array_equal(portrait(("x",)).main_axis, along_y)


def test_frequencies_at_a_changing_speed_are_those_of_the_turns_that_the_shaft_made() -> None:
    time = np.arange(8000) / RATE
    speeding = replace(portrait(), shaft_angle=2.0 * math.pi * (20.0 * time + 10.0 * time**2))  # 30 turns in a second
    assert speeding.frequencies["shaft"] == pytest.approx(30.0, rel=1e-3)
    assert speeding.frequencies["BPFO"] == pytest.approx(108.0, rel=1e-3)


def test_the_close_up_is_three_revolutions_about_the_largest_amplitude() -> None:
    start, stop = portrait().window
    assert stop - start == pytest.approx(3.0 / 25.0)
    assert start < 0.7 < stop
    assert portrait(speed_rpm=20.0).window == pytest.approx((0.0, 1.0))


def test_the_close_up_at_an_unknown_speed_is_a_tenth_of_a_second_about_the_largest_amplitude() -> None:
    start, stop = portrait(**UNKNOWN).window
    assert stop - start == pytest.approx(0.1)
    assert start < 0.7 < stop


def test_the_largest_amplitude_is_that_about_the_mean_of_a_sensor_that_shows_a_constant() -> None:
    made = portrait()
    start, stop = replace(made, acceleration=10.0 - np.abs(made.acceleration)).window
    assert start < 0.7 < stop


def test_every_panel_is_drawn_whatever_is_unknown() -> None:
    for drawn in (portrait(), portrait(("x",), **UNKNOWN), portrait(("x", "y"), bpfo=math.nan, location="inner")):
        assert measured_sheet_png(drawn).startswith(b"\x89PNG")
    with house_style():
        figure = draw_measured_sheet(portrait())
        titles = [axes.get_title(loc="left") for axes in figure.axes]
        marks = {line.get_label(): line for line in figure.axes[4].lines}
        places = marks["BPFO 90 Hz"].get_xdata()
    assert titles[0].startswith("Acceleration, y axis")
    assert titles[4] == "Squared envelope spectrum"
    # One line of the spectrum is 1 Hz wide.
    assert np.asarray(places) == pytest.approx(90.0 * np.arange(1, 7), abs=1.0)


@pytest.mark.parametrize(
    ("changes", "end"),
    [
        ({}, 6.6 * 90.0),
        ({"envelope_band": (2000.0, 2420.0)}, 420.0),  # no envelope varies faster than its band is wide
        ({"envelope_band": (2000.0, 2050.0)}, 1.2 * 90.0),  # the line looked for stays in sight
        (UNKNOWN | {"envelope_band": (2000.0, 2300.0)}, 300.0),
        ({"location": "none"}, 6.6 * 135.0),  # six lines of the faster race
        ({"bpfo": math.nan}, 30.0 * 25.0),  # thirty turns, where no line is known
        (UNKNOWN | {"envelope_band": (2000.0, 3000.0)}, 500.0),
    ],
)
def test_the_axis_of_the_envelope_spectrum_ends_where_its_content_does(changes: dict[str, Any], end: float) -> None:
    with house_style():
        figure = draw_measured_sheet(portrait(**changes))
    assert figure.axes[4].get_xlim() == pytest.approx((0.0, end))


def test_heading_and_summary_say_what_is_known_and_no_more() -> None:
    assert heading(portrait()) == "mine, record 4: 105 DE, line defect on the outer race"
    assert heading(portrait(**UNKNOWN)) == "mine, record 4: 105 DE, state unknown"
    message = summary(portrait())
    assert "1500 rpm (nominal)" in message
    assert "load unknown" in message
    assert "0.5 mm" in message
    assert "speed unknown" in summary(portrait(**UNKNOWN))
    without_name = portrait(rig="unknown", bearing="unknown", balls=9.0)
    assert summary(without_name).startswith("measured, 9 balls in a row  ·  1500 rpm")


@pytest.mark.parametrize(
    ("location", "words"),
    [
        ("outer", "defect on the outer race"),
        ("inner", "defect on the inner race"),
        ("ball", "defect on a ball"),
        ("cage", "defect of the cage"),
        ("several", "defects in several places"),
    ],
)
def test_the_heading_names_the_place_of_the_defect(location: str, words: str) -> None:
    assert heading(portrait(location=location)).endswith(f", line {words}")
    assert heading(portrait(location=location, condition="unknown")).endswith(f", {words}")


def test_dollar_signs_in_names_are_drawn_and_are_no_mathematics() -> None:
    named = {name: f"{name} $\\frac$ 3" for name in ("recording", "rig", "bearing")}
    assert measured_sheet_png(portrait(**named)).startswith(b"\x89PNG")


def speeding() -> MeasuredPortrait:
    """Bursts on a carrier of 2500 Hz, 3.6 a turn of a shaft that goes from 15 to 35 turns a second within a second."""
    time = np.arange(8000) / RATE
    turns = 15.0 * time + 10.0 * time**2
    starts = np.interp(np.arange(1, 90) / 3.6, turns, time)
    since = time - starts[np.maximum(np.searchsorted(starts, time, side="right") - 1, 0)]
    signal = np.where(time >= starts[0], np.exp(-800.0 * since) * np.sin(2.0 * np.pi * 2500.0 * since), 0.0)
    return MeasuredPortrait("mine", LABELS, RATE, ("y",), signal[:, None], shaft_angle=2.0 * np.pi * turns)


def test_at_a_changing_speed_the_envelope_is_drawn_over_the_angle_of_the_shaft() -> None:
    drawn = speeding()
    assert drawn.frequencies["shaft"] == pytest.approx(25.0, rel=1e-3)
    assert "1500 rpm (nominal, changing)" in summary(drawn)
    frequency, amplitude = drawn.envelope_spectrum(400.0)
    near = (frequency > 60.0) & (frequency < 120.0)
    assert frequency[near][amplitude[near].argmax()] == pytest.approx(90.0, abs=1.0)
    # A line, with its window, of about half the mean square; over time it is smeared over 54 to 126 Hz.
    assert np.partition(amplitude[near], -4)[-4] < 0.2 * amplitude[near].max()
    over_time = replace(drawn, shaft_angle=None).envelope_spectrum(400.0)[1][54:127]
    assert over_time.max() < 0.5 * amplitude[near].max()
    with house_style():
        figure = draw_measured_sheet(drawn)
        panel = figure.axes[4]
        FigureCanvasAgg(figure).draw()
        legend = panel.get_legend()
        title = next(text for text in panel.findobj(Text) if text.get_text() == "Squared envelope, by angle")
    assert legend is not None
    assert title.get_window_extent().x1 < legend.get_window_extent().x0


def test_the_lines_marked_are_the_harmonics_of_the_stated_place_and_of_the_shaft() -> None:
    with house_style():
        figure = draw_measured_sheet(portrait())
    axes = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Squared"))
    lines = {str(line.get_label()).split()[0]: np.asarray(line.get_xdata()) for line in axes.lines}
    # A second, so lines 1 Hz apart: bursts at 90 Hz, and three turns of 25 Hz.
    assert lines["BPFO"] == pytest.approx([90.0 * k for k in range(1, 7)], abs=1.5)
    assert lines["shaft"] == pytest.approx([25.0 * k for k in range(1, 4)], abs=1.5)


def test_the_close_up_and_its_spectrogram_are_in_milliseconds() -> None:
    made = portrait()
    with house_style():
        figure = draw_measured_sheet(made)
    close_up = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Close-up"))
    (line,) = close_up.lines
    best = int(np.argmax(np.abs(np.asarray(line.get_ydata()))))
    assert np.asarray(line.get_xdata())[best] == pytest.approx(700.1, abs=0.1)  # a quarter of a turn of 2500 Hz behind
    assert close_up.get_xlabel() == "time (ms)"
    mesh = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Spectrogram")).collections[0]
    assert isinstance(mesh, QuadMesh)
    loudest = int(np.argmax(np.asarray(mesh.get_array()).max(axis=0)))
    assert mesh.get_coordinates()[0, loudest, 0] == pytest.approx(701.0, abs=8.0)  # half a window
    mark = figure.axes[0].patches[0]
    assert isinstance(mark, Rectangle)
    assert (mark.get_x(), mark.get_x() + mark.get_width()) == pytest.approx(made.window)  # of the whole record, in s


def test_lines_of_balls_and_cages_are_their_own() -> None:
    assert portrait(location="cage").expected_lines == ("FTF",)
