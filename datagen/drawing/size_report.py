"""Pictures of scored spall sizes: estimate against truth, and errors by what they depend on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from datagen.drawing.style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    VERMILLION,
    faint_grid,
    plain_log_ticks,
    png_of,
    roomy,
    with_panels,
)
from datagen.sizing.record_errors import RULES, extent_error, mean_of, noise_level, noise_levels, noise_name
from datagen.sizing.scored_record import ScoredRecord

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from datagen.sizing.size_scores import SizeScores
    from datagen.sizing.size_summary import ErrorRow, SizeSummary

RULE_COLOURS = (ORANGE, VERMILLION, GREY, GREEN)
DPI = 130
ACROSS = 3
MOST_BINS = 8
LONGEST_LEVEL_NAMES = 44  # letters of all names together that fit side by side


def size_report_png(scores: SizeScores) -> bytes:
    """The picture of a corpus scored against a known truth, as the bytes of a PNG file; ValueError without a truth."""
    summary = scores.summary
    if summary is None:
        raise ValueError("no ball passes are known, so there is nothing to draw the estimates against")
    return png_of(lambda: draw_size_report(scores, summary), DPI)


def draw_size_report(scores: SizeScores, summary: SizeSummary) -> Figure:
    """The figure of a corpus scored against a known truth, and of the `summary` of its scores."""
    tables = dependences(summary)
    rows = -(-(4 + len(tables)) // ACROSS)
    figure, axes = with_panels(rows, ACROSS, figsize=(11.5, 3.25 * rows), layout=roomy())
    panels = axes.ravel()
    answered = [record for record in scores.records if record.truth.known and record.scorable and record.found]
    _against_truth(panels[0], answered, "lag")
    _against_truth(panels[1], answered, "extent")
    _rules(panels[2], answered)
    for panel, (name, table) in zip(panels[3:], tables.items(), strict=False):
        _bars(panel, table, name[0].upper() + name[1:])
    if tables:
        _name_bars(panels[3])
    _abstention(panels[3 + len(tables)], scores.records)
    for panel in panels[4 + len(tables) :]:
        panel.set_axis_off()
    return figure


def dependences(summary: SizeSummary) -> dict[str, list[ErrorRow]]:
    """The tables of errors that are drawn: of what differs between the records, or of noise if nothing does.

    Sizes in mm are left out, as those in spacings of the balls show the same.
    """
    differing = {name: rows for name, rows in summary.by.items() if len(rows) > 1 and name != "size, mm"}
    return differing or {name: rows for name, rows in summary.by.items() if rows and name == "noise, dB"}


def _against_truth(axes: Axes, answered: list[ScoredRecord], what: str) -> None:
    for clean, colour, name in ((True, BLUE, "clean"), (False, ORANGE, "noisy")):
        shown = [record for record in answered if math.isinf(noise_level(record)) == clean]
        if not shown:
            continue
        scale = 1e3 if what == "lag" else math.degrees(1.0)
        true = np.array([getattr(record.truth, what) for record in shown]) * scale
        axes.loglog(
            true,
            np.array([getattr(record.answer, what) for record in shown]) * scale,
            ".",
            color=colour,
            ms=4,
            label=name,
        )
    if answered:
        low, high = axes.get_xlim()
        axes.plot([low, high], [low, high], color=GREY, lw=0.8)
        plain_log_ticks(axes.xaxis)
        plain_log_ticks(axes.yaxis)
        axes.legend()
    else:
        _say_empty(axes)
    unit = "ms" if what == "lag" else "degrees"
    axes.set(title=f"{what.capitalize()} of scored records", xlabel=f"true, {unit}", ylabel=f"estimated, {unit}")


def _rules(axes: Axes, answered: list[ScoredRecord]) -> None:
    met = {noise_level(record) for record in answered}
    levels = [level for level in noise_levels(answered) if level in met or not met]
    place = np.arange(len(levels))
    methods = {"this estimator": extent_error} | RULES
    width = 0.8 / len(methods)
    for k, ((name, error), colour) in enumerate(zip(methods.items(), (BLUE, *RULE_COLOURS), strict=True)):
        means = [mean_of([error(record) for record in answered if noise_level(record) == level]) for level in levels]
        axes.bar(place + (k - (len(methods) - 1) / 2) * width, means, width, color=colour, label=name)
    axes.set_xticks(place, [noise_name(level) for level in levels])
    axes.set(title="Arc against simple rules, by noise, dB", ylabel="mean |error| / true")
    axes.set_xlim(-0.6, len(levels) - 0.4)
    axes.margins(y=0.35)  # room for the legend
    if not answered:
        axes.set_ylim(0.0, 1.0)
        _say_empty(axes)
    axes.legend(ncols=2, fontsize=6.5, loc="upper left")
    faint_grid(axes)


def _say_empty(axes: Axes) -> None:
    axes.text(0.5, 0.5, "no record was given a size", transform=axes.transAxes, ha="center", va="center", color=GREY)


def _bars(axes: Axes, rows: list[ErrorRow], title: str) -> None:
    table = most_frequent(rows)
    place = np.arange(len(table))
    bars = (
        ([row.lag_error.value for row in table], BLUE, "lag"),
        ([row.arc_error.value for row in table], ORANGE, "arc"),
        ([row.no_estimate.value for row in table], GREY, "no estimate, share"),
    )
    for k, (heights, colour, name) in enumerate(bars):
        axes.bar(place + (k - 1) * 0.27, heights, 0.27, color=colour, label=name)
    middle, half = (len(table) - 1) / 2.0, max(len(table), 2) / 2.0 + 0.1
    axes.set_xlim(middle - half, middle + half)
    _name_bins(axes, table)
    left_out = f", {len(table)} of {len(rows)}" if len(table) < len(rows) else ""
    axes.set(title=f"{title} (records{left_out})", ylabel="mean |error| / true; share without estimate")
    faint_grid(axes)


def _name_bars(axes: Axes) -> None:
    """The legend of one panel of bars, which is that of all."""
    axes.margins(y=0.35)
    axes.legend(fontsize=6.5, ncols=3, loc="upper left", columnspacing=1.0, handlelength=1.2)


def most_frequent(rows: list[ErrorRow]) -> list[ErrorRow]:
    """The rows of a table that there is room for, those of the most records, in their order."""
    kept = sorted(range(len(rows)), key=lambda k: -rows[k].records)[:MOST_BINS]
    return [rows[k] for k in sorted(kept)]


def _name_bins(axes: Axes, table: list[ErrorRow]) -> None:
    """Values and numbers of records below the bars, aslant where they would not fit side by side."""
    crowded = sum(len(row.value) for row in table) > LONGEST_LEVEL_NAMES
    gap = " " if crowded else "\n"
    names = [f"{row.value}{gap}({row.records})" for row in table]
    aslant: dict[str, Any] = {"rotation": 25, "ha": "right", "rotation_mode": "anchor"} if crowded else {}
    axes.set_xticks(range(len(table)), names, fontsize=7, parse_math=False, **aslant)


def _abstention(axes: Axes, records: list[ScoredRecord]) -> None:
    kinds = (
        (
            [record.answer.trust for record in records if record.truth.known and record.without_event],
            VERMILLION,
            "no event",
        ),
        (
            [record.answer.trust for record in records if record.truth.known and record.scorable],
            BLUE,
            "to be given a size",
        ),
    )
    for values, colour, name in (kind for kind in kinds if kind[0]):
        axes.hist(values, bins=[k / 20.0 for k in range(21)], histtype="step", color=colour, label=name, density=True)
    axes.set(title="Trust in the pair of events", xlabel="1 − expected error of the lag", ylabel="density")
    if any(values for values, *_ in kinds):
        axes.legend()
