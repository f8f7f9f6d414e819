"""What is drawn where: each panel's lines, bars and colours are those of the quantities its labels name."""

import math
from dataclasses import fields, replace

import numpy as np
import pytest
from matplotlib.colors import to_rgba

from datagen.drawing.decibel_panel import NUMBER_HEIGHT, draw_decibels, mark_frequencies
from datagen.drawing.frequency_panels import draw_envelope_spectrum, draw_spectrum
from datagen.drawing.path_panels import draw_element_load, draw_path, load_over_spall
from datagen.drawing.sheet import draw_sheet
from datagen.drawing.style import BLUE, GREEN, GREY, ORANGE, PALE, VERMILLION, house_style, with_panels
from datagen.drawing.time_panels import (
    draw_close_up,
    draw_part,
    draw_passes,
    draw_spectrogram,
    draw_stiffness,
    draw_trace,
)
from labels.truth import PassTable

MS = 1e3


def panel_of(draw, portrait):
    """The panel that `draw` fills for a portrait."""
    with house_style():
        _, axes = with_panels(figsize=(6.0, 3.0))
        draw(axes, portrait)
    return axes


def lines_by_name(axes):
    return {line.get_label(): line for line in axes.lines}


def test_the_record_and_its_close_up_are_those_of_the_y_axis_in_seconds_and_in_milliseconds(portrait):
    drawn = portrait("line, outer")
    part = drawn.window.part(drawn.time)
    for draw, shown, scale in ((draw_trace, slice(None), 1.0), (draw_close_up, part, MS)):
        lines = lines_by_name(panel_of(draw, drawn))
        for name, colour, signal in (("with background", GREY, drawn.acceleration), ("clean", BLUE, drawn.clean)):
            assert np.array_equal(lines[name].get_ydata(), signal[shown, 1])
            assert lines[name].get_xdata() == pytest.approx(np.arange(signal.shape[0])[shown] * scale / drawn.rate)
            assert lines[name].get_color() == colour


def test_releases_and_regains_have_the_colours_of_their_names(portrait):
    drawn = portrait("line, outer")
    lines = panel_of(draw_close_up, drawn).lines
    names = {line.get_color(): line.get_label() for line in reversed(lines)}
    assert (names[VERMILLION], names[GREEN]) == ("release of a ball", "regain of contact")
    for colour, times in ((VERMILLION, drawn.passes.release_time), (GREEN, drawn.passes.regain_time)):
        marks = [line.get_xdata()[0] for line in lines if line.get_color() == colour]
        inside = times[(times >= drawn.window[0]) & (times <= drawn.window[1])]
        assert marks == pytest.approx(MS * inside, rel=1e-12)


def test_a_bar_runs_from_entry_to_exit_of_each_pass_and_tells_whether_its_ball_is_loaded(portrait):
    drawn = portrait("line, outer")
    start, stop = drawn.window
    shown = np.flatnonzero((drawn.passes.exit_time > start) & (drawn.passes.entry_time < stop))
    loaded = drawn.passes.loaded.copy()
    loaded[shown[shown != drawn.shown_pass][0]] = False  # another than the one that the close-up is about
    table = replace(drawn.passes, loaded=loaded)
    axes = panel_of(draw_passes, replace(drawn, passes=table))
    assert shown.size == len(axes.patches) > 2
    for k, bar, mark in zip(shown, axes.patches, axes.lines, strict=True):
        assert bar.get_x() == pytest.approx(MS * table.entry_time[k])
        assert bar.get_width() == pytest.approx(MS * (table.exit_time[k] - table.entry_time[k]))
        assert bar.get_facecolor() == pytest.approx(to_rgba(ORANGE if loaded[k] else PALE))
        assert mark.get_xdata()[0] == pytest.approx(MS * table.deepest_time[k])
    words = [text.get_text().strip() for text in axes.texts]
    assert len(words) > 1
    assert words == [f"ball {ball} of row 1" for ball in table.ball[shown]][: len(words)]


def test_passes_that_an_end_of_the_close_up_cuts_are_drawn_too(portrait):
    drawn = portrait("line, outer")
    table = PassTable(**{field.name: getattr(drawn.passes, field.name)[:6] for field in fields(PassTable)})
    drawn = replace(drawn, passes=replace(table, complete=np.zeros(6, bool)))  # the close-up is then in the middle
    start, span = drawn.window[0], drawn.window[1] - drawn.window[0]
    entry, leave = np.array([[-0.5, -0.3, -0.2, 0.4, 0.9, 1.2], [-0.1, 1.4, 0.1, 0.5, 1.3, 1.5]]) * span + start
    axes = panel_of(draw_passes, replace(drawn, passes=replace(drawn.passes, entry_time=entry, exit_time=leave)))
    assert [bar.get_x() for bar in axes.patches] == pytest.approx(MS * entry[1:5])


def test_the_stiffness_along_the_load_is_on_the_left_and_that_across_it_on_the_right(portrait):
    drawn = portrait("line, outer")
    axes = panel_of(draw_stiffness, replace(drawn, stiffness=np.array([[1e6], [2e6], [3e6]]) * np.ones(2001)))
    left, right = axes.figure.axes
    assert (left.get_ylabel(), right.get_ylabel()) == ("kyy (MN/m)", "kxx (MN/m)")
    assert (left.lines[0].get_ydata()[0], right.lines[0].get_ydata()[0]) == pytest.approx((2.0, 1.0))


def test_the_stiffness_is_that_of_the_instants_of_the_close_up(portrait):
    drawn = portrait("line, outer")
    rising = 1e6 * drawn.stiffness_time * np.ones((3, 1))  # as many MN/m as seconds
    for axes in panel_of(draw_stiffness, replace(drawn, stiffness=rising)).figure.axes:
        (line,) = axes.lines
        assert MS * line.get_ydata() == pytest.approx(line.get_xdata(), rel=1e-9)
        assert line.get_xdata()[[0, -1]] == pytest.approx(MS * np.array(drawn.window))


@pytest.fixture
def tones(portrait):
    """A portrait whose clean y axis holds 3 kHz and, ten times weaker, 6 kHz; its x axis holds 1 kHz."""
    drawn = portrait("line, outer")
    turned = 2.0 * math.pi * drawn.time
    along = np.sin(3000.0 * turned) + 0.1 * np.sin(6000.0 * turned)
    return replace(drawn, clean=np.column_stack([np.sin(1000.0 * turned), along]))


def test_the_spectrogram_is_that_of_the_y_axis_and_a_tenth_of_an_amplitude_is_twenty_decibels(tones):
    mesh = panel_of(draw_spectrogram, tones).collections[0]
    level, kilohertz = np.asarray(mesh.get_array()), mesh.get_coordinates()[:-1, 0, 1]
    middle = level[:, level.shape[1] // 2]
    near = {line: middle[np.abs(kilohertz - line) < 0.3].max() for line in (1.0, 3.0, 6.0)}
    assert near[3.0] == pytest.approx(0.0, abs=0.2)
    assert near[6.0] == pytest.approx(-20.0, abs=0.3)  # a window between two bins of its own
    assert near[1.0] < -50.0  # beside the line of 3 kHz


def test_the_spectrogram_is_over_the_milliseconds_of_the_close_up(tones):
    start, stop = tones.window
    burst = np.exp(-(((tones.time - 0.5 * (start + stop)) / 1e-3) ** 2))[:, None]
    mesh = panel_of(draw_spectrogram, replace(tones, clean=tones.clean * burst)).collections[0]
    place = np.argmax(np.asarray(mesh.get_array()).max(axis=0))
    edges = mesh.get_coordinates()[0, :, 0]
    assert edges[place] - 1.0 < MS * 0.5 * (start + stop) < edges[place + 1] + 1.0


def test_the_modes_are_marked_in_kilohertz_with_their_numbers(portrait):
    axes = panel_of(draw_spectrogram, portrait("healthy"))
    assert [line.get_ydata()[0] for line in axes.lines] == pytest.approx([0.1993, 2.2493, 10.548], rel=3e-4)
    assert [text.get_text() for text in axes.texts] == ["0.20", "2.25", "10.55"]


def test_the_close_up_is_marked_in_the_whole_record(portrait):
    drawn = portrait("line, outer")
    for draw in (draw_trace, lambda axes, of: draw_part(axes, of, of.acceleration, BLUE, "part")):
        (mark,) = panel_of(draw, drawn).patches
        assert (mark.get_x(), mark.get_x() + mark.get_width()) == pytest.approx(drawn.window)


def test_a_tone_stands_at_its_frequency_and_amplitude_and_the_band_at_its_edges(tones):
    with house_style():
        _, axes = with_panels(figsize=(6.0, 3.0))
        draw_spectrum(axes, 2.0 * tones.clean[:, 1], tones.rate, (5000.0, 7000.0))
    line, band = axes.lines[0], axes.patches[0]
    best = np.argmax(line.get_ydata())
    assert (line.get_xdata()[best], line.get_ydata()[best]) == pytest.approx((3.0, 2.0), rel=1e-6)  # on a bin
    assert (band.get_x(), band.get_x() + band.get_width()) == pytest.approx((5.0, 7.0))
    assert axes.get_xlim() == (0.0, 16.384)  # half of the rate of 32 768 Hz
    assert axes.texts[0].get_text() == "envelope band\n5.00 to 7.00 kHz"


def test_flanks_of_the_defect_s_lines_are_not_marked_as_sidebands(portrait):
    drawn = portrait("line, outer")
    samples = 4 * round(drawn.rate)
    burst = np.exp(-(((np.arange(samples) / drawn.rate - 2.0) / 1e-3) ** 2))  # whose square has a spectrum that falls
    long = replace(drawn, acceleration=np.zeros((samples, 2)), envelope=burst)
    lines = lines_by_name(panel_of(draw_envelope_spectrum, long))
    assert any(name.startswith("BPFO 34.28 Hz") for name in lines)
    assert not any(name.startswith(("±", "shaft")) for name in lines)


def test_the_spectrum_of_a_sheet_and_that_of_its_background_are_of_the_y_axis(tones):
    along, none = tones.clean[:, 1], np.zeros(tones.time.size)
    sheet = {
        "acceleration": np.column_stack([none, along]), "sensor": np.column_stack([none, along]),
        "background": np.column_stack([none, 0.5 * along]),
    }  # fmt: skip
    with house_style():
        figure = draw_sheet(replace(tones, **sheet))
    axes = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Amplitude"))
    assert [line.get_ydata().max() for line in axes.lines] == pytest.approx([1.0, 0.5], rel=1e-6)


def test_the_shafts_frequency_is_the_first_order_on_top_of_the_envelope_spectrum(portrait):
    drawn = portrait("line, outer")
    with house_style():
        figure = draw_sheet(drawn)
        figure.draw_without_rendering()
    axes = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Squared"))
    (orders,) = axes.child_axes
    assert np.array(orders.get_xlim()) == pytest.approx(np.array(axes.get_xlim()) / 7.0)  # the shaft turns at 420 rpm


def test_the_path_is_as_deep_as_the_spall_in_micrometres_between_its_edges(portrait):
    axes = panel_of(draw_path, portrait("line, outer"))
    path = axes.lines[0]
    middle = np.argmin(np.abs(path.get_xdata()))
    assert path.get_ydata()[middle] == pytest.approx(12.0, rel=1e-3)
    edges = sorted(line.get_xdata()[0] for line in axes.lines if len(line.get_xdata()) == 2)
    assert edges == pytest.approx([-1.0, 1.0])  # half of 2 degrees to each side
    names = {text.get_text().strip(): text.xy[0] for text in axes.texts}
    assert names == pytest.approx({"entry": -1.0, "exit": 1.0})
    outside = np.abs(path.get_xdata()) > 1.001
    assert outside.any()
    assert not path.get_ydata()[outside].any()


def test_the_title_of_the_path_tells_its_length_and_how_deep_the_ball_drops(portrait):
    drawn = portrait("line, outer")
    spall, ball, race = drawn.scene.spalls[0], 3.56, 0.5 * (38.75 + 7.12)  # radii, mm
    gap = replace(spall, entry_taper=0.0, exit_taper=0.0, depth=3e-4, profile="ball_path")
    half = math.radians(1.0) * race
    hanging = 1e3 * half**2 / 2.0 * (1.0 / ball - 1.0 / race)  # µm, on both edges
    for one, drop, end in ((spall, 12.0, " µm"), (gap, hanging, " µm, bridged")):
        axes = panel_of(draw_path, replace(drawn, scene=replace(drawn.scene, spalls=(one,))))
        length, told = axes.get_title(loc="left").removesuffix(end).split(" mm, drop ")
        assert length.endswith("spall of 2° = 0.801")
        assert float(told) == pytest.approx(drop, rel=0.02)  # of a parabola for a circle


def test_the_path_runs_downwards_and_its_deepest_place_is_the_middle_of_the_floor(portrait):
    drawn = portrait("line, outer")
    lopsided = replace(drawn.scene.spalls[0], entry_taper=math.radians(0.9), exit_taper=math.radians(0.1))
    axes = panel_of(draw_path, replace(drawn, scene=replace(drawn.scene, spalls=(lopsided,))))
    (mark,) = (line for line in axes.lines if line.get_marker() == "v")
    assert mark.get_xydata() == pytest.approx(np.array([[0.4, 12.0]]))  # from -0.1 to 0.9 degrees
    assert axes.get_ylim()[0] > 12.0 > 0.0 > axes.get_ylim()[1]


def test_the_ball_whose_load_is_drawn_is_the_one_that_is_at_the_spall(portrait):
    drawn = portrait("line, outer")
    k, spall, scene = drawn.shown_pass, drawn.shown_spall, drawn.scene
    middle = 0.5 * (drawn.passes.entry_time[k] + drawn.passes.exit_time[k])
    places = 0.2 + scene.cage.mean_speed * middle + 2.0 * math.pi / 12.0 * np.arange(12)  # of twelve balls of row 1
    ball = 1 + int(np.argmin(np.abs(np.exp(1j * places) - np.exp(1j * spall.angle))))
    title = panel_of(draw_element_load, drawn).get_title(loc="left")
    assert title == f"Quasi-static load of ball {ball} of row 1 on its way over the spall"


def test_rollers_are_called_so_and_a_row_is_told_where_there_are_two(portrait):
    drawn = portrait("line, outer")
    rig = drawn.scene.rig
    rollers = replace(rig.bearing, rows=1, exponent=10.0 / 9.0)
    single = replace(drawn, scene=replace(drawn.scene, rig=replace(rig, bearing=rollers)))
    assert all(text.get_text().startswith("  roller ") for text in panel_of(draw_passes, single).texts)
    assert "release of a roller" in lines_by_name(panel_of(draw_close_up, single))
    assert panel_of(draw_path, single).get_title(loc="left").startswith("Path of a roller's centre: ")
    assert single.element_of(0) == f"roller {drawn.passes.ball[0]}"
    assert drawn.element_of(0) == f"ball {drawn.passes.ball[0]} of row 1"


@pytest.mark.parametrize(
    ("band", "side", "place"), [((100.0, 16_000.0), "left", 12.288), ((14e3, 15e3), "right", 14.0)]
)
def test_the_words_of_the_band_lie_in_the_panel(band, side, place):
    axes = with_panels(figsize=(6.0, 3.0))[1]
    draw_spectrum(axes, np.random.default_rng(1).standard_normal(2000), 32_768.0, band)
    (words,) = axes.texts
    assert (words.get_ha(), words.xy[0]) == (side, pytest.approx(place))


def test_decibels_are_below_the_largest_power_of_all_frequencies_those_not_drawn_included():
    axes = with_panels(figsize=(6.0, 3.0))[1]
    power = np.array([[1.0, 2.0], [0.5, 4.0], [1000.0, 100.0]])
    frequency = np.array([100.0, 200.0, 300.0])
    draw_decibels(axes, np.array([0.1, 0.2]), frequency, power, span=70.0, top=250.0)
    (map_,) = axes.collections
    # A thousandth lies 30 dB below, and a factor of 2 is 3.0103 dB.
    expected = [-30.0, -26.9897, -33.0103, -23.9794]
    assert np.asarray(map_.get_array()).ravel() == pytest.approx(expected, abs=1e-4)
    assert map_.get_clim() == (-70.0, 0.0)


def test_numbers_of_close_modes_stand_one_above_the_other():
    axes = with_panels(figsize=(6.0, 3.0))[1]
    axes.set_ylim(0.0, 2.0)
    mark_frequencies(axes, [1010.0, 1000.0, 1500.0])
    assert [line.get_ydata()[0] for line in axes.lines] == pytest.approx([1.0, 1.01, 1.5])
    places = {text.get_text(): text.xy[1] for text in axes.texts}
    assert places == pytest.approx({"1.00": 1.0, "1.01": 1.0 + 2.0 * NUMBER_HEIGHT, "1.50": 1.5})


def test_the_waves_of_each_race_are_drawn_with_their_phase(portrait):
    drawn = portrait("healthy but wavy")
    waves = drawn.scene.imperfections.waviness
    turned = tuple(replace(wave, phase=phase) for wave, phase in zip(waves, (0.4, 1.1), strict=True))
    scene = replace(drawn.scene, imperfections=replace(drawn.scene.imperfections, waviness=turned))
    lines = lines_by_name(panel_of(draw_path, replace(drawn, scene=scene)))
    for name, height, order, phase in (("outer race", 1.0, 9, 0.4), ("inner race at t = 0", 2.0, 5, 1.1)):
        place = np.radians(lines[name].get_xdata() + 270.0)  # the load pulls downwards
        assert lines[name].get_ydata() == pytest.approx(height * np.cos(order * place + phase), abs=1e-9)


@pytest.mark.parametrize("name", ["line, outer", "line, inner, deep gap", "extended, outer"])
def test_a_ball_enters_a_spall_at_the_edge_that_its_pass_says(name, portrait):
    drawn = portrait(name)
    k, spall = drawn.shown_pass, drawn.shown_spall
    arc, _ = load_over_spall(drawn, spall, k)
    table = drawn.passes
    margin = 0.35 * (table.exit_time[k] - table.entry_time[k])
    time = np.linspace(
        max(table.entry_time[k] - margin, 0.0), min(table.exit_time[k] + margin, drawn.duration), arc.size
    )
    passed = np.interp([table.entry_time[k], table.exit_time[k]], time, arc)
    assert passed == pytest.approx([-0.5 * spall.extent, 0.5 * spall.extent], rel=1e-3)
