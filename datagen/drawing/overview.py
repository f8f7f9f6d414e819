"""The overview of a corpus: how many records of each kind in each split, and how the labels are distributed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas
from numpy.typing import NDArray

from datagen.counts import digits
from datagen.drawing.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    faint_grid,
    outside_legend,
    plain_log_ticks,
    png_of,
    spans_decades,
    whole_numbers,
    with_panels,
)
from labels.schema import LABEL, UNKNOWN

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANEL_WIDTH, ROW_HEIGHT, DPI = 11.0 / 3.0, 2.7, 120
ACROSS, MOST_DISTRIBUTIONS = 3, 5
COLOURS = {"none": SKY, "outer": BLUE, "inner": VERMILLION, "ball": GREEN, "cage": PURPLE, "several": ORANGE}
SPLIT_COLOURS = {"train": BLUE, "validation": ORANGE, "test": GREEN, UNKNOWN: GREY}
WORTH_SHOWING = ("speed_rpm", "load_n", "extent_mm", "snr_db", "depth", "mean_slip", "rate_hz", "error_estimate")
TITLES = {"snr_db": "SNR"}
SHOWN_IN = {"depth": (1e6, "µm")}
BINS, FEW = 24, 8
DIGITS, MOST_DECIMALS = 10, 12
MOST_STEPS = 5  # between ticks: numbers as long as −0.0025 have room


def overview_png(labels: pandas.DataFrame, name: str) -> bytes:
    """The overview of a table of labels as the bytes of a PNG file."""
    return png_of(lambda: draw_overview(labels, name), DPI)


def draw_overview(labels: pandas.DataFrame, name: str) -> Figure:
    """The figure of a table of labels: records of each kind, then how the labels are distributed."""
    shown = [column for column in WORTH_SHOWING if _values(labels, column).size > 1][:MOST_DISTRIBUTIONS]
    rows, across = _grid(1 + len(shown))
    size = (PANEL_WIDTH * max(across, 2), ROW_HEIGHT * rows + 0.5)  # one panel alone is wide, for the name above it
    figure, grid = with_panels(rows, across, figsize=size, layout="constrained")
    panels = list(np.ravel(grid))
    draw_kinds(panels[0], labels)
    for panel, column in zip(panels[1:], shown, strict=False):
        draw_distribution(panel, labels, column)
    for panel in panels[1 + len(shown) :]:
        panel.set_axis_off()
    figure.suptitle(f"{name}: {len(labels)} records", x=0.01, ha="left", fontsize=12, fontweight="bold", color=INK)
    return figure


def _grid(panels: int) -> tuple[int, int]:
    """Rows and columns for so many panels, with as few places left empty as can be."""
    across = 2 if panels == 4 else min(panels, ACROSS)
    return -(-panels // across), across


def _values(labels: pandas.DataFrame, column: str) -> NDArray[np.float64]:
    """The distinct known values of a label that apply to more than healthy records alone, but for rounding."""
    return np.unique(_but_for_rounding(labels.loc[_applies(labels, column), column].dropna().to_numpy(np.float64)))


def _but_for_rounding(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values (N,) with the first digits of the largest: ratios set to 0 dB come out as 0 and 1e-15."""
    largest = float(np.abs(values).max(initial=0.0))
    first = np.ceil(np.log10(largest)) if largest > 0.0 else 0.0
    return np.round(values, int(min(DIGITS - first, MOST_DECIMALS))) + 0.0  # no minus zero


def _applies(labels: pandas.DataFrame, column: str) -> pandas.Series:
    """Sizes of a spall are 0 by definition in healthy records, which says nothing of the spalls."""
    sized = column in ("extent_mm", "depth")
    return (labels["location"] != "none") if sized else (labels["record"] >= 0)


def draw_kinds(axes: Axes, labels: pandas.DataFrame) -> None:
    """Horizontal bars: records of each condition and location, divided by split."""
    counts = labels.groupby(["condition", "location", "split"]).size().unstack(fill_value=0)
    names = ["healthy" if location == "none" else f"{condition}, {location}" for condition, location in counts.index]
    left = np.zeros(len(counts))
    for split in (split for split in SPLIT_COLOURS if split in counts):
        axes.barh(names, counts[split], left=left, color=SPLIT_COLOURS[split], height=0.65, label=split)
        left += counts[split].to_numpy()
    for place, total in enumerate(left):
        axes.text(total, place, f" {total:.0f}", va="center", fontsize=8, color=INK)
    axes.set(xlabel="records", xlim=(0.0, 1.15 * left.max()))
    whole_numbers(axes.xaxis)
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.set_title("Kinds")
    outside_legend(axes)


def draw_distribution(axes: Axes, labels: pandas.DataFrame, column: str) -> None:
    """How often each value of a label occurs, in records, by defective part."""
    factor, unit = SHOWN_IN.get(column, (1.0, LABEL[column].unit))
    table = labels.loc[_applies(labels, column) & labels[column].notna()]
    known = pandas.Series(_but_for_rounding(table[column].to_numpy(np.float64)) * factor, table.index)
    distinct = _values(labels, column) * factor
    stacked = [
        (place, known[table["location"] == place].to_numpy())
        for place in (*COLOURS, UNKNOWN)
        if (table["location"] == place).any()
    ]
    colours = [COLOURS.get(place, GREY) for place, _ in stacked]
    names = [place for place, _ in stacked]
    if distinct.size <= FEW:
        _draw_bars(axes, stacked, distinct, colours)
    else:
        ends = (distinct.min(), distinct.max())
        logarithmic = spans_decades(*ends)
        edges = (np.geomspace if logarithmic else np.linspace)(*ends, BINS + 1).tolist()
        axes.hist([values for _, values in stacked], edges, stacked=True, color=colours, label=names)
        if logarithmic:
            axes.set_xscale("log")
            plain_log_ticks(axes.xaxis)
        else:
            axes.locator_params(axis="x", nbins=MOST_STEPS)
    axes.set(xlabel=unit if unit != "1" else "", ylabel="records")
    whole_numbers(axes.yaxis)
    axes.set_title(_title(column, unit))
    faint_grid(axes)
    if len(names) > 1:
        outside_legend(axes)


def _title(column: str, unit: str) -> str:
    """The name of a label without the unit, as a title is written."""
    words = column.replace("_", " ").removesuffix(f" {unit.lower()}")
    return TITLES.get(column, words[0].upper() + words[1:])


def _draw_bars(
    axes: Axes, stacked: list[tuple[str, NDArray[np.float64]]], distinct: NDArray[np.float64], colours: list[str]
) -> None:
    """Bars at equal distances for a few distinct values."""
    below = np.zeros(distinct.size)
    for (place, values), colour in zip(stacked, colours, strict=True):
        heights = np.array([(values == value).sum() for value in distinct])
        axes.bar(np.arange(distinct.size), heights, bottom=below, color=colour, width=0.65, label=place)
        below += heights
    axes.set_xticks(np.arange(distinct.size), _short(distinct))


def _short(distinct: NDArray[np.float64]) -> list[str]:
    """Texts of different numbers with as few digits as keep them apart; no power of ten for what is large."""
    texts: list[str] = []
    for count in range(3, 10):
        texts = [digits(value, count) for value in distinct]
        if len(set(texts)) == distinct.size:
            break
    return texts
