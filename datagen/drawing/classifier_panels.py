"""Panels of a benchmark: scores with intervals, confusion, calibration, what accuracy depends on, importances."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps

from datagen.drawing.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    VERMILLION,
    faint_grid,
    plain_log_ticks,
    spans_decades,
    whole_numbers,
)
from labels.schema import LOCATIONS
from physics.bearing import RACES

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from datagen.benchmark.model_scores import Confusion
    from datagen.benchmark.results import CorpusResults, CorpusScores
    from labels.interval import Interval

COLOURS = (GREY, BLUE, VERMILLION, GREEN, PURPLE, ORANGE)
MOST_FEATURES = 15
AGAINST = {"snr_db": ("SNR", "SNR, dB"), "speed_rpm": ("speed", "speed, rpm"), "extent_mm": ("size", "size, mm")}
SCORE_ENDS = (0.0, 1.03)
SHARES = "Blues"
WHOLE_SHARE = 1.3  # of the map of colours, so that the darkest stays blue
HALF_BRIGHT = 0.5


def draw_scores(axes: Axes, test: CorpusScores) -> None:
    """Balanced accuracy over faults, race accuracy and detection AUC of each model, with intervals; false alarms where
    there are no faults."""
    if not any(test.locations[place] for place in LOCATIONS):
        say(axes, "scores", "the true class of no record is known")
        return
    if not any(test.locations[race] for race in RACES):
        alarms = (f"{name}: {said.false_alarms} of {said.healthy}" for name, said in test.models.items())
        say(axes, "scores", "no faults to score\n\nfalse alarms\n" + "\n".join(alarms))
        return
    words = list(next(iter(test.models.values())).headline)
    draw_points(axes, [{name: said.headline[word] for name, said in test.models.items()} for word in words])
    axes.set_xticks(range(len(words)), words)
    if not test.locations["none"]:
        axes.text(2, 0.5, "no healthy\nrecords", ha="center", va="center", color=GREY)
    axes.set_ylabel("score")
    axes.set_title("scores")


def draw_noise(axes: Axes, test: CorpusResults) -> None:
    """Balanced accuracy over faults of each model at every level of noise added, with intervals, and without any."""
    noisy = sorted(test.noise, key=lambda level: level.snr_db)
    tested = [level.scores for level in noisy] + [test.scores]
    draw_points(
        axes, [{name: said.faults_balanced_accuracy for name, said in scores.models.items()} for scores in tested]
    )
    axes.set_xticks(range(len(tested)), [*(f"{level.snr_db:g}" for level in noisy), "none added"])
    axes.set_xlabel("signal over white noise added, dB")
    axes.set_ylabel("score “faults”")
    axes.set_title("faults, with noise added")


def draw_points(axes: Axes, places: Sequence[dict[str, Interval]]) -> None:
    """At each of the places the score of every model by name, side by side, with its interval."""
    names = list(places[0])
    for number, name in enumerate(names):
        shift = (number - 0.5 * (len(names) - 1)) * 0.16
        for spot, scores in enumerate(places):
            found = scores[name]
            if np.isfinite(found.value):
                axes.plot([spot + shift] * 2, [found.low, found.high], color=colour(number), linewidth=2)
                axes.plot(spot + shift, found.value, "o", color=colour(number), markersize=4)
        axes.plot([], [], "o-", color=colour(number), label=name)
    axes.set(xlim=(-0.5, len(places) - 0.5), ylim=SCORE_ENDS)
    axes.legend(loc="best")
    faint_grid(axes)


def say(axes: Axes, title: str, text: str) -> None:
    """Words in place of a panel that has nothing to show."""
    axes.axis("off")
    axes.set_title(title)
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
    """The counts of one model; classes that are true of no record have no row."""
    kept = [row for row, counts in enumerate(table.counts) if any(counts)] or list(range(len(table.counts)))
    counts = np.array(table.counts)[kept]
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    axes.imshow(shares, cmap=SHARES, vmin=0.0, vmax=WHOLE_SHARE, aspect="auto")
    for row, column in np.ndindex(*counts.shape):
        ink = _legible(shares[row, column])
        axes.text(column, row, str(counts[row, column]), ha="center", va="center", color=ink, fontsize=8)
    axes.set_xticks(range(len(table.columns)), table.columns if named_columns else [])
    axes.set_yticks(range(len(kept)), [table.rows[row] for row in kept] if named_rows else [])
    axes.tick_params(labelsize=7, length=0)
    axes.spines[:].set_visible(False)
    if named_rows:
        axes.set_ylabel("truth")
    axes.set_title(f"said by {name}", fontsize=8.5)


def _legible(share: float) -> str:
    """The colour of digits on a cell of the table with this share of its row."""
    red, green, blue, _ = colormaps[SHARES](share / WHOLE_SHARE)
    return INK if 0.299 * red + 0.587 * green + 0.114 * blue > HALF_BRIGHT else "white"


def has_reliability(test: CorpusScores) -> bool:
    """Whether probabilities can be held against what is true of healthy records and of faults."""
    return bool(test.locations["none"]) and any(scores.calibration for scores in test.models.values())


def reliability_curves(test: CorpusScores) -> dict[str, dict[str, list[float]] | None]:
    """The reliability of every model by name; None of one that gives no probability."""
    return {name: said.calibration.reliability if said.calibration else None for name, said in test.models.items()}


def draw_reliability(axes: Axes, curves: Mapping[str, dict[str, list[float]] | None]) -> None:
    """Share of spalls against the probability predicted, of every model that has a curve."""
    axes.plot([0, 1], [0, 1], color=GREY, linewidth=0.7)
    for place, (name, curve) in enumerate(curves.items()):
        if curve:
            axes.plot(curve["predicted"], curve["observed"], "o-", color=colour(place), markersize=3, label=name)
    axes.legend(loc="best")
    axes.set_xlabel("predicted probability of a spall")
    axes.set_ylabel("share of spalls")
    axes.set_title("reliability")


def differing(test: CorpusScores) -> list[str]:
    """Those of AGAINST of which faults of different values are known."""
    tables = [scores.accuracy_against for scores in test.models.values()]
    return [quantity for quantity in AGAINST if any(len(table.get(quantity, [])) > 1 for table in tables)]


def accuracies_against(test: CorpusScores, quantity: str) -> dict[str, list[dict[str, float]]]:
    """The accuracy of every model by name against one of AGAINST."""
    return {name: scores.accuracy_against.get(quantity, []) for name, scores in test.models.items()}


def draw_against(axes: Axes, tables: Mapping[str, list[dict[str, float]]], quantity: str) -> None:
    """Accuracy over fault records against one of AGAINST, in bins of equally many records, with intervals."""
    for place, (name, table) in enumerate(tables.items()):
        size = 3.0 + 1.5 * (len(tables) - 1 - place)  # what lies below another still shows
        _draw_band(axes, [point["at"] for point in table], table, "accuracy", colour(place), name, size)
    places = [point["at"] for table in tables.values() for point in table]
    if quantity != "snr_db" and spans_decades(min(places), max(places)):  # decibels are logarithms already
        axes.set_xscale("log")
        plain_log_ticks(axes.xaxis)
    word, label = AGAINST[quantity]
    axes.set(xlabel=label, ylabel="share of faults called right", ylim=SCORE_ENDS)
    axes.set_title(f"faults, by {word}")
    axes.legend(loc="best")
    faint_grid(axes)


def draw_importances(axes: Axes, name: str, table: dict[str, float]) -> None:
    """The features that a model uses most."""
    chosen = list(table.items())[:MOST_FEATURES][::-1]
    axes.barh([row[0] for row in chosen], [row[1] for row in chosen], color=BLUE)
    axes.tick_params(axis="y", labelsize=6.5)
    axes.set_xlabel("rise of log loss when shuffled, nats")
    axes.set_title(f"importances, {name}")


def has_curve(curve: dict[str, list[dict[str, Any]]]) -> bool:
    """Whether a model was learned from different numbers of bearings: one point alone is no curve."""
    return any(len(points) > 1 for points in curve.values())


def draw_curve(axes: Axes, curve: dict[str, list[dict[str, Any]]]) -> None:
    """Balanced accuracy against the number of virtual bearings learned from, with intervals."""
    for place, (name, points) in enumerate(curve.items(), start=1):  # as in the other panels, where the rule is first
        _draw_band(axes, [point["bearings"] for point in points], points, "value", colour(place), name)
    whole_numbers(axes.xaxis)
    axes.set(xlabel="virtual bearings learned from", ylabel="balanced accuracy, records", ylim=SCORE_ENDS)
    axes.set_title("learning curve")
    axes.legend(loc="lower right")
    faint_grid(axes)


def _draw_band(
    axes: Axes, at: list[float], points: list[dict[str, Any]], value: str, ink: str, name: str, size: float = 3.0
) -> None:
    """The `value` of each of the points, and its interval as a shaded band."""
    axes.plot(at, [point[value] for point in points], "o-", color=ink, markersize=size, label=name)
    low, high = [point["low"] for point in points], [point["high"] for point in points]
    axes.fill_between(at, low, high, color=ink, alpha=0.12, linewidth=0)


def colour(place: int) -> str:
    """The colour of a model, of which the rule is the first."""
    return COLOURS[place % len(COLOURS)]
