"""Maps of where each method is accurate, wrong, unstable or refused: one row a method, one column a quantity."""

from __future__ import annotations

import io
import math

import numpy as np
from matplotlib.colors import ListedColormap

from datagen.charts.stability import BY_STEP, STEPS, Map
from datagen.drawing.style import GREY, INK, house_style, plt

WIDTH, DPI = 17.0, 85
BOUNDS = (1e-3, 1e-2, 1e-1)
COLOURS = ("#1b7f5c", "#8fcf9f", "#f2d45c", "#d55e00", "#3b3b3b", "#dddddd")
NAMES = ("error up to 0.1 %", "up to 1 %", "up to 10 %", "above: wrong", "typed outcome", "no step converges")


def stability_png(maps: list[Map]) -> bytes:
    """The maps on one sheet as the bytes of a PNG file."""
    methods = list(dict.fromkeys(one.method for one in maps))
    sweeps = list(dict.fromkeys(one.sweep for one in maps))
    picture = io.BytesIO()
    with house_style():
        figure, grid = plt.subplots(
            len(methods), len(sweeps), figsize=(WIDTH, 2.25 * len(methods) + 1.0), squeeze=False, sharex="col"
        )
        figure.subplots_adjust(left=0.06, right=0.995, top=0.91, bottom=0.085, wspace=0.08, hspace=0.12)
        for one in maps:
            row, column = methods.index(one.method), sweeps.index(one.sweep)
            _draw(grid[row, column], one, first=column == 0, top=row == 0, last=row == len(methods) - 1)
        for place, (name, colour) in enumerate(zip(NAMES, COLOURS, strict=True)):
            figure.text(0.06 + 0.12 * place, 0.955, "■", color=colour, fontsize=15, va="center")
            figure.text(0.073 + 0.12 * place, 0.957, name, fontsize=9, va="center", color=INK)
        figure.text(0.06 + 0.12 * 6, 0.957, "—  longest stable step of the linearised scene", fontsize=9, va="center")
        figure.savefig(picture, dpi=DPI, format="png")
        plt.close(figure)
    return picture.getvalue()


def kind(error: float) -> int:
    """Index into NAMES of an error: by its size, 4 where there is no answer, 5 where nothing converges."""
    if math.isnan(error):
        return 5
    return 4 if math.isinf(error) else int(np.searchsorted(BOUNDS, error))


def _draw(axes: plt.Axes, one: Map, first: bool, top: bool, last: bool) -> None:
    cells = np.array([[kind(error) for error in row] for row in one.error]).T
    axes.imshow(
        cells, cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=5.5, aspect="auto", interpolation="nearest", origin="upper"
    )
    limit = np.log2(STEPS[0]) - np.log2(np.clip(one.limit, STEPS[-1] / 4.0, 4.0 * STEPS[0]))
    if np.isfinite(one.limit).any():
        axes.plot(np.arange(len(one.values)), limit, color=INK, linewidth=1.6)
        axes.plot(np.arange(len(one.values)), limit, color="white", linewidth=0.7)
    axes.set_ylim(len(one.rows) - 0.5, -0.5)
    axes.set_xticks(range(len(one.values)), [f"{value:g}" for value in one.values], rotation=45)
    axes.set_yticks(range(len(one.rows)), [_told(one.scale, row) for row in one.rows] if first else [])
    axes.tick_params(length=2, color=GREY)
    if first:
        axes.set_ylabel(f"{one.method}\n{one.scale}")
    if top:
        axes.set_title(one.sweep, fontsize=9.5)
    if last:
        axes.set_xlabel(one.unit)


def _told(scale: str, row: float) -> str:
    return f"1/{round(1.0 / row)}" if scale == BY_STEP and row < 1.0 else f"{row:g}"
