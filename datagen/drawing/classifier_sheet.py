"""The sheet of a benchmark: scores with intervals, confusion, calibration, what accuracy depends on, importances."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from datagen.counts import counted
from datagen.drawing.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, VERMILLION, faint_grid, png_of, with_panels
from physics.bearing import RACES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from datagen.benchmark.model_scores import Confusion
    from datagen.benchmark.results import CorpusScores, Results

COLOURS = (GREY, BLUE, VERMILLION, GREEN, PURPLE, ORANGE)
WIDTH, ROW, DPI = 20.0, 3.0, 100
MOST_FEATURES = 15
AGAINST = {"snr_db": "SNR, dB", "speed_rpm": "speed, rpm", "extent_mm": "size, mm"}
COLUMNS = 3 + len(AGAINST)
COLUMN_WIDTHS = (1.0, 1.6, *[1.0] * (COLUMNS - 2))  # room for a confusion table of each model


def scores_png(results: Results) -> bytes:
    """The sheet of the results of `classify` as the bytes of a PNG file."""
    return png_of(lambda: draw_results(results), DPI)


def draw_results(results: Results) -> Figure:
    """The figure of the results of `classify`: one row of panels a corpus, then the model."""
    tests = [test.scores for test in results.tests]
    rows = len(tests) + 1
    figure, axes = with_panels(
        rows, COLUMNS, figsize=(WIDTH, ROW * rows), layout="constrained", squeeze=False, width_ratios=COLUMN_WIDTHS
    )
    for panels, test in zip(axes, tests, strict=False):
        draw_scores(panels[0], test)
        draw_confusion(panels[1], test)
        draw_reliability(panels[2], test)
        for panel, quantity in zip(panels[3:], AGAINST, strict=True):
            draw_against(panel, test, quantity)
    draw_importances(axes[-1][:-2], results)
    draw_curve(axes[-1][-2], results)
    axes[-1][-1].axis("off")
    return figure


def draw_scores(axes: Axes, test: CorpusScores) -> None:
    """Balanced accuracy over faults, race accuracy and detection AUC of each model, with intervals; false alarms where
    there are no faults."""
    title = f"{Path(test.corpus).name}: {counted(test.records, 'record')}"
    if not any(test.locations[race] for race in RACES):
        alarms = (f"{name}: {said.false_alarms} of {said.healthy}" for name, said in test.models.items())
        say(axes, title, "no faults to score\n\nfalse alarms\n" + "\n".join(alarms))
        return
    models = test.models
    words = list(next(iter(models.values())).headline)
    for place, (name, scores) in enumerate(models.items()):
        shift = (place - 0.5 * (len(models) - 1)) * 0.16
        for spot, found in enumerate(scores.headline.values()):
            if np.isfinite(found.value):
                axes.plot([spot + shift] * 2, [found.low, found.high], color=_colour(place), linewidth=2)
                axes.plot(spot + shift, found.value, "o", color=_colour(place), markersize=4)
        axes.plot([], [], "o-", color=_colour(place), label=name)
    axes.set_xticks(range(len(words)), words)
    axes.set_xlim(-0.5, len(words) - 0.5)
    axes.set_ylim(0.0, 1.03)
    if not test.locations["none"]:
        axes.text(2, 0.5, "no healthy\nrecords", ha="center", va="center", color=GREY)
    axes.set_title(title, parse_math=False)
    axes.legend(loc="lower left")
    faint_grid(axes)


def say(axes: Axes, title: str, text: str) -> None:
    """Words in place of a panel that has nothing to show."""
    axes.axis("off")
    axes.set_title(title, parse_math=False)
    axes.text(0.5, 0.5, text, ha="center", va="center", color=INK, transform=axes.transAxes)


def draw_confusion(axes: Axes, test: CorpusScores) -> None:
    """Truth against what each model says, a small table a model in the place of `axes`."""
    models, place = test.models, axes.get_subplotspec()
    if place is None:
        raise ValueError("the axes stand in no grid that could be divided")
    axes.axis("off")
    across = 1 if len(models) == 1 else 2
    cells = place.subgridspec(-(-len(models) // across), across)
    for number, (name, scores) in enumerate(models.items()):
        row, column = divmod(number, across)
        panel = axes.figure.add_subplot(cells[row, column])
        below = number + across >= len(models)
        _draw_table(panel, name, scores.confusion, named_rows=column == 0, named_columns=below)


def _draw_table(axes: Axes, name: str, table: Confusion, named_rows: bool, named_columns: bool) -> None:
    counts = np.array(table.counts)
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.3, aspect="auto")
    for row, column in np.ndindex(*counts.shape):
        axes.text(column, row, str(counts[row, column]), ha="center", va="center", color=INK, fontsize=7)
    axes.set_xticks(range(len(table.columns)), table.columns if named_columns else [])
    axes.set_yticks(range(len(table.rows)), table.rows if named_rows else [])
    axes.tick_params(labelsize=7)
    if named_rows:
        axes.set_ylabel("truth")
    axes.set_title(f"said by {name}", fontsize=8.5)


def draw_reliability(axes: Axes, test: CorpusScores) -> None:
    """Share of spalls against the probability predicted."""
    calibrated = any(scores.calibration for scores in test.models.values())
    if not (calibrated and test.locations["none"]):
        say(axes, "reliability", "needs healthy records and\nfaults of known size")
        return
    axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.7)
    for place, (name, scores) in enumerate(test.models.items()):
        if scores.calibration:
            curve = scores.calibration.reliability
            axes.plot(curve["predicted"], curve["observed"], "o-", color=_colour(place), markersize=3, label=name)
    axes.legend(loc="upper left")
    axes.set_xlabel("predicted probability of a spall")
    axes.set_ylabel("share of spalls")
    axes.set_title("reliability")


def draw_against(axes: Axes, test: CorpusScores, quantity: str) -> None:
    """Accuracy over fault records against one of AGAINST, in bins of equally many records."""
    models = test.models
    if not any(quantity in scores.accuracy_against for scores in models.values()):
        say(axes, "accuracy over faults", f"{AGAINST[quantity]}:\nunknown, or the same in all")
        return
    for place, scores in enumerate(models.values()):
        table = scores.accuracy_against.get(quantity, [])
        at, value = [point["at"] for point in table], np.array([point["accuracy"] for point in table])
        axes.plot(at, value, "o-", color=_colour(place), markersize=3)
        axes.fill_between(
            at,
            [point["low"] for point in table],
            [point["high"] for point in table],
            color=_colour(place),
            alpha=0.1,
            linewidth=0,
        )
    axes.set_xlabel(AGAINST[quantity])
    axes.set_ylim(0.0, 1.03)
    axes.set_title("accuracy over faults")
    faint_grid(axes)


def draw_importances(axes: NDArray[Any], results: Results) -> None:
    """The features that each model uses most, one of `axes` (N,) each."""
    for panel in axes:
        panel.axis("off")
    for panel, (name, table) in zip(axes, results.importances.items(), strict=False):
        chosen = list(table.items())[:MOST_FEATURES][::-1]
        panel.axis("on")
        panel.barh([row[0] for row in chosen], [row[1] for row in chosen], color=BLUE)
        panel.tick_params(axis="y", labelsize=6.5)
        panel.set_xlabel("rise of log loss when shuffled, nats")
        panel.set_title(f"importances, {name}")


def draw_curve(axes: Axes, results: Results) -> None:
    """Balanced accuracy against the number of virtual bearings learned from."""
    if not results.learning_curve:
        axes.axis("off")
        return
    for place, (name, points) in enumerate(results.learning_curve.items()):
        bearings = [point["bearings"] for point in points]
        axes.plot(
            bearings, [point["value"] for point in points], "o-", color=_colour(place + 1), markersize=3, label=name
        )
        low, high = [point["low"] for point in points], [point["high"] for point in points]
        axes.fill_between(bearings, low, high, color=_colour(place + 1), alpha=0.15, linewidth=0)
    axes.set_xlabel("virtual bearings learned from")
    axes.set_ylabel("balanced accuracy, records")
    axes.set_title("learning curve")
    axes.legend(loc="lower right")


def _colour(place: int) -> str:
    return COLOURS[place % len(COLOURS)]
