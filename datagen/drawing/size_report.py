"""Pictures of scored spall sizes: estimate against truth, and errors by what they depend on."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from datagen.drawing.style import BLUE, GREEN, GREY, ORANGE, VERMILLION, faint_grid, house_style
from datagen.sizing.scored_record import ScoredRecord
from datagen.sizing.summary import NOISE_LEVELS, RULES, extent_error, noise_level, noise_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from datagen.sizing.score import SizeScores

RULE_COLOURS = (ORANGE, VERMILLION, GREY, GREEN)


def size_report_png(scores: SizeScores) -> bytes:
    """The picture of a corpus scored against a known truth, as the bytes of a PNG file; empty without one."""
    summary, picture = scores.summary, io.BytesIO()
    if summary is None:
        return b""
    with house_style():
        figure, axes = plt.subplots(4, 3, figsize=(11.5, 13.0), layout="constrained")
        panels = axes.ravel()
        told = [one for one in scores.records if one.known_truth and one.scorable and one.found]
        _against_truth(panels[0], told, "lag")
        _against_truth(panels[1], told, "extent")
        _rules(panels[2], told)
        dependences = [name for name in summary["by"] if name != "size, mm"]
        for panel, name in zip(panels[3:11], dependences, strict=True):
            _bars(panel, summary["by"][name], name[0].upper() + name[1:])
        _abstention(panels[11], scores.records)
        figure.savefig(picture, dpi=130, format="png")
        plt.close(figure)
    return picture.getvalue()


def _against_truth(axes: Axes, told: list[ScoredRecord], what: str) -> None:
    for clean, colour, name in ((True, BLUE, "clean"), (False, ORANGE, "noisy")):
        own = [one for one in told if math.isinf(noise_level(one)) == clean]
        scale = 1e3 if what == "lag" else math.degrees(1.0)
        true = np.array([getattr(one, f"true_{what}") for one in own]) * scale
        axes.loglog(true, np.array([getattr(one, what) for one in own]) * scale, ".", color=colour, ms=4, label=name)
    low, high = axes.get_xlim()
    axes.plot([low, high], [low, high], color=GREY, lw=0.8)
    unit = "ms" if what == "lag" else "degrees"
    axes.set(title=f"{what.capitalize()} of scored records", xlabel=f"true, {unit}", ylabel=f"estimated, {unit}")
    axes.legend()


def _rules(axes: Axes, told: list[ScoredRecord]) -> None:
    place = np.arange(len(NOISE_LEVELS))
    methods = {"this estimator": extent_error} | RULES
    width = 0.8 / len(methods)
    for k, ((name, error), colour) in enumerate(zip(methods.items(), (BLUE, *RULE_COLOURS), strict=True)):
        means = [_mean([error(one) for one in told if noise_level(one) == level]) for level in NOISE_LEVELS]
        axes.bar(place + (k - 2) * width, means, width, color=colour, label=name)
    axes.set_xticks(place, [noise_name(level) for level in NOISE_LEVELS])
    axes.set(title="Arc against simple rules, by noise, dB", ylabel="mean |error| / true")
    axes.margins(y=0.35)  # room for the legend
    axes.legend(ncols=2, fontsize=6.5, loc="upper left")
    faint_grid(axes)


def _mean(values: list[float]) -> float:
    finite = [value for value in values if math.isfinite(value)]
    return float(np.mean(finite)) if finite else math.nan


def _bars(axes: Axes, table: list[dict[str, Any]], title: str) -> None:
    place = np.arange(len(table))
    for k, (column, colour, name) in enumerate(
        (("lag_error", BLUE, "lag"), ("arc_error", ORANGE, "arc"), ("no_estimate", GREY, "no estimate, share"))
    ):
        axes.bar(place + (k - 1) * 0.27, [row[column] for row in table], 0.27, color=colour, label=name)
    axes.set_xticks(place, [f"{row['value']}\n({row['records']})" for row in table], fontsize=7)
    axes.set(title=f"{title} (records)", ylabel="mean |error| / true")
    if title.startswith("Noise"):
        axes.legend(fontsize=6.5)
    faint_grid(axes)


def _abstention(axes: Axes, records: list[ScoredRecord]) -> None:
    kinds = (
        ([one.trust for one in records if one.known_truth and one.without_event], VERMILLION, "no event"),
        ([one.trust for one in records if one.known_truth and one.scorable], BLUE, "to be told a size"),
    )
    for values, colour, name in kinds:
        axes.hist(values, bins=[k / 20.0 for k in range(21)], histtype="step", color=colour, label=name, density=True)
    axes.set(title="Trust in the pair of events", xlabel="1 − expected error of the lag", ylabel="density")
    axes.legend()
