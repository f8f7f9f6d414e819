"""The overview of a corpus: counts in whole numbers, values in plain ones, and no places left empty."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pandas
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from datagen.drawing.overview import SPLIT_COLOURS, WORTH_SHOWING, draw_overview
from datagen.drawing.style import BLUE, SKY, VERMILLION, house_style


def table(**columns: Any) -> pandas.DataFrame:
    """Labels of 12 records, half of them healthy, of which nothing is known but the `columns` given."""
    unknown = dict.fromkeys(WORTH_SHOWING, np.nan)
    kinds = {"location": ["none", "outer"] * 6, "condition": ["healthy", "line"] * 6, "split": "train"}
    return pandas.DataFrame({"record": range(12)} | kinds | unknown | columns)


def drawn(labels: pandas.DataFrame) -> Figure:
    with house_style():
        figure = draw_overview(labels, "made")
        figure.draw_without_rendering()
    return figure


def panel(figure: Figure, title: str) -> Axes:
    return next(axes for axes in figure.axes if axes.get_title(loc="left") == title)


def words(axes: Axes) -> list[str]:
    return [label.get_text() for label in axes.get_xticklabels()]


@pytest.mark.parametrize(
    ("column", "title", "values", "ticks"),
    [
        ("speed_rpm", "Speed", [1477.0, 2954.0], ["1477", "2954"]),
        ("load_n", "Load", [0.0, 1477.2], ["0", "1477"]),
        ("rate_hz", "Rate", [12000.0, 48000.0], ["12000", "48000"]),
        ("snr_db", "SNR", [1.5, 20.0], ["1.5", "20"]),
        ("speed_rpm", "Speed", [1772.01, 1772.04], ["1772.01", "1772.04"]),
        ("snr_db", "SNR", [0.0, 9.6e-16, -4.4e-16, 20.0], ["0", "20"]),
        ("snr_db", "SNR", [5.0, np.nextafter(5.0, 6.0), 12.0], ["5", "12"]),
    ],
)
def test_a_few_values_are_named_in_plain_numbers(
    column: str, title: str, values: list[float], ticks: list[str]
) -> None:
    assert words(panel(drawn(table(**{column: (values * 6)[:12]})), title)) == ticks


def test_counts_have_ticks_at_whole_numbers_only() -> None:
    figure = drawn(table(speed_rpm=np.linspace(100.0, 1200.0, 12), load_n=[1.0, 2.0] * 6))
    counting = [panel(figure, "Kinds").xaxis, panel(figure, "Speed").yaxis, panel(figure, "Load").yaxis]
    for axis in counting:
        places = axis.get_majorticklocs()
        assert len(places) > 1
        assert np.array_equal(places, np.round(places))


def test_sizes_over_decades_are_named_in_plain_numbers() -> None:
    sizes = np.geomspace(0.2, 20.0, 12)
    labels = pandas.concat([table(extent_mm=sizes), table(extent_mm=sizes)], ignore_index=True)
    labels["record"], labels["location"] = range(24), "outer"
    assert {"0.5", "1", "10"} <= set(words(panel(drawn(labels), "Extent")))


@pytest.mark.parametrize(("known", "places"), [(0, 1), (1, 2), (2, 3), (3, 4), (4, 6), (5, 6)])
def test_a_sheet_has_no_more_places_than_fill_its_rows(known: int, places: int) -> None:
    figure = drawn(table(**{column: [1.0, 2.0, 3.0] * 4 for column in WORTH_SHOWING[:known]}))
    assert len(figure.axes) == places
    assert sum(axes.axison for axes in figure.axes) == known + 1


def test_a_ratio_set_alike_in_all_records_but_for_rounding_is_one_value() -> None:
    ratios = 5.0 + 1e-15 * np.arange(12)
    assert [axes.get_title(loc="left") for axes in drawn(table(snr_db=ratios)).axes] == ["Kinds"]


@pytest.mark.parametrize("ends", [(-0.0093, 0.01), (-0.008, 0.009), (-0.0085, 0.0085)])
def test_numbers_along_a_distribution_do_not_run_into_each_other(ends: tuple[float, float]) -> None:
    labels = table(**dict.fromkeys(("speed_rpm", "load_n", "snr_db", "rate_hz", "mean_slip"), np.linspace(*ends, 12)))
    with house_style():
        figure = draw_overview(labels, "made")
        figure.draw_without_rendering()
        boxes = [label.get_window_extent() for label in panel(figure, "Mean slip").get_xticklabels()]
    assert len(boxes) > 2
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


def bars(axes: Axes, colour: str) -> list[Any]:
    """The bars of a panel that have this colour and are not empty."""
    found = [bar for bar in axes.patches if bar.get_width() * bar.get_height() > 0.0]
    return [bar for bar in found if bar.get_facecolor()[:3] == pytest.approx(to_rgb(colour))]


def test_records_of_a_kind_lie_side_by_side_split_after_split() -> None:
    axes = panel(drawn(table(split=["train", "train", "test", "test", "validation", "train"] * 2)), "Kinds")
    ends = {
        split: sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars(axes, SPLIT_COLOURS[split]))
        for split in ("train", "validation", "test")
    }
    # Of either kind six: healthy in train, test and validation by two; of line spalls four in train and two in test.
    assert ends == {"train": [(0.0, 2.0), (0.0, 4.0)], "validation": [(2.0, 4.0)], "test": [(4.0, 6.0), (4.0, 6.0)]}
    assert [text.get_text().strip() for text in axes.texts] == ["6", "6"]


def test_few_values_are_bars_of_each_part_upon_each_other_in_its_colour() -> None:
    speeds = [100.0, 100.0, 100.0, 100.0, 200.0, 100.0] * 2
    axes = panel(drawn(table(speed_rpm=speeds)), "Speed")
    heights = {colour: [(bar.get_y(), bar.get_height()) for bar in bars(axes, colour)] for colour in (SKY, BLUE)}
    assert heights == {SKY: [(0.0, 4.0), (0.0, 2.0)], BLUE: [(4.0, 6.0)]}
    assert axes.get_legend_handles_labels()[1] == ["none", "outer"]


def test_inner_and_outer_races_keep_their_colours() -> None:
    labels = table(location=["inner", "outer"] * 6, condition="line", speed_rpm=[100.0, 200.0] * 6)
    axes = panel(drawn(labels), "Speed")
    assert [bar.get_x() + 0.5 * bar.get_width() for bar in bars(axes, BLUE)] == pytest.approx([1.0])
    assert [bar.get_x() + 0.5 * bar.get_width() for bar in bars(axes, VERMILLION)] == pytest.approx([0.0])


@pytest.mark.parametrize("count", [2, 12])
def test_depths_are_told_in_micrometres(count: int) -> None:
    depths = np.linspace(1e-6, 12e-6, count)
    labels = table(location="outer", condition="line", depth=np.resize(depths, 12))
    axes = panel(drawn(labels), "Depth")
    assert axes.get_xlabel() == "µm"
    if count == 2:
        assert words(axes) == ["1", "12"]
    assert sum(bar.get_height() for bar in bars(axes, BLUE)) == 12.0


def test_sizes_that_all_spalls_share_are_no_distribution_beside_the_zeros_of_healthy_records() -> None:
    labels = table(depth=[0.0, 12e-6] * 6, extent_mm=[0.0, 1.5] * 6, speed_rpm=[100.0, 200.0] * 6)
    assert [axes.get_title(loc="left") for axes in drawn(labels).axes] == ["Kinds", "Speed"]
