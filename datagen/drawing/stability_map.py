"""Maps of where each method is accurate, wrong or refused: one row a method, one column a quantity, on two sheets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from datagen.charts.stability import BY_STEP, DURATION, NOT_CONVERGED, RATE, STEPS, VALUE, Map
from datagen.drawing.style import GREY, INK, png_of, with_panels

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Inches. Pages show a picture about as wide as this, so that letters keep their size there.
WIDTH, DPI, LETTERS = 9.4, 170, 11.5
LEFT, RIGHT, TOP, BOTTOM, PANEL, GAP = 0.72, 0.12, 1.78, 1.05, 1.16, 0.42
COLUMNS_A_SHEET = 4
BOUNDS = (1e-3, 1e-2, 1e-1)
COLOURS = ("#1b7f5c", "#8fcf9f", "#f2d45c", "#d55e00", "#3b3b3b", "#dddddd", "#ffffff")
NAMES = (
    "error up to 0.1 %",
    "up to 1 %",
    "up to 10 %",
    "above: wrong",
    "ended by an outcome",
    "no step converges",
    "refused: step too long",
)
ENDED, UNCONVERGED, REFUSED = 4, 5, 6
HATCH = "////"


def stability_sheets(maps: Sequence[Map]) -> list[bytes]:
    """The maps as PNG files, four quantities a sheet."""
    sweeps = list(dict.fromkeys(stability.sweep for stability in maps))
    groups = [sweeps[k : k + COLUMNS_A_SHEET] for k in range(0, len(sweeps), COLUMNS_A_SHEET)]

    def draw(number: int) -> Figure:
        of_sheet = [stability for stability in maps if stability.sweep in groups[number]]
        return draw_sheet(of_sheet, f"{number + 1} of {len(groups)}")

    settings = {"font.size": LETTERS, "hatch.linewidth": 0.6}
    return [png_of(partial(draw, number), DPI, settings) for number in range(len(groups))]


def draw_sheet(maps: Sequence[Map], number: str) -> Figure:
    """One sheet of maps, every method below each other; `number` says which it is."""
    methods = list(dict.fromkeys(stability.method for stability in maps))
    sweeps = list(dict.fromkeys(stability.sweep for stability in maps))
    height = TOP + len(methods) * (PANEL + GAP) - GAP + BOTTOM
    figure, grid = with_panels(len(methods), len(sweeps), figsize=(WIDTH, height), squeeze=False, sharex="col")
    figure.subplots_adjust(
        left=LEFT / WIDTH, right=1.0 - RIGHT / WIDTH, top=1.0 - TOP / height, bottom=BOTTOM / height, wspace=0.08,
        hspace=GAP / PANEL,
    )  # fmt: skip
    for stability in maps:
        row, column = methods.index(stability.method), sweeps.index(stability.sweep)
        _draw(grid[row, column], stability, first=column == 0, last=row == len(methods) - 1)
    for axes, sweep in zip(grid[0], sweeps, strict=True):
        axes.annotate(
            sweep, (0.5, 1.0), (0.0, 25.0), xycoords="axes fraction", textcoords="offset points", ha="center",
            fontsize=LETTERS, fontweight="bold", color=INK,
        )  # fmt: skip
    figure.align_xlabels(list(grid[-1]))
    _head(figure, height, number)
    return figure


def _head(figure: Figure, height: float, number: str) -> None:
    title = "Where each method is accurate, wrong or refused"
    figure.text(0.012, 1.0 - 0.1 / height, title, fontsize=14, fontweight="bold", color=INK, va="top")
    under = (
        f"gearbox rig with a line spall (G1), one quantity varied at a time, {DURATION:g} s at {RATE:g} Hz; {number}"
    )
    figure.text(0.012, 1.0 - 0.4 / height, under, va="top", fontsize=LETTERS, color="#666666")
    entries: list[Artist] = [
        Patch(facecolor=colour, edgecolor=GREY, linewidth=0.5, hatch=HATCH if kind == REFUSED else None)
        for kind, colour in enumerate(COLOURS)
    ]
    entries.append(Line2D([], [], color=INK, linewidth=1.6))
    figure.legend(
        entries, [*NAMES, "longest stable step"], loc="upper left", bbox_to_anchor=(0.004, 1.0 - 0.64 / height),
        ncols=4, fontsize=LETTERS, handlelength=1.3, columnspacing=1.1, handletextpad=0.5, borderaxespad=0.0,
        labelspacing=0.35,
    )  # fmt: skip


def kind(error: float, outcome: str, refused: bool) -> int:
    """Index into NAMES of a cell: refused before all else, without a value by its outcome, else by its error."""
    if outcome == NOT_CONVERGED:
        return UNCONVERGED
    if refused:
        return REFUSED
    return int(np.searchsorted(BOUNDS, error)) if outcome == VALUE else ENDED


def kinds(stability: Map) -> list[list[int]]:
    """`kind` of each cell (S, V), a row for each step or accuracy."""
    cells = [
        map(kind, *of_value) for of_value in zip(stability.error, stability.outcomes, stability.refused, strict=True)
    ]
    return [list(row) for row in zip(*cells, strict=True)]


def _draw(axes: Axes, stability: Map, first: bool, last: bool) -> None:
    cells = np.array(kinds(stability))
    axes.imshow(
        cells, cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=len(COLOURS) - 0.5, aspect="auto",
        interpolation="nearest", origin="upper",
    )  # fmt: skip
    for row, column in np.argwhere(cells == REFUSED):
        hatched = Rectangle((column - 0.5, row - 0.5), 1.0, 1.0, fill=False, hatch=HATCH, edgecolor=GREY, linewidth=0.0)
        axes.add_patch(hatched)
    limit = np.log2(STEPS[0]) - np.log2(np.clip(stability.limit, STEPS[-1] / 4.0, 4.0 * STEPS[0]))
    if np.isfinite(stability.limit).any():
        axes.plot(np.arange(len(stability.values)), limit, color=INK, linewidth=1.6)
    axes.set(ylim=(len(stability.rows) - 0.5, -0.5), xlim=(-0.5, len(stability.values) - 0.5))
    axes.set_xticks(range(len(stability.values)), [_short(value) for value in stability.values], rotation=90)
    shown = range(0, len(stability.rows), 2)
    axes.set_yticks(
        shown, [_row_label(stability.scale, stability.rows[k]) for k in shown] if first else [""] * len(shown)
    )
    axes.tick_params(length=2, color=GREY, labelsize=LETTERS)
    axes.tick_params(axis="x", bottom=last, labelbottom=last)
    if first:
        axes.set_title(f"{stability.method}: {stability.scale}", fontsize=LETTERS, fontweight="normal", pad=4)
    if last:
        axes.set_xlabel(stability.unit, fontsize=LETTERS)


def _short(value: float) -> str:
    """A number as short as it can be: powers of ten from 1000 on as such."""
    if abs(value) < 1e3:
        return f"{value:g}"
    exponent = math.floor(math.log10(value) + 1e-9)
    factor = value / 10.0**exponent
    return f"$10^{{{exponent}}}$" if factor == 1.0 else f"${factor:g}·10^{{{exponent}}}$"


def _row_label(scale: str, row: float) -> str:
    if scale == BY_STEP:
        return f"1/{round(1.0 / row)}" if row < 1.0 else f"{row:g}"
    return f"{row:g}" if row >= 1e-3 else f"$10^{{{math.log10(row):.0f}}}$"
