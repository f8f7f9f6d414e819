"""The work-precision diagram: error of the acceleration against times real time, both logarithmic."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence

from datagen.charts.contestants import METHOD, MODEL
from datagen.charts.measure import TARGET, Chart, Run
from datagen.drawing.style import BLUE, GREEN, GREY, INK, ORANGE, PALE, PURPLE, SKY, VERMILLION, house_style, plt
from physics.integrators.general_purpose import BALL_BY_BALL

WIDTH, HEIGHT, DPI = 9.2, 6.0, 110
METHOD_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, INK, GREY)
RIVAL_COLOURS = {"RK45": ORANGE, "DOP853": VERMILLION, "LSODA": GREEN, "Radau": PURPLE}
WORST_SHOWN, BEST_SHOWN, EDGE_HEIGHT = 8.0, 1e-7, 4.5


def work_precision_png(chart: Chart) -> bytes:
    """The diagram of one scene as the bytes of a PNG file."""
    picture = io.BytesIO()
    with house_style():
        figure, axes = plt.subplots(figsize=(WIDTH, HEIGHT))
        figure.subplots_adjust(left=0.085, right=0.66, top=0.9, bottom=0.1)
        names = list(dict.fromkeys(run.name for run in chart.runs))
        methods = list(dict.fromkeys(_method(name) for name in names if _group(chart, name) == METHOD))
        for name in names:
            _draw(axes, chart, name, methods)
        axes.axhline(TARGET, color=GREY, linewidth=0.6, linestyle=(0, (4, 3)))
        axes.axvline(1.0, color=GREY, linewidth=0.6, linestyle=(0, (4, 3)))
        axes.set(xscale="log", yscale="log", ylim=(BEST_SHOWN, WORST_SHOWN))
        axes.set_xlabel("times real time on one core (more is faster)")
        axes.set_ylabel("RMS error of the acceleration over its RMS, from 0.1 s")
        axes.grid(True, color=PALE, linewidth=0.5)
        axes.set_title(f"Speed against accuracy: {chart.title}", fontsize=11, pad=22)
        axes.text(0.0, 1.02, _facts(chart), transform=axes.transAxes, fontsize=8, color=GREY)
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), fontsize=7.5, handlelength=2.4)
        figure.savefig(picture, dpi=DPI, format="png")
        plt.close(figure)
    return picture.getvalue()


def _group(chart: Chart, name: str) -> str:
    return next(run.group for run in chart.runs if run.name == name)


def _method(name: str) -> str:
    """The method alone, of which a comma may part what else is done."""
    return name.split(",")[0]


def _points(runs: Sequence[Run], name: str) -> list[tuple[float, float]]:
    found = []
    for run in runs:
        if run.name == name and run.score is not None and math.isfinite(run.score.acceleration):
            found.append((run.real_time, min(max(run.score.acceleration, BEST_SHOWN), WORST_SHOWN)))
    return found


def _draw(axes: plt.Axes, chart: Chart, name: str, methods: list[str]) -> None:
    points = _points(chart.runs, name)
    if not points:
        axes.plot([], [], " ", label=f"{name}: gave up")
        return
    speed, error = zip(*points, strict=True)
    if _group(chart, name) == METHOD:
        colour = METHOD_COLOURS[methods.index(_method(name)) % len(METHOD_COLOURS)]
        style, face = ("o-", colour) if _method(name) == name else ("o--", "white")
        axes.plot(
            speed, error, style, color=colour, markerfacecolor=face, markersize=4.5, linewidth=1.6, label=name, zorder=4
        )
        _mark_edge(axes, chart, name, colour)
    elif _group(chart, name) == MODEL:
        axes.plot(speed, error, "*", markersize=10, color=INK, alpha=0.75, zorder=3)
        axes.annotate(f" {name}", (speed[0], error[0]), fontsize=7, va="bottom", color=INK)
    else:
        solver = name.split(",")[0].split()[-1]
        style = (":" if BALL_BY_BALL in name else "--") if name.startswith("SciPy") else "-"
        marker = "s" if BALL_BY_BALL in name else "^"
        axes.plot(
            speed, error, marker=marker, linestyle=style, color=RIVAL_COLOURS[solver], markersize=3.5, linewidth=0.9,
            alpha=0.9, label=name,
        )  # fmt: skip


def _mark_edge(axes: plt.Axes, chart: Chart, name: str, colour: str) -> None:
    """A bar at the top where the method would be at its longest stable step."""
    if name in chart.edges:
        height = EDGE_HEIGHT / 2.2 ** list(chart.edges).index(name)
        axes.plot([chart.edges[name]], [height], "|", color=colour, markersize=16, markeredgewidth=2.2)
        axes.annotate(
            f"{name}: unstable beyond", (chart.edges[name], height), fontsize=6.5, color=colour,
            xytext=(-5, 0), textcoords="offset points", va="center", ha="right",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
        )  # fmt: skip


def _facts(chart: Chart) -> str:
    made = chart.made_with
    return (
        f"{chart.rate:g} Hz, {chart.duration:g} s, against {chart.reference}; {made['machine']}, "
        f"numba {made['numba']}, scipy {made['scipy']}"
    )
