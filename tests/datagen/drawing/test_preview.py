import math
import struct
from dataclasses import replace

import numpy as np
import pytest
from command_line import run

from datagen.drawing.frequency_panels import cursors, draw_envelope_spectrum, line_heights
from datagen.drawing.path_panels import load_around, load_over_spall
from datagen.drawing.portrait_sources import corpus_portrait, recipe_portrait
from datagen.drawing.preview import draw_preview, preview_png
from datagen.drawing.sheet import DPI, HEIGHT, WIDTH, care, draw_sheet, heading, sheet_png, summary
from datagen.drawing.style import house_style, with_panels
from datagen.drawing.time_panels import draw_close_up, draw_passes, draw_spectrogram, free_lanes, vertical_modes
from datagen.errors import BadInput
from datagen.files.plain import plain_json
from datagen.recipes.recipe import load_recipe
from datagen.runs.generate import generate
from datagen.runs.workers import Engine
from labels.truth import ball_passes
from physics.outcome import Outcome, SimulationFailed

KINDS = ("healthy", "line, outer", "extended, outer", "line, inner, deep gap", "healthy but wavy")

RECIPE = """
name = "small"
seed = 4
[signal]
rate_hz = 32768
duration_s = 0.25
[store]
clean = true
[[part]]
name = "line"
records = 2
[part.machine]
rig = "gearbox"
[part.defect]
condition = "line"
extent_deg = 2.0
depth_um = 12.0
[part.background]
white_rms_m_s2 = 0.02
"""


@pytest.fixture
def recipe_file(tmp_path):
    path = tmp_path / "recipe.toml"
    path.write_text(RECIPE)
    return path


def png_size(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])


@pytest.mark.parametrize(
    "clean", [True, pytest.param(False, marks=pytest.mark.slow)], ids=["with clean signal", "without"]
)
@pytest.mark.parametrize("name", KINDS)
def test_a_record_of_every_kind_becomes_a_png_of_the_stated_size(name, clean, portrait):
    assert png_size(sheet_png(portrait(name, clean))) == (WIDTH * DPI, HEIGHT * DPI)


def test_every_panel_has_a_title_and_every_scale_a_unit(portrait):
    with house_style():
        figure = draw_sheet(portrait("line, outer"))
        titles = [axes.get_title(loc="left") for axes in figure.axes if axes.get_title(loc="left")]
        words = " ".join(axes.get_xlabel() + " " + axes.get_ylabel() for axes in figure.axes)
    for topic in (
        "Acceleration",
        "Close-up",
        "stiffness",
        "Spectrogram",
        "Path of a ball",
        "load",
        "Amplitude",
        "Squared",
    ):
        assert any(topic in title for title in titles), topic
    for unit in (
        "m/s²",
        "time (s)",
        "time (ms)",
        "frequency (kHz)",
        "kyy (MN/m)",
        "kxx (MN/m)",
        " kHz",
        "(µm)",
        "(N)",
        "(°)",
        "(Hz",
    ):
        assert unit in words, unit


def test_the_close_up_marks_release_and_regain_of_every_pass_in_it(portrait):
    drawn = portrait("line, outer")
    with house_style():
        figure = draw_sheet(drawn)
        close_up = next(axes for axes in figure.axes if axes.get_title(loc="left") == "Close-up")
        marks = sorted(line.get_xdata()[0] for line in close_up.lines if len(set(line.get_xdata())) == 1)
    start, stop = drawn.window
    events = np.concatenate([drawn.passes.release_time, drawn.passes.regain_time])
    assert np.allclose(marks, 1e3 * np.sort(events[(events >= start) & (events <= stop)]))
    assert len(marks) == 6


@pytest.mark.parametrize("name", KINDS)
def test_the_close_up_holds_three_passes_and_lies_inside_the_record(name, portrait):
    drawn = portrait(name)
    start, stop = drawn.window
    assert 0.0 <= start < stop <= drawn.duration
    assert (stop - start) * drawn.frequencies[drawn.defect_frequency] == pytest.approx(3.0)
    if drawn.shown_pass is not None:
        assert drawn.passes.complete[drawn.shown_pass]
        assert start <= drawn.passes.entry_time[drawn.shown_pass] <= stop


def test_the_pass_shown_is_the_loudest_of_the_loaded_ones_but_for_those_at_the_beginning(portrait):
    drawn = portrait("line, outer")
    table = drawn.passes
    middle = 0.5 * (table.entry_time + table.exit_time)
    settled = np.flatnonzero(table.complete & (table.entry_time > 0.15 * drawn.duration))
    (early, *_), (loudest, *_, quieter) = np.flatnonzero(table.complete & (table.entry_time < 0.15 * 0.25)), settled
    clean = np.zeros((drawn.time.size, 2))
    for k, height in ((early, 9.0), (loudest, -8.0), (quieter, 7.0)):
        clean[round(middle[k] * drawn.rate), 1] = height
    assert table.loaded.all()
    assert replace(drawn, clean=clean).shown_pass == loudest
    unloaded = replace(table, loaded=np.arange(middle.size) != loudest)
    assert replace(drawn, clean=clean, passes=unloaded).shown_pass == quieter


def test_a_record_shorter_than_the_close_up_is_shown_whole(portrait):
    drawn = portrait("line, outer")
    samples = round(0.05 * drawn.rate)
    passes = ball_passes(drawn.scene, None, 0.05)
    short = replace(drawn, acceleration=drawn.acceleration[:samples], clean=None, passes=passes)
    assert short.window == (0.0, samples / drawn.rate)


def test_modes_along_y_of_the_healthy_gearbox_rig_are_the_check_values(portrait):
    # 199.3, 2249.3 and 10548 Hz at cage angle 0; elsewhere the healthy kyy differs by 0.01 %, so they move by less.
    assert vertical_modes(portrait("healthy")) == pytest.approx([199.3, 2249.3, 10548.0], rel=3e-4)


def test_cursors_follow_the_defective_race(portrait):
    outer = {name.split()[0]: targets for name, _, _, targets in cursors(portrait("line, outer"))}
    assert outer["BPFO"] == pytest.approx([34.283 * k for k in range(1, 7)], rel=2e-5)  # last printed digit
    drawn = portrait("line, inner, deep gap")
    families = cursors(replace(drawn, acceleration=np.zeros((round(drawn.rate), 2))))  # a second, 13 turns of the shaft
    assert families[0][0].startswith("BPFI")
    # Fan rig: the two ball-pass frequencies, 76.74 Hz for the outer race, add up to 14 turns of the shaft at 800 rpm.
    assert families[0][3][0] == pytest.approx(14.0 * 800.0 / 60.0 - 76.74, abs=0.005)  # last printed digit
    assert "shaft 13.3 Hz" in families[1][0]
    sidebands = [k * families[0][3][0] + side * 800.0 / 60.0 for k in (1, 2, 3) for side in (-1.0, 1.0)]
    assert families[1][3] == pytest.approx(sidebands)


@pytest.mark.parametrize(
    ("seconds", "marked"), [(0.25, ["BPFO"]), (1.0, ["BPFO", "shaft"]), (1.5, ["BPFO", "±", "shaft"])]
)
def test_lines_that_a_short_record_cannot_resolve_are_not_marked(seconds, marked, portrait):
    # A second of the gearbox rig holds 7 turns of the shaft and 2.86 of the cage; lines are told apart at 4 bins.
    drawn = portrait("line, outer")
    lasting = replace(drawn, acceleration=np.zeros((round(seconds * drawn.rate), 2)))
    assert [name.split()[0] for name, *_ in cursors(lasting)] == marked


@pytest.mark.parametrize(
    ("width", "end", "beyond"),
    [(400.0, 6.6 * 34.283, False), (150.0, 150.0, False), (20.0, 1.2 * 34.283, True)],
)
def test_the_envelope_spectrum_ends_where_its_content_does(width, end, beyond, portrait):
    drawn = portrait("line, outer")
    drawn = replace(drawn, labels=drawn.labels | {"envelope_band": (6000.0, 6000.0 + width)})
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw_envelope_spectrum(axes, drawn)
    assert axes.get_xlim() == pytest.approx((0.0, end), rel=2e-5)  # last printed digit of 34.283
    assert ("(beyond the band's width)" in cursors(drawn)[0][0]) == beyond


def test_the_lines_of_the_record_s_own_family_are_marked_though_nothing_stands_out(portrait):
    drawn = portrait("line, outer")
    lone_burst = np.exp(-0.25 * ((drawn.time - 0.125) / 0.8e-3) ** 2)  # whose square has a spectrum that only falls
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw_envelope_spectrum(axes, replace(drawn, envelope=lone_burst))
    marks = axes.lines[1]
    assert marks.get_label().startswith("BPFO")
    assert marks.get_xdata().size == 6
    assert np.all(np.diff(marks.get_ydata()) < 0.0)


def test_the_flank_of_a_line_is_not_marked_as_its_sideband():
    frequency, flank = np.arange(60.0), 10.0 ** (-np.abs(np.arange(60.0) - 30.0))
    sidebands = [27.0, 33.0]
    assert line_heights(frequency, flank, sidebands, 3.0, peaks=True) == []
    assert [line[0] for line in line_heights(frequency, flank, sidebands, 3.0)] == [28.0, 32.0]
    standing = flank + 0.1 * (frequency == 33.0)
    assert [line[0] for line in line_heights(frequency, standing, sidebands, 3.0, peaks=True)] == [33.0]


@pytest.mark.parametrize(("spacing", "reach"), [(100.0, 12), (30.0, 10)])
def test_a_line_is_looked_for_up_to_a_hundredth_off_and_up_to_a_third_of_the_way_to_the_next(spacing, reach):
    """The near one of two lines is found, though the higher one lies just beyond: 1.2 % of 1000 Hz, or 10 Hz."""
    frequency = np.arange(2000.0)
    for side in (-1, 1):
        amplitude = 1.0 * (frequency == 1000 + side * reach) + 2.0 * (frequency == 1000 + side * (reach + 1))
        assert line_heights(frequency, amplitude, [1000.0], spacing) == [(1000.0 + side * reach, 1.0)]


def test_the_sheet_says_where_its_modes_are_taken(portrait):
    with house_style():
        _, axes = with_panels(figsize=(4.0, 3.0))
        draw_spectrogram(axes, portrait("line, outer"))
        said, highest = axes.get_xlabel(), axes.get_ylim()[1]
    assert highest == pytest.approx(1.3 * 10.548, rel=1e-3)  # kHz: the resonator has room above
    assert said.endswith("dashed: modes along y at the middle of the close-up")


@pytest.mark.parametrize(
    ("background", "clean", "whose"),
    [
        (0.0, False, "as recorded"),
        (0.1, False, "with background"),
        (None, False, "with background"),
        (0.0, True, "clean"),
    ],
)
def test_panels_speak_of_a_background_only_where_there_may_be_one(background, clean, whose, portrait):
    known = None if background is None else np.full((8192, 2), background)
    drawn = portrait("line, outer", clean, noise=0.0, background=known)
    with house_style():
        _, (above, below) = with_panels(2, figsize=(4.0, 3.0))
        draw_spectrogram(above, drawn)
        draw_close_up(below, drawn)
        title, names = above.get_title(loc="left"), below.get_legend_handles_labels()[1]
    assert title.startswith(f"Spectrogram, {whose}, ")
    assert names[0] == whose


def test_the_load_of_a_ball_on_a_full_turn_peaks_at_stribecks_value_below_the_shaft(portrait):
    arc, load = load_around(portrait("healthy").scene)
    assert abs(arc[np.argmax(load)]) < math.radians(0.5)  # a flat top on a grid of 0.3°
    assert load.max() == pytest.approx(62.995, abs=0.05)  # check value at cage angle 0, which the grid holds
    assert np.all(load[np.abs(arc) > math.pi / 2.0] == 0.0)


@pytest.mark.parametrize("name", ["line, outer", "line, inner, deep gap", "extended, outer"])
def test_the_load_over_the_spall_falls_between_its_edges_only(name, portrait):
    drawn = portrait(name)
    spall, k = drawn.scene.spalls[0], drawn.shown_pass
    arc, load = load_over_spall(drawn, spall, k)
    half = spall.extent / 2.0
    assert np.all(np.diff(arc) > 0.0)
    assert np.all(load[np.abs(arc) < 0.1 * half] < 0.4 * load[arc < -half][-1])
    assert arc[0] < -half < half < arc[-1]


def test_overlapping_passes_lie_in_different_lanes():
    entry = np.array([0.0, 1.0, 2.0, 3.5, 3.6])
    leave = np.array([2.5, 3.0, 4.0, 5.0, 6.0])
    assert free_lanes(entry, leave) == [0, 1, 2, 0, 1]


def test_a_pass_that_begins_where_another_ends_follows_in_its_lane():
    assert free_lanes(np.array([0.0, 1.0, 2.0]), np.array([1.0, 2.0, 3.0])) == [0, 0, 0]


def test_names_of_balls_do_not_run_under_the_bars_of_the_other_row(recipe_file):
    recipe_file.write_text(RECIPE.replace('condition = "line"', 'condition = "line"\nrow = "both"'))
    drawn = recipe_portrait(recipe_file, 0)
    with house_style():
        figure, axes = with_panels(figsize=(WIDTH / 2.0, 1.0), gridspec_kw={"left": 0.1, "right": 0.93})
        axes.set_xlim(*(1e3 * edge for edge in drawn.window))
        draw_passes(axes, drawn)
        figure.canvas.draw()
        names = [text.get_window_extent().translated(0.5, 0.0) for text in axes.texts]
        bars = [bar.get_window_extent() for bar in axes.patches]
    assert len(names) >= 4
    assert not any(name.overlaps(bar) for name in names for bar in bars)


def test_the_heading_says_what_is_drawn(portrait):
    drawn = portrait("line, outer")
    assert heading(drawn) == "made by hand, record 5: line spall, outer race"
    assert heading(portrait("healthy")).endswith("healthy")
    for part in ("gearbox rig", "koyo_1205", "420 rpm", "346 N", "SNR 12.0 dB", "0.02 %"):
        assert part in summary(drawn)


@pytest.mark.parametrize(("layers", "reason"), [("white", "no signal"), ("", "no background")])
def test_the_summary_says_why_there_is_no_ratio_of_signal_to_noise(portrait, layers, reason):
    drawn = portrait("healthy")
    silent = replace(drawn, labels={**drawn.labels, "snr_db": math.nan, "background_layers": layers})
    assert reason in summary(silent)


def test_a_sheet_says_why_its_record_is_to_be_read_with_care(portrait):
    drawn = portrait("healthy")
    warned = replace(drawn, labels={**drawn.labels, "validity": "0.43 of the samples are cut off; " + "more " * 60})
    texts = [text.get_text() for text in draw_sheet(warned).texts]
    assert [text for text in texts if "0.43 of the samples are cut off" in text] == [care(warned)]
    assert len(care(warned)) < 230
    assert care(warned).endswith("(the label validity has all)")
    assert not care(replace(drawn, labels={**drawn.labels, "validity": ""}))


def test_a_preview_says_so_where_it_has_to_compile_first(recipe_file, tmp_path, monkeypatch):
    monkeypatch.setattr("physics.warming.is_warm", lambda: False)
    monkeypatch.setattr("physics.warming.warm_up", lambda: None)
    said = []
    draw_preview(recipe_file, 1, tmp_path / "recipe.png", said.append)
    assert said == ["compiling the physics; this is done once for each version of it"]


def test_a_recipe_and_the_corpus_made_from_it_give_the_same_preview(recipe_file, tmp_path):
    folder = tmp_path / "corpus"
    generate(load_recipe(recipe_file), folder)
    drawn = draw_preview(recipe_file, 1, tmp_path / "recipe.png")
    read = draw_preview(folder, 1, tmp_path / "corpus.png")
    assert plain_json(drawn) == plain_json(read)
    assert drawn["frequencies_hz"]["BPFO"] == pytest.approx(34.283, abs=5e-4)  # last printed digit
    assert drawn["passes"] == pytest.approx(0.25 * 34.283, abs=1.5)  # a pass may be cut at each end
    assert drawn["released"] >= drawn["passes"] - 2
    for name in ("recipe.png", "corpus.png"):
        assert png_size((tmp_path / name).read_bytes()) == (WIDTH * DPI, HEIGHT * DPI)


def test_the_facts_of_a_preview_are_those_of_the_pass_that_it_shows(portrait, monkeypatch):
    drawn = portrait("line, outer")
    held = np.where(np.arange(len(drawn.passes)) == 0, np.nan, drawn.passes.release_time)
    table = replace(drawn.passes, release_time=held)  # of all but the first pass
    monkeypatch.setattr("datagen.drawing.portrait_sources.recipe_portrait", lambda *_: replace(drawn, passes=table))
    monkeypatch.setattr("datagen.drawing.sheet.sheet_png", lambda _: b"")
    _, facts = preview_png("made by hand", 5)
    assert (facts["passes"], facts["released"]) == (len(table), len(table) - 1)
    assert facts["shown_pass"]["entry_time"] == table.entry_time[drawn.shown_pass] > table.entry_time[0]


@pytest.fixture
def with_parts(portrait):
    """A portrait whose background and mounted sensor are known."""
    drawn = portrait("line, outer")
    sensor = 0.5 * drawn.clean
    background = drawn.acceleration - drawn.clean
    return replace(drawn, acceleration=sensor + background, sensor=sensor, background=background)


def test_clean_signal_background_and_their_sum_are_drawn_one_below_the_other(with_parts):
    drawn = with_parts
    with house_style():
        figure = draw_sheet(drawn)
        strips = {axes.get_title(loc="left").split()[0]: axes for axes in figure.axes[:3]}
        spectra = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Amplitude"))
    assert list(strips) == ["Clean", "Background", "Sum,"]
    for name, signal in (("Clean", drawn.sensor), ("Background", drawn.background), ("Sum,", drawn.acceleration)):
        assert np.array_equal(strips[name].lines[0].get_ydata(), signal[:, 1])
        assert f"RMS {np.sqrt(np.mean(signal[:, 1] ** 2)):.3g} m/s²" in strips[name].get_title(loc="left")
    assert "background" in [line.get_label() for line in spectra.lines]


def test_a_record_without_background_has_no_strips(portrait, with_parts):
    drawn = replace(with_parts, background=np.zeros_like(with_parts.background))
    assert not drawn.has_parts
    assert not portrait("line, outer").has_parts


SENSORS = """
[chain]
modes = [{frequency_hz = 3000, damping = 0.02}]
[background]
pink.rms_m_s2 = 0.1
mains_hum.amplitude_m_s2 = 0.05
"""


@pytest.mark.parametrize("stored", ["", "sensor = true\nbackground = true", "sensor = true"])
def test_the_parts_of_a_stored_record_are_those_of_its_recipe(stored, tmp_path):
    text = RECIPE.replace("[[part]]", SENSORS + "[[part]]").replace("clean = true", f"clean = true\n{stored}")
    (tmp_path / "recipe.toml").write_text(text.replace("[part.background]\nwhite_rms_m_s2 = 0.02\n", ""))
    made = recipe_portrait(tmp_path / "recipe.toml", 1)
    generate(load_recipe(tmp_path / "recipe.toml"), tmp_path / "corpus", engine=Engine(workers=1))
    read = corpus_portrait(tmp_path / "corpus", 1)
    assert np.allclose(read.background, made.background, atol=1e-6)  # layers rounded to float32
    assert made.has_parts
    assert read.has_parts
    assert np.allclose(read.sensor, made.sensor, atol=1e-5)
    assert np.allclose(made.sensor + made.background, made.acceleration, atol=1e-5)  # float32 of each


@pytest.mark.parametrize(
    ("source", "record", "out", "message"),
    [
        ("recipe.toml", 2, "a.png", "record = 2.*0 to 1"),
        ("recipe.toml", 0, "a.jpg", r"--out.*\.png"),
        ("recipe.toml", 0, "nowhere/a.png", "no such folder"),
        ("missing.toml", 0, "a.png", "missing.toml"),
    ],
)
def test_what_cannot_be_drawn_is_refused_and_nothing_is_written(recipe_file, tmp_path, source, record, out, message):
    with pytest.raises(BadInput, match=message):
        draw_preview(tmp_path / source, record, tmp_path / out)
    assert [path.name for path in tmp_path.iterdir()] == ["recipe.toml"]


def test_the_first_record_that_a_corpus_has_is_drawn_if_none_is_named(recipe_file, tmp_path):
    generate(load_recipe(recipe_file), tmp_path / "corpus", records=[1], engine=Engine(workers=1))
    for source, record in (tmp_path / "corpus", 1), (recipe_file, 0):
        done = run("preview", source, "--out", tmp_path / "a.png")
        assert done.exit_code == 0
        assert done.stdout.startswith(f"record {record} of {source} is drawn in ")


def test_a_record_that_cannot_be_simulated_ends_with_1_and_leaves_no_picture(recipe_file, tmp_path, monkeypatch):
    def fails(scenario, stored):
        raise SimulationFailed(Outcome.NOT_FINITE, "the response grows without end")

    monkeypatch.setattr("datagen.drawing.portrait_sources.make_record", fails)
    picture = tmp_path / "x.png"
    done = run("preview", recipe_file, "--record", "1", "--out", picture)
    assert done.exit_code == 1
    assert done.stderr.startswith("record 1 could not be made: the response grows without end; ")
    assert done.stderr.count("\n") == 1
    assert not picture.exists()
