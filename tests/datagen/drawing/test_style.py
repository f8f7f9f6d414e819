"""One way from a figure to the bytes of a PNG file, which leaves nothing open."""

import matplotlib
import pytest

from datagen.drawing.style import SETTINGS, plt, png_of


def test_a_picture_is_drawn_in_the_house_style_and_closed():
    seen, before = [], plt.get_fignums()

    def draw():
        seen.append((matplotlib.rcParams["axes.edgecolor"], matplotlib.rcParams["font.size"]))
        return plt.figure()

    assert png_of(draw, 50, settings={"font.size": 11.0}).startswith(b"\x89PNG\r\n")
    assert seen == [(SETTINGS["axes.edgecolor"], 11.0)]
    assert plt.get_fignums() == before


def test_a_figure_is_closed_though_drawing_fails_and_others_stay_open():
    other = plt.figure()

    def draw():
        plt.figure()
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        png_of(draw, 50)
    assert plt.fignum_exists(other.number)
    assert plt.get_fignums()[-1] == other.number
    plt.close(other)


def test_a_picture_without_the_name_of_its_program_does_not_hold_it():
    assert b"Software" in png_of(plt.figure, 50)
    assert b"Software" not in png_of(plt.figure, 50, metadata={"Software": None})
