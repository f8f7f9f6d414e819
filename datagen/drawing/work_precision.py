"""The work-precision diagram: error of the acceleration against times real time, both logarithmic.

Errors beyond WORST_SHOWN or BEST_SHOWN are drawn on that edge of the panel, in a ring that the legend explains.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from datagen.charts.contestants import METHOD, MODEL
from datagen.charts.measure import TARGET, Chart, Run, errors_and_speeds
from datagen.drawing.style import BLUE, GREEN, GREY, INK, ORANGE, PALE, PURPLE, SKY, VERMILLION, png_of
from physics.integrators.method_table import MODAL
from physics.integrators.rivals.general_purpose import BALL_BY_BALL

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WIDTH, HEIGHT, DPI = 9.4, 7.2, 150
METHOD_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, INK, GREY)
MODEL_MARKERS = ("*", "P", "X", "D")
RIVAL_COLOURS = {"RK45": ORANGE, "DOP853": VERMILLION, "LSODA": GREEN, "Radau": PURPLE, "RK4": INK}
# On the contact kernel and ball by ball.
RIVAL_STYLES = {"compiled": ("-", "-"), "numbalsoda": ("-.", "-."), "SciPy": ("--", ":")}
WORST_SHOWN, BEST_SHOWN = 8.0, 1e-8
RINGED = "ringed: error beyond the panel"
EDGE_ROW = 0.03  # of the height of the panel of errors


def work_precision_png(chart: Chart) -> bytes:
    """The diagram of one scene as the bytes of a PNG file."""
    return png_of(lambda: draw_work_precision(chart), DPI)


def draw_work_precision(chart: Chart) -> Figure:
    """The figure of one scene: on top how fast the fixed steps could go at most, below error against speed."""
    figure = Figure(figsize=(WIDTH, HEIGHT))
    strip, axes = figure.subplots(
        2,
        1,
        sharex=True,
        height_ratios=(max(EDGE_ROW * (len(chart.edges) + 1), 1e-3), 1.0),
        gridspec_kw={"left": 0.085, "right": 0.7, "top": 0.9, "bottom": 0.085, "hspace": 0.02},
    )
    names = list(dict.fromkeys(run.name for run in chart.runs))
    methods = list(dict.fromkeys(_method(name) for name in names if _group(chart, name) == METHOD))
    models = [name for name in names if _group(chart, name) == MODEL]
    for name in names:
        _draw(axes, chart, name, methods, models)
    _ring_beyond(axes, chart, names)
    axes.axhline(TARGET, color=GREY, linewidth=0.6, linestyle=(0, (4, 3)))
    axes.axvline(1.0, color=GREY, linewidth=0.6, linestyle=(0, (4, 3)))
    axes.set(xscale="log", yscale="log", ylim=(_bottom(chart), WORST_SHOWN))
    axes.set_xlabel("times real time on one core (more is faster)")
    axes.set_ylabel("RMS error of the acceleration over its RMS, from 0.1 s")
    axes.grid(True, color=PALE, linewidth=0.5)
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), fontsize=8.5, handlelength=2.2, borderaxespad=0.0)
    _draw_edges(strip, chart, methods)
    figure.text(0.085, 0.957, f"Speed against accuracy: {chart.title}", fontsize=11, fontweight="bold", color=INK)
    figure.text(0.085, 0.925, _facts(chart), fontsize=8, color=GREY)
    return figure


def _bottom(chart: Chart) -> float:
    """The decade below the smallest error, or BEST_SHOWN."""
    names = dict.fromkeys(run.name for run in chart.runs)
    errors = [_on_panel(error) for name in names for _, error in _points(chart.runs, name)]
    return max(BEST_SHOWN, 10.0 ** math.floor(math.log10(min(errors, default=TARGET))))


def _group(chart: Chart, name: str) -> str:
    return next(run.group for run in chart.runs if run.name == name)


def _method(name: str) -> str:
    """The method alone, of which a comma may part what else is done."""
    return name.split(",")[0]


def _points(runs: Sequence[Run], name: str) -> list[tuple[float, float]]:
    """Times real time and error of each run of a name that has an error."""
    return [(speed, error) for error, speed in errors_and_speeds(runs, name)]


def _on_panel(error: float) -> float:
    return min(max(error, BEST_SHOWN), WORST_SHOWN)


def _ring_beyond(axes: Axes, chart: Chart, names: Sequence[str]) -> None:
    """A ring, clear of the curve's own marker, around every point that stands on an edge in place of its error."""
    points = [point for name in names for point in _points(chart.runs, name)]
    beyond = [(speed, _on_panel(error)) for speed, error in points if error != _on_panel(error)]
    if beyond:
        axes.plot(
            *zip(*beyond, strict=True), "o", color=INK, markerfacecolor="none", markersize=10, markeredgewidth=0.8,
            zorder=5, clip_on=False, label=RINGED,
        )  # fmt: skip


def _draw(axes: Axes, chart: Chart, name: str, methods: list[str], models: list[str]) -> None:
    points = _points(chart.runs, name)
    if not points:
        axes.plot([], [], " ", label=f"{name}: gave up")
        return
    speed, error = zip(*((speed, _on_panel(error)) for speed, error in points), strict=True)
    if _group(chart, name) == METHOD:
        colour = _colour(name, methods)
        style, face = ("o-", colour) if _method(name) == name else ("o--", "white")
        axes.plot(
            speed,
            error,
            style,
            color=colour,
            markerfacecolor=face,
            markersize=4.5,
            linewidth=1.6,
            zorder=4,
            label=f"{name} (default)" if name == MODAL else name,
        )
    elif _group(chart, name) == MODEL:
        marker = MODEL_MARKERS[models.index(name) % len(MODEL_MARKERS)]
        axes.plot(speed, error, marker, markersize=8, color=INK, alpha=0.75, zorder=3, label=f"model: {name}")
    else:
        solver = name.split(",")[0].split()[-1]
        style = RIVAL_STYLES[name.split()[0]][BALL_BY_BALL in name]
        marker = "s" if BALL_BY_BALL in name else "^"
        axes.plot(
            speed, error, marker=marker, linestyle=style, color=RIVAL_COLOURS[solver], markersize=3.5, linewidth=0.9,
            alpha=0.9, label=name,
        )  # fmt: skip


def _colour(name: str, methods: list[str]) -> str:
    return METHOD_COLOURS[methods.index(_method(name)) % len(METHOD_COLOURS)]


def _draw_edges(strip: Axes, chart: Chart, methods: list[str]) -> None:
    """A bar for each method that steps fixedly, a row each, where it would be at its longest stable step."""
    strip.set_axis_off()
    strip.set_ylim(len(chart.edges) - 0.2, -1.2)
    low, high = strip.get_xlim()
    for row, (name, speed) in enumerate(chart.edges.items()):
        colour = _colour(name, methods)
        strip.plot([speed], [row], "|", color=colour, markersize=8, markeredgewidth=2.2)
        right = speed > math.sqrt(low * high)
        strip.annotate(
            f"{name}: unstable beyond", (speed, row), fontsize=6.5, color=colour, xytext=(-6 if right else 6, 0),
            textcoords="offset points", va="center", ha="right" if right else "left",
        )  # fmt: skip


def _facts(chart: Chart) -> str:
    made = chart.made_with
    return (
        f"{chart.rate:g} Hz, {chart.duration:g} s, against {chart.reference}; "
        f"{made['processor']}, numba {made['numba']}, scipy {made['scipy']}"
    )
