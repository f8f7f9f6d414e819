"""What several figures share: cursors at families of lines, a legend below the panels, numbers in words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from datagen.drawing.style import INK
from physics.arrays import Array

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def power_decibel(power: Array | float) -> Array:
    """10 log10 of powers or densities, dB; zero becomes −400."""
    return 10.0 * np.log10(np.maximum(power, 1e-40))


def highest_near(frequency: Array, level: Array, targets: Sequence[float], reach: float) -> tuple[Array, Array]:
    """Frequencies and levels of the highest component within ± `reach` (Hz) of each target, (N,) each."""
    best = []
    for target in targets:
        near = np.flatnonzero(np.abs(frequency - target) <= reach + 1e-9)
        best.append(near[int(np.argmax(level[near]))])
    return frequency[best], level[best]


def cursor(
    axes: Axes, frequency: Array, level: Array, targets: Sequence[float], reach: float, style: tuple[str, str, str]
) -> None:
    """Small open markers on the spectrum near the targets (Hz); `style` is marker, colour and name."""
    marker, colour, name = style
    where, height = highest_near(frequency, level, targets, reach)
    axes.plot(
        where,
        height,
        marker,
        color=colour,
        label=name,
        linestyle="",
        markersize=4.5,
        markerfacecolor="none",
        markeredgewidth=1.0,
        clip_on=True,
        zorder=4,
    )


def letter(axes: Axes, name: str, title: str) -> None:
    """The panel's letter and title above its left end."""
    axes.set_title(f"({name})  {title}")


def legend_below(figure: Figure, sources: Sequence[Axes], columns: int = 6) -> None:
    """One legend for the figure at its lower edge, each name once."""
    found: dict[str, Artist] = {}
    for axes in sources:
        for handle, name in zip(*axes.get_legend_handles_labels(), strict=True):
            found.setdefault(name, handle)
    figure.legend(
        list(found.values()),
        list(found),
        loc="lower center",
        ncols=columns,
        bbox_to_anchor=(0.5, 0.0),
        handlelength=1.6,
        columnspacing=1.6,
    )


def heading(figure: Figure, title: str, subtitle: str) -> None:
    """Title and one quiet line below it, at the upper left of a figure, a fixed way from its top."""
    height = figure.get_figheight()
    figure.text(0.012, 1.0 - 0.10 / height, title, fontsize=11.5, fontweight="bold", color=INK, va="top")
    figure.text(0.012, 1.0 - 0.36 / height, subtitle, fontsize=8.5, color="#666666", va="top")


def spread(values: Array) -> str:
    """ "median of N; lowest to highest" for a table's comment."""
    return f"median of {values.size}; {np.min(values):.1f} to {np.max(values):.1f}"
