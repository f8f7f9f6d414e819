"""One look for every figure: colours that colour-blind readers tell apart, one font, quiet axes."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

# Okabe and Ito's palette.
BLUE, VERMILLION, GREEN, ORANGE, SKY, PURPLE = "#0072B2", "#D55E00", "#009E73", "#E69F00", "#56B4E9", "#CC79A7"
INK, GREY, PALE = "#222222", "#8a8a8a", "#d9d9d9"
HEALTHY, LINE, EXTENDED = GREEN, BLUE, VERMILLION
MAP = "magma"
# Ends of a logarithmic axis that is given plain numbers, and its highest over its lowest value, below which ticks stand
# at equal distances, and below which also at 2 and 5 of each decade.
PLAIN = (1e-3, 99999.0)
LINEAR_BELOW, FINE_BELOW = 8.0, 300.0
# Largest over smallest value of a quantity above which it is drawn over a logarithmic axis.
LOGARITHMIC_FROM = 20.0

SETTINGS: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 8.5,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 0.9,
    "mathtext.default": "regular",
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "agg.path.chunksize": 20000,
}


@contextmanager
def house_style() -> Iterator[None]:
    """Everything drawn inside has the one look."""
    with rc_context(SETTINGS):
        yield


def png_of(
    draw: Callable[[], Figure],
    dpi: float,
    settings: Mapping[str, object] | None = None,
    metadata: Mapping[str, str | None] | None = None,
) -> bytes:
    """The figure that `draw` makes in the house style, as the bytes of a PNG file with `dpi` dots an inch.

    `settings` of matplotlib overrule those of the house style; `metadata` are texts of the file, None leaves one out.
    Figures are made without pyplot, so that neither its backend nor its list of open figures is touched.
    """
    picture = io.BytesIO()
    with house_style(), rc_context(dict[Any, Any](settings or {})):
        draw().savefig(picture, dpi=dpi, format="png", metadata=metadata)
    return picture.getvalue()


def with_panels(rows: int = 1, columns: int = 1, *, figsize: tuple[float, float], **options: Any) -> tuple[Figure, Any]:
    """A figure of `figsize` (inches) with a grid of panels, and these as `Figure.subplots` gives them for `options`;
    the option `layout` is the figure's."""
    figure = Figure(figsize=figsize, layout=options.pop("layout", None))
    return figure, figure.subplots(rows, columns, **options)


def roomy() -> ConstrainedLayoutEngine:
    """A layout of many panels in which neither titles touch the edge nor labels the panel beside."""
    return ConstrainedLayoutEngine(h_pad=0.09, w_pad=0.09)


def faint_grid(axes: Axes) -> None:
    """Pale horizontal lines across the panel, at its ticks."""
    axes.grid(True, axis="y", color=PALE, linewidth=0.5)


def same_height(panels: Sequence[Axes]) -> None:
    """Give panels side by side the limits of all along y, whichever way up these are."""
    ends = np.array([axes.get_ylim() for axes in panels])
    downwards = ends[0, 0] > ends[0, 1]
    low, high = ends.min(), ends.max()
    for axes in panels:
        axes.set_ylim((high, low) if downwards else (low, high))


def whole_numbers(axis: Axis) -> None:
    """Ticks of a linear axis that counts something: whole numbers only."""
    axis.set_major_locator(MaxNLocator("auto", integer=True, min_n_ticks=1, steps=[1, 2, 5, 10]))


def spans_decades(smallest: float, largest: float) -> bool:
    """True for a range that a linear axis would show most of in a corner."""
    return smallest > 0.0 and largest / smallest > LOGARITHMIC_FROM


def plain_log_ticks(axis: Axis) -> None:
    """Few ticks of a logarithmic axis, as plain numbers; those of a range that would need many zeros are left alone.

    Called when the limits of the axis stand: matplotlib names every tick of a range below a decade, one upon the other.
    """
    low, high = sorted(axis.get_view_interval())
    if low < PLAIN[0] or high > PLAIN[1]:
        return
    if high / low < LINEAR_BELOW:
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    else:
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if high / low < FINE_BELOW else (1.0,)))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))


def outside_legend(axes: Axes, lift: float = 0.0) -> None:
    """The legend on the line of the title, at the right end, where it hides no data; `lift` in heights of the panel."""
    axes.legend(
        loc="lower right",
        bbox_to_anchor=(1.0, 1.0 + lift),
        ncols=6,
        borderaxespad=0.15,
        handlelength=1.2,
        columnspacing=1.0,
        handletextpad=0.4,
    )
