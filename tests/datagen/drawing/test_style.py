"""One way from a figure to the bytes of a PNG file, which leaves nothing open and no setting changed."""

import subprocess
import sys

import matplotlib
import pytest
from matplotlib.figure import Figure

from datagen.drawing.style import SETTINGS, house_style, plain_log_ticks, png_of, with_panels


def test_a_picture_is_drawn_in_the_house_style():
    seen = []

    def draw():
        seen.append((matplotlib.rcParams["axes.edgecolor"], matplotlib.rcParams["font.size"]))
        return Figure()

    before = dict(matplotlib.rcParams)
    assert png_of(draw, 50, settings={"font.size": 11.0}).startswith(b"\x89PNG\r\n")
    assert seen == [(SETTINGS["axes.edgecolor"], 11.0)]
    assert dict(matplotlib.rcParams) == before


def test_settings_are_as_before_though_drawing_fails():
    before = dict(matplotlib.rcParams)

    def draw():
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        png_of(draw, 50)
    assert dict(matplotlib.rcParams) == before


def test_drawing_loads_no_pyplot_and_so_changes_no_backend():
    code = (
        "import sys, datagen.drawing.preview, datagen.drawing.classifier_sheet, datagen.drawing.size_report\n"
        "from datagen.drawing.style import png_of, with_panels\n"
        "png_of(lambda: with_panels(figsize=(1.0, 1.0))[0], 50)\n"
        "sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_panels_are_laid_out_as_asked():
    figure, grid = with_panels(2, 3, figsize=(6.0, 4.0), layout="constrained", sharex=True)
    assert grid.shape == (2, 3)
    assert figure.get_size_inches().tolist() == [6.0, 4.0]
    assert figure.get_layout_engine() is not None


def test_a_picture_without_the_name_of_its_program_does_not_hold_it():
    assert b"Software" in png_of(Figure, 50)
    assert b"Software" not in png_of(Figure, 50, metadata={"Software": None})


@pytest.mark.parametrize(
    ("ends", "some"),
    [((0.28, 0.52), {"0.3", "0.4"}), ((0.9, 12.0), {"1", "2", "5", "10"}), ((1.0, 9000.0), {"1", "10", "1000"})],
)
def test_ticks_of_a_logarithmic_axis_are_plain_numbers_side_by_side(ends, some):
    with house_style():
        figure, axes = with_panels(figsize=(2.5, 2.0), layout="constrained")
        axes.loglog(ends, ends)
        plain_log_ticks(axes.xaxis)
        figure.draw_without_rendering()
        labels = [label for label in axes.get_xticklabels(which="both") if label.get_text()]
        boxes = [label.get_window_extent() for label in labels]
    assert some <= {label.get_text() for label in labels}
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])


def test_a_logarithmic_axis_of_very_small_numbers_keeps_its_powers_of_ten():
    with house_style():
        figure, axes = with_panels(figsize=(2.5, 2.0))
        axes.loglog([1e-7, 1e-4], [1.0, 2.0])
        plain_log_ticks(axes.xaxis)
        figure.draw_without_rendering()
        labels = [label.get_text() for label in axes.get_xticklabels() if label.get_text()]
    assert labels
    assert all("10^" in label for label in labels)
